#include "calibration/decode/calibration_board.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calibration/tracking/board_finder.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;

TEST(CalibrationBoard, IsReadFromItsName) {
    const CalibrationBoard chess = parseCalibrationBoard("chess:9x7:75");
    EXPECT_EQ(chess, (CalibrationBoard{CalibrationBoard::Kind::chess, 9, 7, 75.0, 0.0}));
    EXPECT_EQ(parseCalibrationBoard("circles:4x11:20.5"),
              (CalibrationBoard{CalibrationBoard::Kind::circles, 4, 11, 20.5, 0.0}));
    EXPECT_EQ(parseCalibrationBoard("charuco:5x7:30:22"),
              (CalibrationBoard{CalibrationBoard::Kind::charuco, 5, 7, 30.0, 22.0}));
}

TEST(CalibrationBoard, WrongNamesAreRefusedWithTheirReason) {
    const std::pair<const char*, const char*> wrong[] = {
        {"", "no such kind"},
        {"cheese:9x7:75", "no such kind"},
        {"chess:9x7", "not three parts"},
        {"chess:9x7:75:3", "not three parts"},
        {"charuco:5x7:30", "not four parts"},
        {"chess:9:75", "no size from"},
        {"chess:2x7:75", "no size from"},
        {"chess:99999999999x7:75", "no size from"},
        {"chess:9x7:-75", "no length"},
        {"chess:9x7:nan", "no length"},
        {"chess:9x7:75mm", "no length"},
        {"charuco:5x7:30:31", "smaller than its square"},
        {"charuco:20x20:30:22", "more markers"},
    };
    for (const auto& [text, why] : wrong) {
        try {
            (void)parseCalibrationBoard(text);
            ADD_FAILURE() << text << " was taken";
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), HasSubstr(why)) << text;
        }
    }
}

/// A picture of a flat page under a homography, and what it does to a point of the page.
struct Warped {
    cv::Mat picture;
    cv::Matx33d matrix;
    [[nodiscard]] cv::Point2d at(const cv::Point2d& page) const {
        const cv::Vec3d point = matrix * cv::Vec3d(page.x, page.y, 1.0);
        return {point[0] / point[2], point[1] / point[2]};
    }
};

Warped warped(const cv::Mat& page) {
    const cv::Matx33d matrix(0.72, -0.11, 60.0, 0.09, 0.66, 45.0, 1.2e-4, 0.7e-4, 1.0);
    Warped result{{}, matrix};
    cv::warpPerspective(page, result.picture, matrix, {640, 560}, cv::INTER_AREA, cv::BORDER_CONSTANT, cv::Scalar(235));
    cv::GaussianBlur(result.picture, result.picture, {}, 0.8);
    return result;
}

/// Root mean square distance from where each point was drawn; `pageOf` gives its place on the page, pixels.
template <typename PageOf> double errorOf(const BoardPoints& found, const Warped& truth, const PageOf& pageOf) {
    double sum = 0.0;
    for (std::size_t i = 0; i < found.seen.size(); ++i) {
        const cv::Point2d off = found.seen[i] - truth.at(pageOf(found.board[i]));
        sum += off.dot(off);
    }
    return std::sqrt(sum / static_cast<double>(found.seen.size()));
}

TEST(CalibrationBoard, ChessboardCornersAreFoundToATenthOfAPixel) {
    cv::Mat page(560, 680, CV_8U, cv::Scalar(235));
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 10; ++column)
            if ((row + column) % 2 == 0)
                cv::rectangle(page, cv::Rect(40 + 60 * column, 40 + 60 * row, 60, 60), cv::Scalar(20), cv::FILLED);
    const Warped truth = warped(page);
    const auto found = findBoard(truth.picture, parseCalibrationBoard("chess:9x7:30"));
    ASSERT_TRUE(found);
    ASSERT_EQ(found->seen.size(), 63U);
    const auto straight = [](const cv::Point3d& p) { return cv::Point2d(99.5 + 2 * p.x, 99.5 + 2 * p.y); };
    const auto turned = [](const cv::Point3d& p) { return cv::Point2d(99.5 + 480 - 2 * p.x, 99.5 + 360 - 2 * p.y); };
    EXPECT_LT(std::min(errorOf(*found, truth, straight), errorOf(*found, truth, turned)), 0.1);
    EXPECT_FALSE(findBoard(truth.picture, parseCalibrationBoard("chess:8x7:30")));
    EXPECT_FALSE(findBoard(cv::Mat(200, 200, CV_8U, cv::Scalar(90)), parseCalibrationBoard("chess:9x7:30")));
}

TEST(CalibrationBoard, AsymmetricCirclesAreFoundToAFifthOfAPixel) {
    cv::Mat page(560, 680, CV_8U, cv::Scalar(235));
    for (int row = 0; row < 11; ++row)
        for (int column = 0; column < 4; ++column)
            cv::circle(page, {120 + 40 * (2 * column + row % 2), 80 + 40 * row}, 13, cv::Scalar(20), cv::FILLED,
                       cv::LINE_AA);
    const Warped truth = warped(page);
    const auto found = findBoard(truth.picture, parseCalibrationBoard("circles:4x11:20"));
    ASSERT_TRUE(found);
    ASSERT_EQ(found->seen.size(), 44U);
    EXPECT_LT(errorOf(*found, truth, [](const cv::Point3d& p) { return cv::Point2d(120 + 2 * p.x, 80 + 2 * p.y); }),
              0.2);
}

TEST(CalibrationBoard, CharucoCornersAreFoundThoughPartIsHidden) {
    const Image drawn = BoardFinder::page(MarkerBoard{}, 2400.0); // 5 x 7 squares of 30 mm, markers of 22 mm
    cv::Mat page(560, 680, CV_8U, cv::Scalar(235));
    for (int y = 0; y < drawn.size().y; ++y)
        for (int x = 0; x < drawn.size().x; ++x) page.at<uchar>(y + 20, x + 90) = drawn.at(x, y)[0];
    page(cv::Rect(90, 20, 120, 120)) = cv::Scalar(128);
    const Warped truth = warped(page);
    const auto found = findBoard(truth.picture, parseCalibrationBoard("charuco:5x7:30:22"));
    ASSERT_TRUE(found);
    EXPECT_GE(found->seen.size(), 18U);
    EXPECT_LT(found->seen.size(), 24U);
    // From the lower left corner of the page, as this version of OpenCV counts them.
    const auto up = [&](const cv::Point3d& p) {
        return cv::Point2d(89.5 + 2.4 * p.x, 19.5 + drawn.size().y - 2.4 * p.y);
    };
    const auto down = [](const cv::Point3d& p) { return cv::Point2d(89.5 + 2.4 * p.x, 19.5 + 2.4 * p.y); };
    EXPECT_LT(std::min(errorOf(*found, truth, up), errorOf(*found, truth, down)), 0.2);
}

} // namespace
} // namespace lumorph
