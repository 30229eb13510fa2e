#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/decode/pattern_decoder.h"

namespace lumorph {

/// A camera pixel on the board, and the projector pixel that lights it; both to a fraction.
struct ProjectorPoint {
    cv::Point2d camera;
    cv::Point2d projector;
};

/// What one pose tells.
struct ViewObservations {
    std::string name;
    BoardPoints corners;
    std::vector<ProjectorPoint> projector; ///< empty where only the camera is calibrated
};

/// Decoded pixels inside the outline of the board's points, averaged over squares of camera pixels so that at most
/// about `most` remain. A square counts where most of it is decoded and lies in one plane of coordinates, all but a
/// third of a projector pixel; stray codes are left out first.
[[nodiscard]] std::vector<ProjectorPoint> projectorPointsOn(const DecodedView& view,
                                                            const std::vector<cv::Point2d>& boardPoints, int most);

} // namespace lumorph
