#include "calibration/decode/calibration_board.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_texture.h"
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
    for (const char* name : {"6X6_250", "6x6_250", "DICT_6X6_250"})
        EXPECT_EQ(parseCalibrationBoard(std::string("charuco:5x7:30:22:") + name).dictionary, "6X6_250") << name;
    for (const char* text : {"chess:9x7:75", "circles:4x11:20.5", "charuco:5x7:30:22", "charuco:5x7:30:22:6X6_250",
                             "charuco:6x8:0.03:0.022:APRILTAG_36h11:old", "charuco:6x8:30:22:old"})
        EXPECT_EQ(boardText(parseCalibrationBoard(text)), text);
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
        {"charuco:20x20:30:22:5X5_100", "more markers than the 100 of 5X5_100"},
        {"charuco:5x7:30:22:9X9_50", "'9X9_50' is no dictionary"},
        {"charuco:5x7:30:22:6X6_250:4X4_50", "'4X4_50' is no dictionary"},
        {"charuco:5x7:30:22:4X4_50:old:old", "not four parts"},
        {"chess:9x7:75:old", "not three parts"},
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

/// A board as it is printed, 2 pixels a unit, and where it begins on the page.
struct Printed {
    cv::Mat page;
    cv::Point2d first;
    [[nodiscard]] cv::Point2d at(const cv::Point3d& p) const { return {first.x + 2 * p.x, first.y + 2 * p.y}; }
};

Printed printed(const std::string& name, bool isWhiteOnBlack = false) {
    const BoardTexture texture(parseCalibrationBoard(name));
    constexpr int kFine = 4; // samples a pixel, along each side
    Printed result{cv::Mat(560, 680, CV_8U), {120.0, 60.0}};
    for (int y = 0; y < result.page.rows; ++y)
        for (int x = 0; x < result.page.cols; ++x) {
            double white = 0.0;
            for (int i = 0; i < kFine * kFine; ++i)
                white += texture.albedo(0.5 * (x - result.first.x + (i % kFine - 1.5) / kFine),
                                        0.5 * (y - result.first.y + (i / kFine - 1.5) / kFine)); // NOLINT
            const double grey = 255.0 * white / (kFine * kFine);
            result.page.at<uchar>(y, x) = cv::saturate_cast<uchar>(isWhiteOnBlack ? 235.0 - grey : grey);
        }
    return result;
}

Warped seen(const Printed& board) { return warped(board.page); }

TEST(CalibrationBoard, CharucoOfEachDictionaryAndLayoutIsFoundBySaidAndUnsaidName) {
    struct PrintedAs {
        const char* printedAs;
        const char* said;
        const char* family; ///< that is found
        std::size_t corners;
    };
    for (const PrintedAs& one :
         {PrintedAs{"charuco:7x6:30:22:6X6_250", "charuco:7x6:30:22:6X6_250", "6X6", 30},
          PrintedAs{"charuco:7x6:30:22:6X6_50", "charuco:7x6:30:22", "6X6", 30},
          PrintedAs{"charuco:7x6:30:22:5X5_100", "charuco:7x6:30:22", "5X5", 30},
          PrintedAs{"charuco:7x6:30:22:APRILTAG_36h11", "charuco:7x6:30:22:6X6_250", "APRILTAG_36h11", 30},
          PrintedAs{"charuco:7x6:30:22:old", "charuco:7x6:30:22", "4X4", 30},
          PrintedAs{"charuco:6x6:30:22:old", "charuco:6x6:30:22", "4X4", 25},
          PrintedAs{"charuco:7x6:30:22", "charuco:7x6:30:22:old", "4X4", 30},
          PrintedAs{"charuco:7x6:30:22:7X7_1000:old", "charuco:7x6:30:22:7X7_250", "7X7", 30},
          PrintedAs{"charuco:4x3:50:35", "charuco:4x3:50:35", "4X4", 6}}) {
        const Printed board = printed(one.printedAs);
        const Warped truth = seen(board);
        const CalibrationBoard said = parseCalibrationBoard(one.said);
        const auto found = findBoard(truth.picture, said);
        ASSERT_TRUE(found) << one.printedAs << " as " << one.said;
        EXPECT_EQ(found->seen.size(), one.corners) << one.printedAs;
        EXPECT_LT(errorOf(*found, truth, [&](const cv::Point3d& p) { return board.at(p); }), 0.1) << one.printedAs;
        EXPECT_TRUE(found->dictionary.starts_with(one.family)) << found->dictionary;
        const std::string saidFamily = said.dictionary.empty() ? "4X4" : said.dictionary.substr(0, 3);
        const auto warning = checkBoardKind("pose", said, *found);
        EXPECT_EQ(warning.has_value(), !std::string(one.family).starts_with(saidFamily)) << one.said;
        if (!warning) continue;
        EXPECT_EQ(warning->cause, Cause::boardKind);
        EXPECT_THAT(warning->why, HasSubstr(one.family));
        EXPECT_THAT(warning->remedy, HasSubstr("charuco:7x6:30:22:" + found->dictionary));
    }
}

TEST(CalibrationBoard, WhiteOnBlackIsFoundAsBlackOnWhite) {
    for (const char* name : {"charuco:7x6:30:22:5X5_250", "chess:8x6:25", "circles:4x9:20"}) {
        const Printed board = printed(name, true);
        const Warped truth = seen(board);
        const CalibrationBoard said = parseCalibrationBoard(name);
        const auto found = findBoard(truth.picture, said);
        ASSERT_TRUE(found) << name;
        const std::vector<cv::Point3d> all = pointsOf(said);
        ASSERT_EQ(found->seen.size(), all.size()) << name;
        const auto turned = [&](const cv::Point3d& p) {
            return board.at({all.back().x + all.front().x - p.x, all.back().y + all.front().y - p.y, 0.0});
        };
        EXPECT_LT(std::min(errorOf(*found, truth, [&](const cv::Point3d& p) { return board.at(p); }),
                           errorOf(*found, truth, turned)),
                  0.2)
            << name;
    }
}

TEST(CalibrationBoard, CornersOfABoardThatLeavesThePictureAreFoundWhereTheyAreInSight) {
    const Printed board = printed("charuco:7x6:30:22");
    const Warped truth = seen(board);
    const CalibrationBoard said = parseCalibrationBoard("charuco:7x6:30:22");
    // A hand over the middle, as bright as paper on one side and as ink on the other.
    cv::Mat covered = truth.picture.clone();
    const cv::Point middle = truth.at(board.at({105.0, 90.0, 0.0}));
    cv::ellipse(covered, middle, {55, 40}, 30.0, 0.0, 360.0, cv::Scalar(120), cv::FILLED);
    const auto around = findBoard(covered, said);
    ASSERT_TRUE(around);
    EXPECT_GE(around->seen.size(), 15U);
    EXPECT_LT(around->seen.size(), 30U);
    EXPECT_LT(errorOf(*around, truth, [&](const cv::Point3d& p) { return board.at(p); }), 0.15);
    // Parts of the board to the left of an edge of the picture.
    for (const double cut : {135.0, 105.0, 75.0}) {
        const int width = static_cast<int>(truth.at(board.at({cut, 90.0, 0.0})).x);
        const auto part = findBoard(truth.picture(cv::Rect(0, 0, width, truth.picture.rows)).clone(), said);
        ASSERT_TRUE(part) << cut;
        const std::vector<cv::Point3d> all = pointsOf(said);
        const auto inside =
            std::ranges::count_if(all, [&](const cv::Point3d& p) { return truth.at(board.at(p)).x < width; });
        EXPECT_LE(static_cast<std::ptrdiff_t>(part->seen.size()), inside) << cut;
        EXPECT_GE(static_cast<std::ptrdiff_t>(part->seen.size()), inside - 5) << cut << ": the last column may be cut";
        EXPECT_LT(errorOf(*part, truth, [&](const cv::Point3d& p) { return board.at(p); }), 0.15) << cut;
    }
    // A single column of corners tells no pose.
    const int narrow = static_cast<int>(truth.at(board.at({50.0, 90.0, 0.0})).x);
    EXPECT_FALSE(findBoard(truth.picture(cv::Rect(0, 0, narrow, truth.picture.rows)).clone(), said));
    EXPECT_FALSE(findBoard(truth.picture, parseCalibrationBoard("charuco:9x5:30:22"))) << "another board";
}

} // namespace
} // namespace lumorph
