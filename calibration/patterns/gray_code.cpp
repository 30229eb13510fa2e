#include "calibration/patterns/gray_code.h"

#include <bit>

#include "core/base/error.h"

namespace lumorph {

namespace {

bool grayBit(int index, int bit) { return ((index ^ (index >> 1)) >> bit) & 1; }

} // namespace

int grayCodeBits(int count) { return std::bit_width(static_cast<unsigned>(count - 1)); }

cv::Mat grayCodePattern(cv::Size size, PatternAxis axis, int bit, bool inverse) {
    if (size.width < 1 || size.height < 1)
        throw InvalidInput("projector size", "a pattern needs at least one pixel", "give width and height in pixels");
    const int length = axis == PatternAxis::columns ? size.width : size.height;
    cv::Mat line(1, length, CV_8U);
    for (int n = 0; n < length; ++n) line.at<uchar>(n) = grayBit(n, bit) != inverse ? 255 : 0;
    return axis == PatternAxis::columns ? cv::repeat(line, size.height, 1) : cv::repeat(line.t(), 1, size.width);
}

} // namespace lumorph
