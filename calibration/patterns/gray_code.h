#pragma once

#include <opencv2/core.hpp>

#include "calibration/patterns/phase_shift.h"

namespace lumorph {

/// A stripe image for finding, for each camera pixel, the projector pixel that lights it: one bit of the
/// binary-reflected Gray code of the pixel's index; bit 0 is the finest. 8-bit grey, `size` projector pixels. Throws
/// InvalidInput for an empty size.
[[nodiscard]] cv::Mat grayCodePattern(cv::Size size, PatternAxis axis, int bit, bool inverse);

/// How many bits tell `count` indices apart.
[[nodiscard]] int grayCodeBits(int count);

} // namespace lumorph
