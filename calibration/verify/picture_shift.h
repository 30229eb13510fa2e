#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "calibration/verify/show_prediction.h"

namespace lumorph {

/// A small square of a camera picture in which one projector's light lies on one smooth surface.
struct WatchCell {
    cv::Rect place;
    std::size_t projector = 0;
    cv::Point2d middle;           ///< camera pixels
    Eigen::Vector2d panel;        ///< the projector's pixel there
    Eigen::Matrix2d panelByPixel; ///< how that changes with the camera's pixel
};
/// All of a sight, `size` pixels a side, a new one each `step`.
[[nodiscard]] std::vector<WatchCell> cellsOf(const ShowSight& sight, int size = 14, int step = 10);

/// How far a cell's content lies beside in a photograph.
struct CellShift {
    enum class Kind {
        measured, ///< shift and information are
        empty,    ///< what is shown there has no structure
        unlike    ///< the photograph shows something else: a hand, a shadow, another picture
    };
    Kind kind = Kind::empty;
    Eigen::Vector2d shift{0.0, 0.0};                       ///< pixels, from where it was predicted
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero(); ///< of the shift, 1/pixel^2
    double gain = 1.0;                                     ///< grey levels a unit of predicted light
};
/// By least squares over brightness, offset and shift (Lucas and Kanade 1981), after a search of whole pixels where
/// that is far off. Both pictures are of one size and equally soft. `usualGain`: grey levels a unit of light, as cells
/// had before, so that dark content is not taken for something else; 0 where it is not known.
[[nodiscard]] CellShift shiftOf(const cv::Mat1f& predicted, const cv::Mat1f& seen, const cv::Rect& cell,
                                double usualGain = 0.0);

/// What two predictions leave unexplained of a photograph, where they differ: sums of squares, grey levels.
struct Rivalry {
    double first = 0.0, second = 0.0;
    int squares = 0; ///< of the picture, that tell
};
/// Brightness and offset are free in each small square; squares that neither explains are left out.
[[nodiscard]] Rivalry rivalryOf(const cv::Mat1f& first, const cv::Mat1f& second, const cv::Mat1f& seen,
                                double usualGain);

} // namespace lumorph
