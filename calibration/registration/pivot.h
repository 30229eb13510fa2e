#pragma once

#include <vector>

#include "calibration/registration/pose_track.h"

namespace lumorph {

/// The tip of a pointer, from swinging it about the tip while that rests in a dimple.
struct Pivot {
    glm::dvec3 tip{0.0};           ///< in the pointer's frame, metres
    glm::dvec3 dimple{0.0};        ///< in the world; of one that slid, where it was at the end
    double rms = 0.0;              ///< metres that the tip strays from the dimple, of the poses that count
    glm::dvec3 tipSigma{0.0};      ///< metres
    std::size_t poses = 0;         ///< that count
    std::vector<Finding> warnings; ///< swings during which the tip slipped, by their time; a dimple that slid
};

/// Least squares over R tip + t = dimple, poses that stray left out. Throws CaptureRefused: `motion_degenerate` with
/// the swing that is missing, `tip_slipped` where no place holds for half of the poses, `too_few_points`.
[[nodiscard]] Pivot solvePivot(const PoseTrack& swings);

} // namespace lumorph
