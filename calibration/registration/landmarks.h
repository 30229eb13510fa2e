#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/registration/pose_file.h"
#include "calibration/registration/pose_track.h"

namespace lumorph {

/// One point of a model, and how well a tracked pointer met it.
struct Landmark {
    std::string name;
    bool touched = false;
    glm::dvec3 touchedAt{0.0}; ///< in the reference's frame, metres
    Pose pointer;              ///< likewise; the tip is at `touchedAt`
    glm::dvec3 onModel{0.0};   ///< metres
    double error = 0.0;        ///< metres from where the fit has it
    /// Leave-one-out: the same of the fit to all the others. It flatters less than `error`, but each point had a say in
    /// which place is which, and in the fits of all the others. What judges a registration is points that no fit saw.
    double leaveOneOut = 0.0;
};

/// Where a model lies in the frame of the body that is fixed to it.
struct LandmarkFit {
    Pose modelFromReference;      ///< takes the reference body's coordinates to the model's
    double rms = 0.0;             ///< metres
    std::vector<Landmark> points; ///< as the model has them
    std::size_t worst = 0;        ///< of the touched ones, by leaveOneOut
    std::vector<Finding> warnings;
};

/// From a pointer that rests for a second on one point of the model after another. `pointer` and `reference` are poses
/// in the tracker's world by one clock; without a reference the model lies still in that world. Dwells find
/// themselves; which is of which point comes from the distances between them, and where the model looks alike from
/// several sides, from the order of its points. Dwells elsewhere count for nothing.
///
/// Throws CaptureRefused, where no choice of points fits: `tip_wrong` with the tip that would, `wrong_units`,
/// `mirrored`, `too_few_points`, `points_degenerate`, `time_unit` (times that count frames), else `model_does_not_fit`
/// (another model, another order).
[[nodiscard]] LandmarkFit fitLandmarks(const PoseTrack& pointer, const std::optional<PoseTrack>& reference,
                                       const std::vector<NamedPoint>& model, const glm::dvec3& tip);

} // namespace lumorph
