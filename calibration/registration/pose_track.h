#pragma once

#include <optional>
#include <string>
#include <string_view>
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
    std::vector<Finding> warnings; ///< rows that were left out, and why
};

/// Reads rows `time,x,y,z,qx,qy,qz,qw` (seconds, metres); `#` begins a comment, blanks may stand anywhere, also in
/// place of the commas. A row with
/// the time of the one before is left out with a warning. Throws DataError with the line for a row that is no pose (not
/// eight finite numbers, a quaternion whose length is not 1 within 2 %), CaptureRefused for a clock that goes back,
/// for fewer than two poses and for places farther than 200 m, which are millimetres or centimetres. `name` is the
/// file's, for messages.
[[nodiscard]] PoseTrack parsePoseTrack(std::string_view text, const std::string& name);

/// Points `name,x,y,z`, metres.
struct NamedPoint {
    std::string name;
    glm::dvec3 place{0.0};
};
/// Reads such rows as parsePoseTrack does. Throws DataError with the line; also for two points of one name.
[[nodiscard]] std::vector<NamedPoint> parseNamedPoints(std::string_view text, const std::string& name);

/// The pose at a time, between the two around it: straight, and by the shortest turn. Nothing before the first, after
/// the last, and in a gap longer than `longestGap` seconds.
[[nodiscard]] std::optional<Pose> poseAt(const PoseTrack& track, double seconds, double longestGap = 0.35);

/// Angle of the turn, radians, 0 to pi.
[[nodiscard]] double angleOf(const glm::dquat& rotation);
/// Axis times angle, radians.
[[nodiscard]] glm::dvec3 turnOf(const glm::dquat& rotation);
[[nodiscard]] glm::dquat rotationOfTurn(const glm::dvec3& turn);

} // namespace lumorph
