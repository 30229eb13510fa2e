#include "calibration/patterns/capture_order.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;

std::string linesOf(const CaptureOrder& order) {
    std::string lines;
    for (const PatternImage& image : order.images) lines += wordsOf(image) + "\n";
    return lines;
}

TEST(CaptureOrder, GrayCodeIsColumnsThenRowsEachBitWithItsInverseThenWhiteAndBlack) {
    const CaptureOrder order = parsePattern("graycode", {8, 3});
    EXPECT_EQ(linesOf(order), "column bit 2\ncolumn bit 2 inverse\ncolumn bit 1\ncolumn bit 1 inverse\n"
                              "column bit 0\ncolumn bit 0 inverse\nrow bit 1\nrow bit 1 inverse\n"
                              "row bit 0\nrow bit 0 inverse\nwhite\nblack\n");
    EXPECT_EQ(parsePattern("graycode", {1024, 768}).images.size(), 42U);
}

TEST(CaptureOrder, PhaseSetsComeInTheOrderInWhichTheyAreNamed) {
    const CaptureOrder order = parsePattern("phase:16x3+1x4", {256, 192});
    ASSERT_EQ(order.images.size(), 14U);
    EXPECT_EQ(order.images[2], PatternImage(PhaseStep{PatternAxis::columns, 16, 2, 3}));
    EXPECT_EQ(order.images[3], PatternImage(PhaseStep{PatternAxis::columns, 1, 0, 4}));
    EXPECT_EQ(order.images[7], PatternImage(PhaseStep{PatternAxis::rows, 16, 0, 3}));
}

TEST(CaptureOrder, ItsOwnLinesAreReadBack) {
    for (const char* pattern : {"graycode", "phase:16x3+1x3", "phase:12x3+13x5"}) {
        const CaptureOrder order = parsePattern(pattern, {256, 192});
        EXPECT_EQ(parseCaptureOrder(linesOf(order), "order.txt", {256, 192}), order) << pattern;
    }
    EXPECT_EQ(parseCaptureOrder("# mine\n\n white \nunused # no use\n", "o", {64, 64}).images,
              (std::vector<PatternImage>{FlatField{true}, UnusedImage{}}));
}

TEST(CaptureOrder, WrongPatternsAreRefusedWithTheirReason) {
    const std::pair<const char*, const char*> wrong[] = {
        {"greycode", "no such pattern"},
        {"phase:16", "is no number of periods x steps"},
        {"phase:16x2+1x3", "2 steps"},
        {"phase:0x3", "0 periods"},
        {"phase:99999x3+1x3", "99999 periods"},
        {"phase:16x3", "nothing tells one period from the next"},
        {"phase:16x3+1x3+", "is no number of"},
        {"phase:16x3+1x-3", "-3 steps"},
        {"phase:1x3+999999999999999x3", "is no"},
    };
    for (const auto& [text, why] : wrong) {
        try {
            (void)parsePattern(text, {1024, 768});
            ADD_FAILURE() << text << " was taken";
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), HasSubstr(why)) << text;
        }
    }
}

TEST(CaptureOrder, WrongLinesAreRefusedWithTheirNumber) {
    const std::pair<const char*, const char*> wrong[] = {
        {"white\nblak\n", "order.txt, line 2"},
        {"white\nblack\nwhite\n", "order.txt, line 3"},
        {"column bit 10\n", "finer than the projector's pixels"},
        {"column bit -1\n", "no image that is known"},
        {"column phase 16 step 3 of 3\n", "no image that is known"},
        {"row bit 2 inverted\n", "no image that is known"},
        {"", "names no image"},
    };
    for (const auto& [text, why] : wrong) {
        try {
            (void)parseCaptureOrder(text, "order.txt", {1024, 768});
            ADD_FAILURE() << text << " was taken";
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(why)) << text;
        }
    }
}

TEST(CaptureOrder, ProjectorSizesAreWidthXHeight) {
    EXPECT_EQ(parseProjectorSize("1024x768"), cv::Size(1024, 768));
    for (const char* wrong :
         {"", "1024", "1024x", "x768", "1024x768x3", "-5x768", "0x0", "1024 x 768", "1e3x768", "99999x99999"})
        EXPECT_THROW((void)parseProjectorSize(wrong), InvalidInput) << wrong;
}

TEST(PhaseShift, EveryPixelShowsTheCosineOfItsCentre) {
    const cv::Size size(96, 40);
    const cv::Mat columns = drawPattern(PhaseStep{PatternAxis::columns, 6, 1, 3}, size);
    const cv::Mat rows = drawPattern(PhaseStep{PatternAxis::rows, 1, 3, 4}, size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const double column = 2 * std::numbers::pi * (6 * (x + 0.5) / 96 - 1.0 / 3);
            const double row = 2 * std::numbers::pi * ((y + 0.5) / 40 - 3.0 / 4);
            ASSERT_NEAR(columns.at<uchar>(y, x), 127.5 + 127.5 * std::cos(column), 0.51);
            ASSERT_NEAR(rows.at<uchar>(y, x), 127.5 + 127.5 * std::cos(row), 0.51);
        }
}

} // namespace
} // namespace lumorph
