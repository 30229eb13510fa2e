#include "core/loop/motion_stage.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rig_motion.h"

namespace lumorph {

namespace {

constexpr double kArrived = 1e-5; // strokes; a thousandth of a degree

bool sameActuators(const Rig& a, const Rig& b) {
    return std::ranges::equal(a.actuators(), b.actuators(), {}, &Actuator::name, &Actuator::name);
}

} // namespace

void MotionStage::follow(const std::shared_ptr<const Rig>& rig) {
    if (rig == rig_) return;
    const std::vector<double> last(motion_.positions().begin(), motion_.positions().end());
    const bool stay = rig_ && sameActuators(*rig_, *rig);
    limits_ = motionLimits(*rig);
    motion_ = MotionModel(limits_);
    if (stay) motion_.reset(last);
    rig_ = rig;
    deformed_ = nullptr;
}

void MotionStage::move(std::span<const double> wanted, double seconds, bool stopped) {
    const std::vector<double> before(motion_.positions().begin(), motion_.positions().end());
    if (stopped) {
        motion_.reset(before); // velocities become zero
        return;
    }
    motion_.step(wanted, seconds);
    // The approach has no end; its last, invisible bit is done at once where the limits allow it.
    bool ends = arrived(wanted);
    for (std::size_t i = 0; i < before.size() && ends; ++i)
        ends = std::abs(wanted[i] - before[i]) <= limits_[i].maxVelocity * seconds;
    if (ends) motion_.reset(wanted);
}

bool MotionStage::arrived(std::span<const double> wanted) const noexcept {
    const auto near = [](double a, double b) { return std::abs(a - b) <= kArrived; };
    return std::ranges::equal(motion_.positions(), wanted, near);
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
