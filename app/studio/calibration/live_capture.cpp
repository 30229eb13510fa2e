#include "app/studio/calibration/live_capture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/registration/pivot.h"

namespace lumorph::studio {
namespace {

constexpr double kLost = 0.5;                                  // seconds without a pose
constexpr double kMostKept = 120.0;                            // seconds of one step
constexpr double kTurning = 0.15;                              // radians a second: a pointer that is swung, not held
constexpr double kElsewhere = 0.015;                           // metres from where the tip rested before
constexpr double kOtherwise = 15.0 * std::numbers::pi / 180.0; // between two ways to hold a pointer
constexpr double kLongestGap = 0.2;                            // seconds between poses of a rest
constexpr std::size_t kLeastPoses = 20;                        // of a rest

} // namespace

LiveCapture::LiveCapture(LivePlan plan, const glm::dvec3& tip) : plan_(std::move(plan)), tip_(tip) {}

void LiveCapture::add(PoseRole role, double seconds, const std::optional<Pose>& pose) {
    if (isComplete() || std::ranges::find(plan_.roles, role) == plan_.roles.end()) return;
    newest_ = std::max(newest_, seconds);
    std::deque<TimedPose>& poses = recent_[role];
    if (!pose) {
        if (plan_.steps[step()].ends != LiveStep::Ends::swung) poses.clear(); // a rest is seen as a whole
        return;
    }
    if (!poses.empty() && seconds <= poses.back().seconds) return;
    poses.push_back({seconds, *pose});
    while (poses.front().seconds < seconds - kMostKept) poses.pop_front();
    if (role != plan_.roles.front()) return;
    if (plan_.steps[step()].ends == LiveStep::Ends::swung)
        followSwings();
    else
        followRest();
}

void LiveCapture::takeBack() {
    trouble_.clear();
    recent_.clear();
    turned_ = fraction_ = 0.0;
    if (takes_.empty()) return;
    takes_.pop_back();
    rested_.pop_back();
}

std::vector<PoseRole> LiveCapture::missing() const {
    std::vector<PoseRole> missing;
    for (const PoseRole role : plan_.roles) {
        const auto found = recent_.find(role);
        if (found == recent_.end() || found->second.empty() || found->second.back().seconds < newest_ - kLost)
            missing.push_back(role);
    }
    return missing;
}

void LiveCapture::followSwings() {
    const std::deque<TimedPose>& poses = recent_[plan_.roles.front()];
    if (poses.size() < 2) return;
    const TimedPose &last = poses.back(), &before = poses[poses.size() - 2];
    const double seconds = last.seconds - before.seconds;
    if (seconds < kLost && angleOf(last.pose.rotation * glm::inverse(before.pose.rotation)) > kTurning * seconds)
        turned_ += seconds;
    fraction_ = std::min(turned_ / kSwingSeconds, 1.0);
    if (turned_ < kSwingSeconds) return;
    LiveTake take;
    take[plan_.roles.front()].poses.assign(poses.begin(), poses.end());
    Rested dimple;
    try {
        const Pivot pivot = solvePivot(take.begin()->second);
        tip_ = pivot.tip;
        // Who swings on there touches nothing new.
        dimple.tip = pivot.dimple;
    } catch (const CaptureRefused& refused) {
        // Better told now than at the end.
        recent_.clear();
        turned_ = fraction_ = 0.0;
        trouble_ = refused.finding().why;
        if (!refused.finding().remedy.empty()) trouble_ += "; " + refused.finding().remedy;
        return;
    }
    finishStep(std::move(take));
    rested_.push_back(dimple);
}

/// Where the tip rests now, if it has for long enough: on a tracked device in its frame, for that may be carried.
std::optional<LiveCapture::Rested> LiveCapture::resting() const {
    const std::deque<TimedPose>& poses = recent_.at(plan_.roles.front());
    if (poses.empty() || poses.front().seconds > poses.back().seconds - kRestSeconds) return std::nullopt;
    double before = poses.back().seconds - kRestSeconds;
    LiveTake take = lastMoments();
    const auto device = take.find(PoseRole::device);
    std::vector<glm::dvec3> tips;
    glm::dvec3 sum(0.0);
    for (const TimedPose& at : take[plan_.roles.front()].poses) {
        const std::optional<Pose> under = device == take.end() ? Pose{} : poseAt(device->second, at.seconds);
        if (!under) continue;
        if (at.seconds - before > kLongestGap) return std::nullopt;
        before = at.seconds;
        tips.push_back(inverseOf(*under) * (at.pose * tip_));
        sum += tips.back();
    }
    if (tips.size() < kLeastPoses) return std::nullopt;
    const glm::dvec3 middle = sum / double(tips.size());
    double squares = 0.0;
    for (const glm::dvec3& tip : tips) squares += glm::dot(tip - middle, tip - middle);
    if (squares > double(tips.size()) * kRestRadius * kRestRadius) return std::nullopt;
    return Rested{middle, poses.back().pose.rotation};
}

void LiveCapture::followRest() {
    const std::optional<Rested> rests = resting();
    fraction_ = 0.0;
    if (!rests || !missing().empty()) return;
    const LiveStep& wanted = plan_.steps[step()];
    const auto isNear = [&](const Rested& before) { return glm::distance(before.tip, rests->tip) < kElsewhere; };
    if (wanted.ends == LiveStep::Ends::atNewPlace) {
        // Where it still rests after the step before it is only slow to leave.
        if (!rested_.empty() && isNear(rested_.back())) return;
        if (std::ranges::any_of(rested_, isNear)) {
            trouble_ = "It rested here before; touch another place";
            return;
        }
    } else if (!rested_.empty()) {
        if (angleOf(rests->turn * glm::inverse(rested_.back().turn)) < kOtherwise) return;
        if (!isNear(rested_.back())) {
            trouble_ = "The tip has left its dimple; set it in again, and hold the pointer otherwise";
            return;
        }
    }
    finishStep(lastMoments());
    rested_.push_back(*rests);
}

LiveTake LiveCapture::lastMoments() const {
    const double from = recent_.at(plan_.roles.front()).back().seconds - kRestSeconds;
    LiveTake take;
    for (const auto& [role, poses] : recent_)
        for (const TimedPose& at : poses)
            if (at.seconds >= from) take[role].poses.push_back(at);
    return take;
}

void LiveCapture::finishStep(LiveTake take) {
    takes_.push_back(std::move(take));
    recent_.clear();
    turned_ = fraction_ = 0.0;
    trouble_.clear();
}

} // namespace lumorph::studio
