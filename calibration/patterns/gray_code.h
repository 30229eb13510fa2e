#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "calibration/patterns/phase_shift.h"

namespace lumorph {

/// Stripe images for finding, for each camera pixel, the projector pixel that lights it: first the
/// column bits, then the row bits, most significant first, each image followed by its inverse; the
/// code is the binary-reflected Gray code of the pixel's index. 8-bit grey, `size` projector pixels.
/// Throws InvalidInput for an empty size.
[[nodiscard]] std::vector<cv::Mat> grayCodePatterns(cv::Size size);

/// One of them; bit 0 is the finest. Throws InvalidInput for an empty size.
[[nodiscard]] cv::Mat grayCodePattern(cv::Size size, PatternAxis axis, int bit, bool inverse);

/// How many bits tell `count` indices apart.
[[nodiscard]] int grayCodeBits(int count);

} // namespace lumorph
