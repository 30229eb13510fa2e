#include "calibration/lab/moved_room.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "calibration/lab/true_room.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kUsualTravel = 60.0; // degrees of a whole stroke of what does not turn
constexpr double kAround = 0.1;       // metres around the device where it is measured how far light lies beside

/// A turn (radians) and a shift (metres) that somebody who bumps into a thing gives it.
struct Bump {
    glm::dvec3 turn{0.0}, shift{0.0};
    [[nodiscard]] glm::dmat4 matrix(double scale) const {
        const double angle = scale * glm::length(turn);
        const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), scale * shift);
        return angle > 0.0 ? glm::rotate(shifted, angle, glm::normalize(turn)) : shifted;
    }
};

Bump anyBump(std::uint32_t seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    Bump bump;
    for (int i = 0; i < 3; ++i) bump.turn[i] = 0.0015 * normal(engine);
    for (int i = 0; i < 3; ++i) bump.shift[i] = 0.003 * normal(engine);
    return bump;
}

/// Places on the table around the device.
std::vector<glm::dvec3> placesAround(const Installation& room) {
    const glm::dvec3 middle(room.worldFromDevice[3]);
    std::vector<glm::dvec3> places;
    for (int z = -3; z <= 3; ++z)
        for (int x = -3; x <= 3; ++x)
            places.emplace_back(middle.x + kAround * x / 3.0, 0.0, middle.z + kAround * z / 3.0);
    return places;
}

/// Where the ray of a pixel meets the table.
glm::dvec3 onTable(const CalibratedCamera& camera, const glm::dvec2& pixel) {
    const glm::dvec3 from = positionOf(camera), way = directionOf(camera, pixel);
    return from - (from.y / way.y) * way;
}

double besideOf(const CalibratedCamera& before, const CalibratedCamera& after, const std::vector<glm::dvec3>& places) {
    double sum = 0.0, count = 0.0;
    for (const glm::dvec3& place : places) {
        const auto pixel = pixelOf(before, place);
        if (!pixel) continue;
        const glm::dvec3 way = onTable(after, *pixel) - place;
        sum += glm::dot(way, way);
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// The scale at which a measure that grows from zero comes to `metres`.
double scaleFor(double metres, const std::function<double(double)>& measure) {
    double scale = 1.0;
    for (int i = 0; i < 20; ++i) {
        const double now = measure(scale);
        if (!(now > 0.0)) break;
        scale *= metres / now;
    }
    return scale;
}

void pushLens(CalibratedCamera& camera, const Installation& room, double metres, std::uint32_t seed) {
    const std::vector<glm::dvec3> places = placesAround(room);
    const Bump bump = anyBump(seed);
    const auto at = [&](double scale) {
        CalibratedCamera moved = camera;
        moved.cameraFromWorld = bump.matrix(scale) * camera.cameraFromWorld;
        return moved;
    };
    camera = at(scaleFor(metres, [&](double scale) { return besideOf(camera, at(scale), places); }));
}

/// It slides and turns on the table.
void pushDevice(Installation& room, const Rig& rig, double metres, std::uint32_t seed) {
    Bump bump = anyBump(seed);
    bump.turn = {0.0, 6.0 * bump.turn.y, 0.0};
    bump.shift.y = 0.0;
    const auto measure = [&](double scale) {
        double sum = 0.0;
        for (const glm::vec3& point : rig.restMesh().positions) {
            const glm::dvec3 way = glm::dvec3(bump.matrix(scale) * glm::dvec4(point, 1.0)) - glm::dvec3(point);
            sum += glm::dot(way, way);
        }
        return std::sqrt(sum / static_cast<double>(rig.restMesh().positions.size()));
    };
    room.worldFromDevice = glm::mat4(glm::dmat4(room.worldFromDevice) * bump.matrix(scaleFor(metres, measure)));
}

void pushServo(Installation& room, const Actuator& actuator, double degrees) {
    const double strokes = degrees / degreesOf(actuator).value_or(kUsualTravel);
    auto servo = std::ranges::find(room.servos, actuator.name, &MeasuredServo::actuator);
    if (servo == room.servos.end())
        servo = room.servos.insert(servo, {actuator.name, {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 0.0});
    for (MeasuredServo::Point& point : servo->points) {
        point.rising += strokes;
        point.falling += strokes;
    }
}

const Actuator* actuatorNamed(const Rig& rig, std::string_view name) {
    const auto found = std::ranges::find(rig.actuators(), name, &Actuator::name);
    return found == rig.actuators().end() ? nullptr : &*found;
}

} // namespace

LabPush parseLabPush(std::string_view text, const Rig& rig) {
    const std::string subject = "--moved " + std::string(text);
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos)
        throw InvalidInput(subject, "it does not say how far", "write it as projector:3mm");
    LabPush push;
    push.part = text.substr(0, colon);
    const std::string_view amount = text.substr(colon + 1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(amount.data(), amount.data() + amount.size(), number);
    const std::string_view unit = amount.substr(static_cast<std::size_t>(end - amount.data()));
    const bool isServo = actuatorNamed(rig, push.part) != nullptr;
    if (!isServo && push.part != "projector" && push.part != "camera" && push.part != "device")
        throw InvalidInput(subject, "'" + push.part + "' is no part of the room",
                           "name projector, camera, device, or an actuator of the rig");
    const char* expected = isServo ? "deg" : "mm";
    if (error != std::errc() || unit != expected || !(std::abs(number) <= 50.0) || (!isServo && number < 0.0))
        throw InvalidInput(subject, "'" + std::string(amount) + "' is no such distance",
                           isServo ? "write degrees, such as 5deg" : "write millimetres up to 50, such as 3mm");
    (isServo ? push.degrees : push.metres) = isServo ? number : 1e-3 * number;
    return push;
}

Installation pushed(Installation truth, const Rig& rig, const LabPush& push, std::uint32_t seed) {
    if (const Actuator* actuator = actuatorNamed(rig, push.part)) {
        pushServo(truth, *actuator, push.degrees);
        return truth;
    }
    const bool isThere = push.part == "device" || (push.part == "projector" && !truth.projectors.empty()) ||
                         (push.part == "camera" && !truth.cameras.empty());
    if (!isThere) throw InvalidInput(push.part, "the room has none", "add one in the studio");
    if (push.metres == 0.0) return truth;
    if (push.part == "device") {
        pushDevice(truth, rig, push.metres, seed);
    } else {
        const Installation before = truth;
        pushLens(push.part == "camera" ? truth.cameras.front().camera : truth.projectors.front().camera, before,
                 push.metres, seed);
    }
    return truth;
}

} // namespace lumorph
