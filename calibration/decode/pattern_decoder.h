#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// What the images of one pose say of each camera pixel; all of the camera's size.
struct DecodedView {
    /// The projector's column and row that light the pixel, projector pixels with the first one's centre at 0; not a
    /// number where they cannot be told.
    cv::Mat1f column, row;
    /// 0 (not known) to 1: contrast of the weakest pattern that counts, as a share of the light that is modulated.
    cv::Mat1f confidence;
    /// Light that comes straight from the projector, and by way of other surfaces; grey levels at full white.
    cv::Mat1f direct, global;
    cv::Mat1b white, black; ///< as captured, or worked out of the patterns where they were not
    double noise = 0.0;     ///< standard deviation of one image's grey, levels
    int columnCell = 1;     ///< projector pixels a resolved stripe; more than 1 where the finest were not resolved
    int rowCell = 1;
};

/// Decodes the images of one pose, in the order's order and all of one size. A pixel is known where its direct light
/// stands out of noise and of the light by way of other surfaces, and at most one pattern of an axis is in doubt: at
/// the edge of a stripe one always is, and a Gray code gives it no weight. Within a stripe the coordinate is
/// interpolated between its edges, where pattern and inverse are equally bright. Throws InvalidInput where the numbers
/// of images differ, or the order lacks what an axis needs.
[[nodiscard]] DecodedView decodeView(const std::vector<cv::Mat>& images, const CaptureOrder& order);

/// Images that together make even light, by index: each pattern and its inverse, and the steps of each phase set; in
/// the order in which they begin.
[[nodiscard]] std::vector<std::vector<int>> evenSets(const CaptureOrder& order);

/// Images that show the scene under even light, worked out of each pattern and its inverse, and of each phase set, with
/// the index of the first image that it was made of. They differ only where something moved. 8-bit grey.
struct EvenlyLit {
    int firstImage = 0;
    int lastImage = 0;
    cv::Mat1b image;
};
[[nodiscard]] std::vector<EvenlyLit> evenlyLit(const std::vector<cv::Mat>& images, const CaptureOrder& order);

} // namespace lumorph
