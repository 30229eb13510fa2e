#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/calibration_board.h"
#include "calibration/solve/error_map.h"

namespace lumorph {

/// Where content is to be projected to, and what of it matters.
struct PoseSearch {
    /// Places in the camera's frame whose error is to fall; empty: a grid over the volume that the poses so far span.
    std::vector<LitPlace> places;
    double nearest = 0.0, farthest = 0.0; ///< of the board's middle from the camera, the board's unit; 0: as before
    double worthwhile = 0.1;              ///< a pose must lower the mean error by this share to be worth it
};

/// A pose that is worth capturing.
struct NextPose {
    PoseVector cameraFromBoard{};     ///< radians; the board's unit
    std::vector<cv::Point2d> outline; ///< of the board's points, four corners in order, camera pixels: the ghost
    double meanBefore = 0.0, meanAfter = 0.0; ///< 95 % error over the places, the board's unit
    double worstBefore = 0.0, worstAfter = 0.0;
    bool worthIt = false; ///< false: this is the best there is, and it no longer lowers the error by much
};

/// Of some hundred poses of the board that camera and projector both see, the one that would lower the mean 95 % error
/// over the places most, were it captured like the others. Distortion that was left out because the data could not tell
/// it counts as unknown, so that the corners get their poses too. Nothing where no pose is seen by both.
[[nodiscard]] std::optional<NextPose> suggestNextPose(const ProcamCalibration& calibration,
                                                      const CalibrationBoard& board, const PoseSearch& search = {},
                                                      const Progress& progress = {});

} // namespace lumorph
