#include "calibration/patterns/gray_code.h"

#include <gtest/gtest.h>

#include "calibration/patterns/capture_order.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

std::vector<cv::Mat> patternsOf(cv::Size size) {
    std::vector<cv::Mat> patterns;
    for (const PatternImage& image : parsePattern("graycode", size).images)
        patterns.push_back(drawPattern(image, size));
    return patterns;
}

// Decodes as a camera would: a bit is 1 where the pattern is brighter than its inverse.
int decode(const std::vector<cv::Mat>& patterns, std::size_t first, int bits, int x, int y) {
    int binary = 0;
    for (int bit = 0; bit < bits; ++bit) {
        const std::size_t pair = first + 2 * static_cast<std::size_t>(bit);
        const int gray = patterns[pair].at<uchar>(y, x) > patterns[pair + 1].at<uchar>(y, x) ? 1 : 0;
        binary = (binary << 1) | (gray ^ (binary & 1));
    }
    return binary;
}

TEST(GrayCode, EveryPixelDecodesToItsOwnIndices) {
    const cv::Size size(100, 37);
    const auto patterns = patternsOf(size);
    ASSERT_EQ(patterns.size(), 2U * (7 + 6) + 2U) << "and white and black";
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            ASSERT_EQ(decode(patterns, 0, 7, x, y), x);
            ASSERT_EQ(decode(patterns, 14, 6, x, y), y);
        }
}

TEST(GrayCode, NeighbouringColumnsDifferInOneBitOnly) {
    const auto patterns = patternsOf({1024, 1});
    for (int x = 1; x < 1024; ++x) {
        int different = 0;
        for (std::size_t i = 0; i < 20; i += 2)
            different += patterns[i].at<uchar>(0, x) != patterns[i].at<uchar>(0, x - 1);
        ASSERT_EQ(different, 1) << x;
    }
}

TEST(GrayCode, AnEmptyProjectorIsRefused) {
    EXPECT_THROW((void)grayCodePattern({0, 768}, PatternAxis::columns, 0, false), InvalidInput);
}

} // namespace
} // namespace lumorph
