#include "calibration/registration/pose_track.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>

namespace lumorph {

Pose readAs(const Pose& pose, PoseReading reading) {
    Pose read = pose;
    const glm::dquat& q = pose.rotation;
    if (reading.wFirst) read.rotation = {q.x, q.y, q.z, q.w}; // w was taken for x, and so on; glm takes w first
    return reading.inverted ? inverseOf(read) : read;
}

PoseTrack readAs(PoseTrack track, PoseReading reading) {
    for (TimedPose& at : track.poses) at.pose = readAs(at.pose, reading);
    return track;
}

std::optional<Pose> poseAt(const PoseTrack& track, double seconds, double longestGap) {
    const auto after = std::ranges::lower_bound(track.poses, seconds, {}, &TimedPose::seconds);
    if (after == track.poses.end()) return std::nullopt;
    if (after->seconds == seconds) return after->pose;
    if (after == track.poses.begin()) return std::nullopt;
    const TimedPose& from = *std::prev(after);
    if (after->seconds - from.seconds > longestGap) return std::nullopt;
    const double share = (seconds - from.seconds) / (after->seconds - from.seconds);
    return Pose{glm::mix(from.pose.position, after->pose.position, share),
                glm::slerp(from.pose.rotation, after->pose.rotation, share)};
}

double angleOf(const glm::dquat& rotation) {
    return 2.0 * std::atan2(glm::length(glm::dvec3(rotation.x, rotation.y, rotation.z)), std::abs(rotation.w));
}

glm::dvec3 turnOf(const glm::dquat& rotation) {
    const glm::dvec3 axis = glm::dvec3(rotation.x, rotation.y, rotation.z) * (rotation.w < 0.0 ? -1.0 : 1.0);
    const double sine = glm::length(axis);
    if (sine < 1e-12) return 2.0 * axis;
    return axis * (angleOf(rotation) / sine);
}

glm::dquat rotationOfTurn(const glm::dvec3& turn) {
    const double angle = glm::length(turn);
    if (angle < 1e-12) return glm::normalize(glm::dquat(1.0, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z));
    const glm::dvec3 axis = turn * (std::sin(0.5 * angle) / angle);
    return {std::cos(0.5 * angle), axis.x, axis.y, axis.z};
}

} // namespace lumorph
