#include "core/rig/parts/build_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/drive_channels.h"
#include "core/rig/parts/plan_making.h"
#include "core/rig/parts/servo_seat.h"
#include "core/rig/servo_types.h"

namespace lumorph {
namespace {

constexpr double kLeastPulse = 500.0; // microseconds that hobby servos follow
constexpr double kGreatestPulse = 2500.0;
constexpr int kFirstPin = 2; ///< of an Arduino Pro Mini that servos may have
constexpr int kLastPin = 13;

void checkOptions(const PartOptions& options) {
    if (!(options.tolerance >= 0.0 && options.tolerance <= 1.0))
        throw InvalidInput("tolerance", "parts would not hold one another", "choose 0 to 1 mm");
    if (!(options.bed >= 50.0 && options.bed <= 2000.0))
        throw InvalidInput("print bed", "no printer has such a bed", "choose 50 to 2000 mm");
}

/// Pins for the rig's channels, as the studio sets the board up; where the board has not all of them, pins in the
/// actuators' order.
std::vector<int> pinsFor(const Rig& rig) {
    if (rig.actuatorCount() > kBoardServos) return std::vector<int>(rig.actuatorCount(), -1);
    std::vector<int> pins = boardChannels(rig, kFirstPin);
    std::set<int> taken;
    const auto fits = [&](int pin) { return pin <= kLastPin && taken.insert(pin).second; };
    if (!std::ranges::all_of(pins, fits)) std::iota(pins.begin(), pins.end(), kFirstPin);
    return pins;
}

void addWiring(BuildPlan& plan, const Rig& rig) {
    const std::vector<int> pins = pinsFor(rig);
    for (std::size_t k = 0; k < rig.actuatorCount(); ++k) {
        const Actuator& actuator = rig.actuators()[k];
        WiringRow row;
        row.actuator = actuator.name;
        row.channel = actuator.drive.channel;
        row.pin = pins[k];
        const auto [least, greatest] = std::minmax(actuator.drive.pulseMin, actuator.drive.pulseMax);
        row.pulseMin = std::clamp(least, kLeastPulse, kGreatestPulse - 1.0);
        row.pulseMax = std::clamp(greatest, row.pulseMin + 1.0, kGreatestPulse);
        row.curve = actuator.drive.curve;
        row.reversed = actuator.drive.pulseMin > actuator.drive.pulseMax;
        plan.wiring.push_back(std::move(row));
    }
}

void addBoard(BuildPlan& plan) {
    if (plan.wiring.empty()) return;
    if (plan.wiring.size() > kBoardServos) {
        plan.notes.push_back("The sketch drives " + std::to_string(kBoardServos) + " servos and this rig has " +
                             std::to_string(plan.wiring.size()) +
                             ": there is no sketch here. Take Pololu Maestros, 24 channels each, and set them up in "
                             "Devices.");
        return;
    }
    plan.bought.push_back({"Arduino Pro Mini, 5 V", "drives the servos with the sketch of this folder", 1});
    plan.bought.push_back({"power supply, 5 V", "0.7 A for each servo that moves at once; not from the board", 1});
}

} // namespace

void addPart(BuildPlan& plan, const PartOptions& options, const LayeredDrawing& drawing, PrintPart part) {
    part.solid = solidOf(drawing, part.name);
    const Box box = boundingBox(part.solid.mesh.positions);
    if (box.size().x > options.bed + 1e-3 || box.size().y > options.bed + 1e-3)
        throw InvalidInput("part " + inQuotes(part.name),
                           std::to_string(std::lround(std::max(box.size().x, box.size().y))) +
                               " mm are longer than the bed",
                           "choose a larger print bed");
    const glm::dvec2 low(box.min.x, box.min.y);
    for (glm::vec3& p : part.solid.mesh.positions) p -= glm::vec3(box.min.x, box.min.y, 0.0F);
    for (LayerOutline& layer : part.solid.layers)
        for (PlanePolygon& border : layer.borders)
            for (glm::dvec2& p : border) p -= low;
    plan.parts.push_back(std::move(part));
}

void addLoneSeats(BuildPlan& plan, const PartOptions& options) {
    const int servos = static_cast<int>(plan.wiring.size());
    if (servos == 0) return;
    const ServoSeat seat(options.servo, options.tolerance);
    addPart(plan, options, seat.drawing({}, 2.0), {"seat", "holds a servo on its side", "PLA or PETG", servos, {}});
    addPart(plan, options, seat.cap(), {"seat-cap", "holds the servo down in its seat", "PLA or PETG", servos, {}});
    plan.bought.push_back({std::string(options.servo.name) + " servo, with its horn", "move the device", servos});
    plan.bought.push_back({"self-tapping screw 2 x 8 mm", "caps onto seats", 2 * servos});
    for (WiringRow& row : plan.wiring) row.seat = "seat";
    plan.steps.push_back({"Lay the servos into their seats",
                          "On their side, the tabs in the slots, the cable out of the notch. Screw the caps on.",
                          {}});
    plan.steps.push_back({"Fix the seats where they drive your device",
                          "Glue or screw them from below, and link each horn to the part that it moves.",
                          {}});
}

BuildPlan buildPlanOf(const Rig& rig, const PartOptions& options, const Progress& progress) {
    checkOptions(options);
    progress.report(0.0, "reading the rig");
    BuildPlan plan;
    plan.device = rig.name();
    plan.servo = options.servo.name;
    addWiring(plan, rig);
    if (const auto sheet = sheetPlanOf(rig)) {
        addSheetParts(plan, *sheet, options, progress);
    } else if (isPinDisplay(rig)) {
        addPinParts(plan, rig, options, progress);
    } else if (rig.actuatorCount() == 0) {
        throw InvalidInput(inQuotes(rig.name()),
                           "it has no actuator and is no sheet on a housing: there is nothing to build",
                           "give it actuators");
    } else {
        plan.notes.push_back(
            "There is no housing: only a level sheet that bends up from a housing, or pins that slide "
            "up, can be taken apart into printable parts. Here are seats for its servos; for the other parts "
            "begin with a sheet or a pin display.");
        addLoneSeats(plan, options);
    }
    addBoard(plan);
    progress.report(1.0, "parts");
    return plan;
}

RigParts withLevers(const Rig& rig, const BuildPlan& plan) {
    RigParts parts = rig.parts();
    for (std::size_t k = 0; k < parts.actuators.size() && k < plan.wiring.size(); ++k) {
        const WiringRow& row = plan.wiring[k];
        if (!row.lever) continue;
        Actuator& actuator = parts.actuators[k];
        if (auto* bend = std::get_if<Bend>(&actuator.deformer)) {
            const double before = bend->max.inRadians() - bend->min.inRadians();
            const double lifted = std::min(before, row.lever->lifted.inRadians());
            bend->max = Angle::radians(bend->min.inRadians() + lifted);
            actuator.maxVelocity *= before / lifted;
            if (const ServoType* servo = findServo(plan.servo))
                actuator.maxVelocity = std::min(actuator.maxVelocity,
                                                servo->speed / (row.lever->turn().inRadians() * steepest(row.curve)));
        }
        actuator.drive.pulseMin = row.reversed ? row.pulseMax : row.pulseMin;
        actuator.drive.pulseMax = row.reversed ? row.pulseMin : row.pulseMax;
        actuator.drive.curve = row.curve;
        if (actuator.drive.servo.empty()) actuator.drive.servo = plan.servo;
    }
    return parts;
}

} // namespace lumorph
