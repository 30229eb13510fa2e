#include "calibration/patterns/gray_code.h"

#include <bit>

#include "core/base/error.h"

namespace lumorph {

namespace {

bool grayBit(int index, int bit) { return ((index ^ (index >> 1)) >> bit) & 1; }

void appendPair(std::vector<cv::Mat>& patterns, const cv::Mat& pattern) {
    patterns.push_back(pattern);
    patterns.push_back(255 - pattern);
}

} // namespace

int grayCodeBits(int count) { return std::bit_width(static_cast<unsigned>(count - 1)); }

std::vector<cv::Mat> grayCodePatterns(cv::Size size) {
    if (size.width < 1 || size.height < 1)
        throw InvalidInput("projector size", "a pattern needs at least one pixel", "give width and height in pixels");
    std::vector<cv::Mat> patterns;
    for (int bit = grayCodeBits(size.width) - 1; bit >= 0; --bit) {
        cv::Mat row(1, size.width, CV_8U);
        for (int x = 0; x < size.width; ++x) row.at<uchar>(x) = grayBit(x, bit) ? 255 : 0;
        appendPair(patterns, cv::repeat(row, size.height, 1));
    }
    for (int bit = grayCodeBits(size.height) - 1; bit >= 0; --bit) {
        cv::Mat column(size.height, 1, CV_8U);
        for (int y = 0; y < size.height; ++y) column.at<uchar>(y) = grayBit(y, bit) ? 255 : 0;
        appendPair(patterns, cv::repeat(column, 1, size.width));
    }
    return patterns;
}

} // namespace lumorph
