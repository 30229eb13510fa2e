#include "core/loop/drive_stage.h"

#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "core/motion/rig_motion.h"

namespace lumorph {

namespace {

bool isTarget(const SceneItem& item) { return std::holds_alternative<TargetItem>(item.kind); }

/// By how much the actuators' soft approach lies behind a slow wish, seconds: a critically damped one follows a ramp by
/// 2 damping settle behind.
double lagOf(const Rig& rig) {
    double lag = 0.0;
    const std::vector<MotionLimits> limits = motionLimits(rig);
    for (const MotionLimits& limit : limits) lag += 2.0 * limit.dampingRatio * limit.settleSeconds;
    return limits.empty() ? 0.0 : lag / static_cast<double>(limits.size());
}

} // namespace

DriveStage::Mode DriveStage::modeOf(const MatchWish& wish) {
    if (!wish.scene) return Mode::asWished;
    if (wish.scene->showing == Showing::virtualOnly) return Mode::atRest;
    const SceneItem* item = wish.driver == Driver::sceneItem ? drivingItemShown(*wish.scene) : nullptr;
    return item && (!isTarget(*item) || wish.target) ? Mode::byHeights : Mode::asWished;
}

std::vector<double> DriveStage::strokes(const MatchWish& wish, const MatchFrame& frame, double sinceLast) {
    const SceneItem& item = *drivingItem(*wish.scene);
    use(wish, frame, item, sinceLast);
    const bool target = isTarget(item);
    const double now = target ? targetClock_ : frame.sceneSeconds;
    sourceSeconds_ = now;
    if (item.role == ItemRole::physical) {
        std::vector<float> wished(split_->restHeights().begin(), split_->restHeights().end());
        heights_->at(now, wished);
        return split_->fit(wished);
    }
    const bool runs = target ? TargetStage::moves(wish) : wish.scenePlaying;
    if (!runs) split_->restart();
    const auto wished = [&](double seconds, std::span<float> heights) { heights_->at(seconds, heights); };
    return split_->strokes(wished, now + (runs ? lagOf(*wish.rig) : 0.0));
}

void DriveStage::use(const MatchWish& wish, const MatchFrame& frame, const SceneItem& item, double sinceLast) {
    if (splitRig_ != wish.rig) {
        heights_.reset();
        split_.reset();
        split_.emplace(*wish.rig);
        heights_.emplace(split_->points());
        splitRig_ = wish.rig;
    }
    source_.scene = wish.scene;
    source_.assets = wish.assets;
    source_.item = item.id;
    source_.worldFromDevice = frame.worldFromDevice;
    if (isTarget(item))
        followTarget(wish, frame, sinceLast);
    else
        source_.target = nullptr;
    heights_->use(source_);
}

/// The target's pose as a function of a clock of its own that never wraps, kept while it goes on as it did.
void DriveStage::followTarget(const MatchWish& wish, const MatchFrame& frame, double sinceLast) {
    if (TargetStage::moves(wish)) targetClock_ += sinceLast;
    const double played = wish.playing ? targetClock_ : 0.0;
    const double turned = frame.turned.inRadians() - wish.spin * targetClock_;
    const auto differs = [](double a, double b, double period) {
        return std::abs(period > 0.0 ? std::remainder(a - b, period) : a - b) > 1e-6;
    };
    const bool goesOn = source_.target == wish.target && placement_ == wish.placement &&
                        source_.playing == wish.playing && source_.spin == wish.spin && wish.target &&
                        !differs(source_.targetSeconds + played, frame.seconds, wish.target->duration) &&
                        !differs(turned_, turned, 2.0 * std::numbers::pi);
    if (goesOn) return;
    placement_ = wish.placement;
    turned_ = turned;
    source_.target = wish.target;
    source_.placement = wish.placement;
    source_.placement.yaw = Angle::radians(wish.placement.yaw.inRadians() + turned);
    source_.targetSeconds = frame.seconds - played;
    source_.playing = wish.playing;
    source_.spin = wish.spin;
}

std::vector<double> DriveStage::bends(const MatchWish& wish, const MatchFrame& frame) {
    if (!wish.scene || !wish.scene->viewDependence.on || wish.scene->showing == Showing::virtualOnly) return {};
    if (!frame.eye) return std::vector<double>(wish.rig->actuatorCount(), 0.0);
    // Only now: it takes tens of milliseconds, and while a rig is edited there is a new one with each frame.
    if (ruleRig_ != wish.rig) {
        rule_.emplace(*wish.rig);
        ruleRig_ = wish.rig;
    }
    const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(frame.worldFromDevice));
    return rule_->strokes(glm::dvec3(deviceFromWorld * glm::dvec4(*frame.eye, 1.0)), wish.scene->viewDependence.theta);
}

} // namespace lumorph
