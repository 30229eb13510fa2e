#pragma once

#include <span>
#include <vector>

#include "calibration/registration/device_place.h"
#include "calibration/registration/pose_track.h"
#include "core/geometry/triangle_mesh.h"

/// The device by structured light on its surface.
namespace lumorph {

/// Where a model lies under points that were measured on its surface.
struct SurfaceFit {
    Pose worldFromModel;
    double rms = 0.0;                         ///< metres of the points that lie on it, from the surface
    double share = 0.0;                       ///< of the points, that lie on it
    double turnSigma = 0.0, shiftSigma = 0.0; ///< radians; metres, in the middle of the points
};

/// The rigid motion that lays the model's surface under the points (world, metres; of anything, such as the table, that
/// is not the model too): nearest places of the surface, point to plane (Chen and Medioni 1992), robust, with a reach
/// that shrinks. What faces away from `seenFrom`, where the camera stands, counts for nothing. `start` is right to 30
/// mm and 20 degrees. Throws CaptureRefused: `too_few_points` where fewer than 200 points lie on it,
/// `points_degenerate` where the surface that was seen may slide or turn along itself, `model_does_not_fit`,
/// `not_a_number`; Cancelled.
[[nodiscard]] SurfaceFit fitSurface(const TriangleMesh& model, std::span<const glm::dvec3> points,
                                    const glm::dvec3& seenFrom, const Pose& start, const Progress& progress = {});

/// The device on its body by such a fit, the body being tracked (in the tracker's world) while it was made.
[[nodiscard]] registration::FittedPlace placeDeviceBySurface(const SurfaceFit& fit, const PoseTrack& body,
                                                             const Pose& worldFromTracker);

} // namespace lumorph
