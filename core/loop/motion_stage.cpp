#include "core/loop/motion_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/motion/rig_motion.h"

namespace lumorph {

namespace {

constexpr double kArrived = 1e-5; // strokes; a thousandth of a degree

bool sameActuators(const Rig& a, const Rig& b) {
    return std::ranges::equal(a.actuators(), b.actuators(), {}, &Actuator::name, &Actuator::name);
}

std::optional<std::size_t> placeOf(const Rig& rig, const std::string& actuator) {
    const auto found = std::ranges::find(rig.actuators(), actuator, &Actuator::name);
    if (found == rig.actuators().end()) return std::nullopt;
    return static_cast<std::size_t>(found - rig.actuators().begin());
}

} // namespace

void MotionStage::follow(const std::shared_ptr<const Rig>& rig, const std::shared_ptr<const void>& origin) {
    if (rig == rig_) return;
    const bool edited = rig_ && origin && origin == origin_;
    const bool stay = edited || (rig_ && sameActuators(*rig_, *rig));
    const MotionModel last = std::exchange(motion_, MotionModel(motionLimits(*rig)));
    const std::vector<double> real = std::exchange(real_, std::vector<double>(rig->actuatorCount(), 0.0));
    limits_ = motionLimits(*rig);
    if (stay) goOn(last, real, *rig_, *rig);
    if (installation_) curves_ = ServoCurves(rig->actuators(), installation_->servos);
    curves_.follow(commands(), real_);
    rig_ = rig;
    origin_ = origin;
    deformed_ = nullptr;
}

void MotionStage::use(const std::shared_ptr<const Installation>& installation) {
    if (installation == installation_) return;
    const bool same = installation && installation_ && installation->servos == installation_->servos;
    installation_ = installation;
    if (same) return;
    curves_ = installation && rig_ ? ServoCurves(rig_->actuators(), installation->servos) : ServoCurves();
    curves_.follow(commands(), real_);
}

void MotionStage::standAt(std::span<const double> strokes) {
    motion_.reset(strokes);
    real_.assign(strokes.begin(), strokes.end());
    if (!curves_.empty()) motion_.reset(curves_.commandsAt(strokes));
}

void MotionStage::goOn(const MotionModel& last, const std::vector<double>& real, const Rig& from, const Rig& to) {
    const bool sameCount = from.actuatorCount() == to.actuatorCount();
    std::vector<double> positions(to.actuatorCount(), 0.0), velocities(to.actuatorCount(), 0.0);
    for (std::size_t i = 0; i < to.actuatorCount(); ++i) {
        auto before = placeOf(from, to.actuators()[i].name);
        if (!before && sameCount) before = i;
        if (!before) continue;
        positions[i] = last.positions()[*before];
        velocities[i] = last.velocities()[*before];
        real_[i] = real[*before];
    }
    motion_.resume(positions, velocities);
}

void MotionStage::move(std::span<const double> wanted, double seconds, bool stopped) {
    const std::vector<double> before(motion_.positions().begin(), motion_.positions().end());
    if (stopped) {
        motion_.reset(before); // velocities become zero
        return;
    }
    const std::vector<double> aims = curves_.commandsFor(wanted, real_, before);
    motion_.step(aims, seconds);
    // The approach has no end; its last, invisible bit is done at once where the limits allow it.
    bool ends = isAt(aims);
    for (std::size_t i = 0; i < before.size() && ends; ++i)
        ends = std::abs(aims[i] - before[i]) <= limits_[i].maxVelocity * seconds;
    if (ends) motion_.reset(aims);
    curves_.follow(commands(), real_);
}

bool MotionStage::arrived(std::span<const double> wanted) const {
    return isAt(curves_.commandsFor(wanted, real_, commands()));
}

bool MotionStage::isAt(std::span<const double> commands) const noexcept {
    const auto near = [](double a, double b) { return std::abs(a - b) <= kArrived; };
    return std::ranges::equal(motion_.positions(), commands, near);
}

const std::shared_ptr<const std::vector<glm::vec3>>& MotionStage::deformed() {
    if (deformed_ && std::ranges::equal(deformedAt_, strokes())) return deformed_;
    auto positions = std::make_shared<std::vector<glm::vec3>>(rig_->restMesh().positions.size());
    rig_->deform(strokes(), *positions);
    deformedAt_.assign(strokes().begin(), strokes().end());
    deformed_ = std::move(positions);
    return deformed_;
}

} // namespace lumorph
