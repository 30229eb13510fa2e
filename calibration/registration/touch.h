#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/registration/recording_check.h"

namespace lumorph {

/// A recording of a pointer whose tip is held on something for a second, and of the body that this something is fixed
/// to, where it is tracked: both by one clock in the tracker's world.
struct Touch {
    std::string name; ///< of what was touched, for messages
    PoseTrack pointer;
    std::optional<PoseTrack> body;
};

/// What a touch comes to: means over its time.
struct Rest {
    Pose pointer;     ///< in the body's frame, or the tracker's world where no body is tracked; `pointer * tip` is the
                      ///< mean place of the tip
    Pose body;        ///< in the tracker's world; identity without one
    double rms = 0.0; ///< metres by which single poses have the tip elsewhere
    std::size_t poses = 0;
    std::vector<Finding> warnings; ///< as of soundTrack; `tip_slipped` where the tip slid meanwhile
};

/// Throws CaptureRefused as soundTrack does, `tracker_lost` for fewer than 15 moments, `clock_jumps` where pointer and
/// body were not recorded at the same time, and `tip_slipped` where the tip does not rest within `wander` metres.
[[nodiscard]] Rest restOf(const Touch& touch, const glm::dvec3& tip, double wander = 0.005);

/// The same capture without a fault that all its poses share; with a null pointer as it is.
[[nodiscard]] Touch withoutFault(const Touch& touch, const CaptureFault* fault);
[[nodiscard]] glm::dvec3 withoutFault(const glm::dvec3& tip, const CaptureFault* fault);

/// Standard deviation of a rest's mean along each axis, metres: what tracker and hand leave of it. Neighbouring poses
/// err alike, as if one in five were independent.
[[nodiscard]] double noiseOf(const Rest& rest);

/// The mean of poses that are near one another.
[[nodiscard]] Pose meanPose(std::span<const Pose> poses);

} // namespace lumorph
