#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/refusal.h"
#include "core/loop/pose_stream.h"

namespace lumorph {

struct TimedPose {
    double seconds = 0.0; ///< by the clock of whoever tracked it
    Pose pose;            ///< worldFromBody, metres
};

/// Poses of one body in one world by one clock, each later than the one before.
struct PoseTrack {
    std::vector<TimedPose> poses;
    std::vector<Finding> warnings; ///< rows that were left out or moved, other units; and why
};

/// How a recording was written, where it was not as we write: each pose `w, x, y, z`, or the world in the body's frame.
struct PoseReading {
    bool wFirst = false, inverted = false;
    bool operator==(const PoseReading&) const = default;
};
/// The pose as it would have been read that way.
[[nodiscard]] Pose readAs(const Pose& pose, PoseReading reading);
[[nodiscard]] PoseTrack readAs(PoseTrack track, PoseReading reading);

/// The pose at a time, between the two around it: straight, and by the shortest turn. Nothing before the first, after
/// the last, and in a gap longer than `longestGap` seconds.
[[nodiscard]] std::optional<Pose> poseAt(const PoseTrack& track, double seconds, double longestGap = 0.35);

/// Angle of the turn, radians, 0 to pi.
[[nodiscard]] double angleOf(const glm::dquat& rotation);
/// Axis times angle, radians.
[[nodiscard]] glm::dvec3 turnOf(const glm::dquat& rotation);
[[nodiscard]] glm::dquat rotationOfTurn(const glm::dvec3& turn);

} // namespace lumorph
