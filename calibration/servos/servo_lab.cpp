#include "calibration/servos/servo_lab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"
#include "core/scene/measured_servos.h"

namespace lumorph {

namespace {

constexpr std::array<std::string_view, 4> kServoFaults = {"swapped", "reversed", "dead", "jammed"};
constexpr double kSteepest = 0.12; // cosine: flatter light is too dim to read

/// The device and the table before a projector without a picture.
LabWorld dimWorld(const Installation& room, const Rig& rig, std::span<const double> strokes) {
    LabWorld world = roomWorld(room, rig, strokes);
    world.projectors = {{room.projectors.front(), {}}};
    world.projectors.front().projector.enabled = true;
    return world;
}

MeasuredServo straight(const std::string& name) {
    return {.actuator = name, .points = {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}};
}

} // namespace

ServoFault parseServoFault(std::string_view text) {
    const auto found = std::ranges::find(kServoFaults, text);
    if (found == kServoFaults.end())
        throw InvalidInput("fault \"" + std::string(text) + "\"", "servos have no such fault",
                           "use swapped, reversed, dead or jammed");
    return static_cast<ServoFault>(found - kServoFaults.begin());
}

std::vector<std::size_t> faultyServos(ServoFault fault, std::size_t actuators) {
    if (actuators == 0) return {};
    if (fault == ServoFault::swapped)
        return actuators > 1 ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{};
    return {std::min(static_cast<std::size_t>(fault), actuators - 1)};
}

ServoLab::ServoLab(const Rig& rig, const Installation& truth, std::uint32_t seed, const ServoLabOptions& options)
    : rig_(rig), room_(truth), camera_(labCamera(truth)), options_(options), real_(rig.actuatorCount(), 0.0),
      dice_(seed * 7919U + 1U) {
    for (const Actuator& actuator : rig.actuators()) {
        const auto found = std::ranges::find(truth.servos, actuator.name, &MeasuredServo::actuator);
        servos_.push_back(found == truth.servos.end() ? straight(actuator.name) : *found);
    }
    for (int y = 0; y < camera_.size.y; y += std::max(1, options.pixelStep))
        for (int x = 0; x < camera_.size.x; x += std::max(1, options.pixelStep))
            rays_.push_back({{x, y}, directionOf(camera_, glm::dvec2(x, y))});
    command(real_);
}

void ServoLab::command(std::span<const double> commanded) {
    const std::size_t count = rig_.actuatorCount();
    const std::vector<std::size_t> faulty =
        options_.fault ? faultyServos(*options_.fault, count) : std::vector<std::size_t>{};
    const auto has = [&](ServoFault fault, std::size_t i) {
        return options_.fault == fault && std::ranges::find(faulty, i) != faulty.end();
    };
    std::vector<double> next = real_;
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t part = i;
        if (has(ServoFault::swapped, i)) part = faulty[0] + faulty[1] - i;
        const double told = has(ServoFault::reversed, i) ? 1.0 - commanded[i] : commanded[i];
        double now = realStroke(servos_[i], told, real_[part]);
        if (has(ServoFault::dead, i)) now = 0.0;
        if (has(ServoFault::jammed, i)) now = std::min(now, kLabStop);
        next[part] = now;
    }
    real_ = std::move(next);
}

/// Calls `use` with each ray whose hit the projector lights.
template <typename Use> void ServoLab::eachLit(std::span<const double> strokes, const Use& use) const {
    const Lab lab(dimWorld(room_, rig_, strokes));
    const glm::dvec3 eye = positionOf(camera_), lamp = positionOf(projector());
    for (const Ray& ray : rays_) {
        const auto hit = lab.trace(eye, ray.way);
        if (!hit || hit->surface < 0) continue;
        const glm::dvec3 towards = glm::normalize(lamp - hit->point);
        if (glm::dot(hit->normal, towards) < kSteepest || -glm::dot(hit->normal, ray.way) < kSteepest) continue;
        if (lab.lit(0, hit->point, hit->normal)) use(ray, *hit);
    }
}

std::vector<ProjectorPoint> ServoLab::look() {
    std::mt19937 engine(dice_++);
    std::normal_distribution<double> noise(0.0, options_.decodeSigma);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    std::vector<ProjectorPoint> light;
    const CalibratedCamera& lamp = projector();
    eachLit(real_, [&](const Ray& ray, const Lab::Hit& hit) {
        const auto pixel = pixelOf(lamp, hit.point);
        if (!pixel) return;
        cv::Point2d read(pixel->x + noise(engine), pixel->y + noise(engine));
        if (any(engine) < options_.strayShare) read = {any(engine) * lamp.size.x, any(engine) * lamp.size.y};
        light.push_back({{ray.pixel.x, ray.pixel.y}, read});
    });
    return light;
}

std::vector<int> ServoLab::seen(std::span<const double> strokes) const {
    std::vector<int> counts(rig_.actuatorCount(), 0);
    eachLit(strokes, [&](const Ray&, const Lab::Hit& hit) {
        if (hit.surface != 0) return;
        const glm::uvec3& corners = rig_.restMesh().triangles[hit.triangle];
        for (const std::uint16_t i : rig_.actuatorsOf(corners.x)) ++counts[i];
    });
    return counts;
}

} // namespace lumorph
