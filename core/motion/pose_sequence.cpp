#include "core/motion/pose_sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

const NamedPose& poseOf(const PoseSequence& sequence, const PoseStep& step) {
    const auto at = std::ranges::find(sequence.poses, step.pose, &NamedPose::name);
    if (at == sequence.poses.end())
        throw InvalidInput("pose " + inQuotes(step.pose), "no pose has this name",
                           "add the pose, or take out the step");
    return *at;
}

void requireSeconds(double seconds, const std::string& place) {
    if (!(seconds >= 0.0 && seconds <= kMaxStepSeconds))
        throw InvalidInput(place, "its time is not from 0 to an hour", "give seconds, such as 1.5");
}

void requirePose(const NamedPose& pose, std::size_t actuators) {
    const std::string place = "pose " + inQuotes(pose.name);
    if (pose.name.empty()) throw InvalidInput("a pose", "it has no name", "name it");
    if (pose.name.size() > kMaxPoseName)
        throw InvalidInput("pose " + inQuotes(pose.name.substr(0, 20) + "..."), "its name is too long",
                           "give it a name of at most " + std::to_string(kMaxPoseName) + " letters");
    if (pose.strokes.size() != actuators)
        throw InvalidInput(place,
                           "it has " + std::to_string(pose.strokes.size()) + " strokes, the device " +
                               std::to_string(actuators) + " actuators",
                           "take the pose again with this device");
    if (!std::ranges::all_of(pose.strokes, [](double s) { return s >= 0.0 && s <= 1.0; }))
        throw InvalidInput(place, "a stroke is not from 0 to 1", "take the pose again");
}

} // namespace

double eased(Easing easing, double u) noexcept {
    u = std::clamp(u, 0.0, 1.0);
    switch (easing) {
    case Easing::linear:
        break;
    case Easing::smooth:
        return u * u * (3.0 - 2.0 * u);
    case Easing::minimumJerk:
        return u * u * u * (10.0 + u * (6.0 * u - 15.0));
    }
    return u;
}

double peakSpeed(Easing easing) noexcept {
    switch (easing) {
    case Easing::linear:
        break;
    case Easing::smooth:
        return 1.5;
    case Easing::minimumJerk:
        return 1.875;
    }
    return 1.0;
}

double peakAcceleration(Easing easing) noexcept {
    switch (easing) {
    case Easing::linear:
        break;
    case Easing::smooth:
        return 6.0;
    case Easing::minimumJerk:
        return 10.0 / std::numbers::sqrt3;
    }
    return 0.0;
}

void requireSound(const PoseSequence& sequence, std::size_t actuators) {
    if (sequence.poses.size() > kMaxPoses)
        throw InvalidInput("the poses", "there are more than " + std::to_string(kMaxPoses), "remove some");
    std::set<std::string_view> names;
    for (const NamedPose& pose : sequence.poses) {
        requirePose(pose, actuators);
        if (!names.insert(pose.name).second)
            throw InvalidInput("pose " + inQuotes(pose.name), "another pose has the same name", "rename one of them");
    }
    if (sequence.steps.size() > kMaxPoseSteps)
        throw InvalidInput("the sequence", "it has more than " + std::to_string(kMaxPoseSteps) + " steps",
                           "make it a loop, or leave steps out");
    for (std::size_t k = 0; k < sequence.steps.size(); ++k) {
        const std::string place = "step " + std::to_string(k + 1) + ", " + inQuotes(sequence.steps[k].pose);
        (void)poseOf(sequence, sequence.steps[k]);
        requireSeconds(sequence.steps[k].travelSeconds, place);
        requireSeconds(sequence.steps[k].holdSeconds, place);
    }
}

void requirePlayable(const PoseSequence& sequence, std::size_t actuators) {
    if (sequence.steps.empty()) throw InvalidInput("the sequence", "it has no step", "add a pose to it");
    requireSound(sequence, actuators);
}

double durationOf(const PoseSequence& sequence) noexcept {
    double seconds = 0.0;
    for (const PoseStep& step : sequence.steps) seconds += step.travelSeconds + step.holdSeconds;
    return seconds;
}

std::vector<double> strokesAt(const PoseSequence& sequence, std::span<const double> from, double seconds) {
    const double round = durationOf(sequence);
    const std::vector<double>& last = poseOf(sequence, sequence.steps.back()).strokes;
    std::vector<double> before(from.begin(), from.end());
    if (seconds >= round) {
        if (!sequence.loop || round <= 0.0) return last;
        seconds = std::fmod(seconds, round);
        before = last;
    }
    for (const PoseStep& step : sequence.steps) {
        const std::vector<double>& to = poseOf(sequence, step).strokes;
        if (seconds < step.travelSeconds) {
            const double share = eased(step.easing, seconds / step.travelSeconds);
            for (std::size_t a = 0; a < before.size(); ++a) before[a] = std::lerp(before[a], to[a], share);
            return before;
        }
        before = to;
        seconds -= step.travelSeconds;
        if (seconds < step.holdSeconds) return before;
        seconds -= step.holdSeconds;
    }
    return before;
}

std::vector<PoseLimits> poseLimits(std::span<const MotionLimits> limits) {
    std::vector<PoseLimits> velocities;
    for (const MotionLimits& limit : limits) velocities.push_back({limit.maxVelocity});
    return velocities;
}

PoseSequence withinLimits(PoseSequence sequence, std::span<const double> from, std::span<const PoseLimits> limits) {
    requirePlayable(sequence, limits.size());
    if (from.size() != limits.size())
        throw InvalidInput("where the sequence begins", "it has not one stroke for each actuator", "take it again");
    const auto secondsBetween = [&](std::span<const double> a, std::span<const double> b, Easing easing) {
        double seconds = 0.0;
        for (std::size_t k = 0; k < limits.size(); ++k) {
            const double way = std::abs(b[k] - a[k]);
            seconds = std::max({seconds, peakSpeed(easing) * way / limits[k].maxVelocity,
                                std::sqrt(peakAcceleration(easing) * way / limits[k].maxAcceleration)});
        }
        return seconds;
    };
    std::vector<double> before(from.begin(), from.end());
    for (std::size_t k = 0; k < sequence.steps.size(); ++k) {
        PoseStep& step = sequence.steps[k];
        const std::vector<double>& to = poseOf(sequence, step).strokes;
        step.travelSeconds = std::max(step.travelSeconds, secondsBetween(before, to, step.easing));
        // The first way of a later round comes from the last pose.
        if (k == 0 && sequence.loop)
            step.travelSeconds = std::max(
                step.travelSeconds, secondsBetween(poseOf(sequence, sequence.steps.back()).strokes, to, step.easing));
        before = to;
    }
    return sequence;
}

double secondsOf(const PosePlay& play, Microseconds now) noexcept {
    return play.heldAt ? *play.heldAt : std::max(0.0, 1e-6 * static_cast<double>((now - play.since).count()));
}

bool movesOn(const PosePlay& play, Microseconds now) noexcept {
    return !play.heldAt && (play.sequence.loop || secondsOf(play, now) < durationOf(play.sequence));
}

} // namespace lumorph
