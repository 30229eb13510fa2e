#include "core/rig/servo_types.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

/// Catalogues give kilogram-force centimetres, and seconds for 60 degrees.
constexpr double kgfCm(double value) { return value * 9.80665e-2; }
constexpr double secondsFor60(double seconds) { return std::numbers::pi / 3.0 / seconds; }

constexpr std::array kServoTypes{
    // Tower Pro's data sheet "SG90 9 g Micro Servo": 1.8 kgf cm and 0.1 s/60 deg at 4.8 V, 22.2 x 11.8 x 31 mm, 9 g;
    // end to end 500 to 2400 us as it is commonly measured (the sheet's 1 to 2 ms are its middle 90 degrees).
    ServoType{"SG90",
              kgfCm(1.8),
              secondsFor60(0.10),
              500.0,
              2400.0,
              Angle::degrees(180.0),
              {0.0222, 0.0118, 0.031},
              0.009,
              2.5},
    // Tower Pro's data sheet "MG90S Metal Gear Servo": 1.8 kgf cm, 0.1 s/60 deg at 4.8 V, 22.5 x 12 x 35.5 mm, 13.4 g.
    ServoType{"MG90S",
              kgfCm(1.8),
              secondsFor60(0.10),
              500.0,
              2400.0,
              Angle::degrees(180.0),
              {0.0225, 0.012, 0.0355},
              0.0134,
              4.5},
    // Tower Pro's page of the MG92B: 3.1 kgf cm, 0.13 s/60 deg at 5 V, 22.8 x 12 x 31 mm, 13.8 g.
    ServoType{"MG92B",
              kgfCm(3.1),
              secondsFor60(0.13),
              500.0,
              2400.0,
              Angle::degrees(180.0),
              {0.0228, 0.012, 0.031},
              0.0138,
              7.0},
    // Hitec's sheet "HS-422 Standard Deluxe": 3.3 kgf cm, 0.21 s/60 deg at 4.8 V, 900 to 2100 us for 90 degrees,
    // 40.6 x 19.8 x 36.6 mm, 45.5 g.
    ServoType{"HS-422",
              kgfCm(3.3),
              secondsFor60(0.21),
              900.0,
              2100.0,
              Angle::degrees(90.0),
              {0.0406, 0.0198, 0.0366},
              0.0455,
              13.0},
    // Tower Pro's data sheet "MG996R": 9.4 kgf cm, 0.17 s/60 deg at 4.8 V, 40.7 x 19.7 x 42.9 mm, 55 g.
    ServoType{"MG996R",
              kgfCm(9.4),
              secondsFor60(0.17),
              500.0,
              2500.0,
              Angle::degrees(180.0),
              {0.0407, 0.0197, 0.0429},
              0.055,
              8.0},
    // DSServo's data sheet "DS3218": 18 kgf cm, 0.16 s/60 deg at 5 V, 500 to 2500 us, 40 x 20 x 40.5 mm, 60 g.
    ServoType{"DS3218",
              kgfCm(18.0),
              secondsFor60(0.16),
              500.0,
              2500.0,
              Angle::degrees(180.0),
              {0.040, 0.020, 0.0405},
              0.060,
              15.0},
};

} // namespace

std::span<const ServoType> servoTypes() { return kServoTypes; }

const ServoType* findServo(std::string_view name) {
    const std::string wanted = lowerCase(name);
    const auto found =
        std::ranges::find_if(kServoTypes, [&](const ServoType& type) { return lowerCase(type.name) == wanted; });
    return found == kServoTypes.end() ? nullptr : &*found;
}

const ServoType& servoType(std::string_view name) {
    if (const ServoType* found = findServo(name)) return *found;
    std::string names;
    for (const ServoType& type : kServoTypes) names += (names.empty() ? "" : ", ") + std::string(type.name);
    throw InvalidInput(inQuotes(name), "there is no such servo in the table", "choose one of " + names);
}

const ServoType* cheapestServo(double torque) {
    const ServoType* best = nullptr;
    for (const ServoType& type : kServoTypes)
        if (type.usableTorque() >= torque && (best == nullptr || type.price < best->price)) best = &type;
    return best;
}

} // namespace lumorph
