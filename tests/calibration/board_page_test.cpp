#include "calibration/tracking/board_page.h"

#include <cmath>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;

constexpr double kMillimetre = 72.0 / 25.4; // in points

/// The numbers of a PDF as its reader has them: sheet, scale, and every box of the path; points.
struct PrintedPage {
    double width = 0.0, height = 0.0, scale = 0.0;
    std::vector<std::array<double, 4>> boxes;
    std::vector<std::vector<cv::Point2d>> curves; ///< closed: a start, then two control points and an end each
    double ruler = 0.0;
};

PrintedPage readBack(const std::string& pdf) {
    PrintedPage page;
    std::istringstream media(pdf.substr(pdf.find("/MediaBox [0 0 ") + 15));
    media >> page.width >> page.height;
    const std::size_t begin = pdf.find("stream\n") + 7;
    std::istringstream lines(pdf.substr(begin, pdf.find("endstream") - begin));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::array<double, 4> n{};
        if (line.ends_with(" cm")) words >> page.scale;
        if (line.ends_with(" re")) {
            words >> n[0] >> n[1] >> n[2] >> n[3];
            for (double& one : n) one *= page.scale;
            page.boxes.push_back(n);
        }
        std::array<double, 6> c{};
        if (line.ends_with(" m") && words >> c[0] >> c[1])
            page.curves.push_back({page.scale * cv::Point2d(c[0], c[1])});
        if (line.ends_with(" c") && words >> c[0] >> c[1] >> c[2] >> c[3] >> c[4] >> c[5])
            for (std::size_t k = 0; k < c.size(); k += 2)
                page.curves.back().push_back(page.scale * cv::Point2d(c[k], c[k + 1]));
        std::string w, m;
        double width = 0.0, x0 = 0.0, y0 = 0.0, x1 = 0.0;
        if (line.starts_with("0.2 w ") && words >> width >> w >> x0 >> y0 >> m >> x1)
            page.ruler = (x1 - x0) * page.scale;
    }
    return page;
}

TEST(BoardPdf, HasItsTrueSizeOnA4) {
    const MarkerBoard board;
    const PrintedPage page = readBack(boardPdf(board));
    EXPECT_NEAR(page.width, 210.0 * kMillimetre, 0.01);
    EXPECT_NEAR(page.height, 297.0 * kMillimetre, 0.01);
    EXPECT_NEAR(page.ruler, 100.0 * kMillimetre, 0.01);
    double left = 1e9, right = 0.0, low = 1e9, high = 0.0, area = 0.0;
    for (const auto& [x, y, w, h] : page.boxes) {
        left = std::min(left, x);
        right = std::max(right, x + w);
        low = std::min(low, y);
        high = std::max(high, y + h);
        area += w * h;
    }
    EXPECT_NEAR(right - left, 150.0 * kMillimetre, 0.01) << "five squares of 30 mm";
    EXPECT_NEAR(high - low, 210.0 * kMillimetre, 0.01) << "seven of them";
    EXPECT_GT(left, 5.0 * kMillimetre) << "printers leave a margin white";
    EXPECT_NEAR(left, page.width - right, 0.01) << "in the middle";
    EXPECT_GT(low, 15.0 * kMillimetre) << "above the words";
    EXPECT_LT(high, page.height - 5.0 * kMillimetre);
    EXPECT_GT(area, 0.5 * 150.0 * 210.0 * kMillimetre * kMillimetre);
}

/// The page as a printer lays its ink, at so many pixels a millimetre.
cv::Mat1b printed(const std::string& pdf, double density) {
    const PrintedPage page = readBack(pdf);
    const double toPixels = density / kMillimetre;
    cv::Mat1b sheet(static_cast<int>(page.height * toPixels), static_cast<int>(page.width * toPixels), 255);
    constexpr int kShift = 8;                    // OpenCV's own parts of a pixel
    const auto pixel = [&](double x, double y) { // centres of pixels lie at whole numbers
        return cv::Point(static_cast<int>(std::lround((x * toPixels - 0.5) * (1 << kShift))),
                         static_cast<int>(std::lround((sheet.rows - y * toPixels - 0.5) * (1 << kShift))));
    };
    for (const auto& [x, y, w, h] : page.boxes)
        cv::fillConvexPoly(sheet, std::vector{pixel(x, y), pixel(x + w, y), pixel(x + w, y + h), pixel(x, y + h)}, 0,
                           cv::LINE_AA, kShift);
    for (const auto& curve : page.curves) {
        std::vector<cv::Point> outline;
        for (std::size_t k = 0; k + 3 < curve.size(); k += 3)
            for (double t = 0.0; t < 1.0; t += 0.05) {
                const double s = 1.0 - t;
                const cv::Point2d at = s * s * s * curve[k] + 3.0 * s * s * t * curve[k + 1] +
                                       3.0 * s * t * t * curve[k + 2] + t * t * t * curve[k + 3];
                outline.push_back(pixel(at.x, at.y));
            }
        cv::fillConvexPoly(sheet, outline, 0, cv::LINE_AA, kShift);
    }
    return sheet;
}

// By OpenCV's finders, which know nothing of the page: each point where it is to be, in millimetres.
TEST(CalibrationBoardPdf, IsFoundWithItsTrueDistances) {
    for (const char* text : {"chess:9x7:25", "chess:8x5:30", "circles:4x11:15", "charuco:5x7:30:22",
                             "charuco:6x8:25:18:6X6_250", "charuco:6x8:25:18:4X4_50:old"}) {
        const CalibrationBoard board = parseCalibrationBoard(text);
        constexpr double kDensity = 4.0;
        const auto found = findBoard(printed(calibrationBoardPdf(board), kDensity), board);
        ASSERT_TRUE(found) << text;
        EXPECT_EQ(found->seen.size(), pointsOf(board).size()) << text;
        double worst = 0.0;
        for (std::size_t i = 1; i < found->seen.size(); ++i)
            worst = std::max(worst, std::abs(cv::norm(found->seen[i] - found->seen.front()) / kDensity -
                                             cv::norm(found->board[i] - found->board.front())));
        EXPECT_LT(worst, 0.1) << text << ", millimetres";
    }
}

TEST(CalibrationBoardPdf, TellsWhatToMeasure) {
    const std::string pdf = calibrationBoardPdf(parseCalibrationBoard("chess:9x7:25"));
    EXPECT_THAT(pdf, HasSubstr("(Chessboard, 9 x 7 inner corners, squares of 25 mm.)"));
    EXPECT_THAT(pdf, HasSubstr("Measure 10 squares in a row: 250 mm."));
}

TEST(BoardPdf, TellsItsMeasuresAndHowToPrintIt) {
    const std::string pdf = boardPdf({MarkerBoard::Kind::aruco, 4, 5, 0.0355, 0.028, "6X6_250"});
    EXPECT_THAT(pdf, HasSubstr("(ArUco, 4 x 5 markers every 35.5 mm, markers of 28 mm, dictionary 6X6_250.)"));
    EXPECT_THAT(pdf, HasSubstr("100 %"));
    EXPECT_THAT(pdf, HasSubstr("/PrintScaling /None"));
}

TEST(BoardPdf, EveryObjectIsWhereItsTableSays) {
    const std::string pdf = boardPdf({});
    EXPECT_TRUE(pdf.starts_with("%PDF-1.4\n"));
    EXPECT_TRUE(pdf.ends_with("%%EOF\n"));
    const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
    ASSERT_EQ(pdf.substr(table, 5), "xref\n");
    std::istringstream entries(pdf.substr(table + 5));
    int first = 0, count = 0;
    entries >> first >> count;
    ASSERT_EQ(count, 7);
    for (int i = 0; i < count; ++i) {
        std::size_t at = 0;
        int generation = 0;
        char kind = 0;
        entries >> at >> generation >> kind;
        if (i == 0) continue;
        EXPECT_EQ(pdf.substr(at, 7), std::to_string(i) + " 0 obj");
    }
    const std::size_t begin = pdf.find("stream\n") + 7;
    const std::size_t length = std::stoul(pdf.substr(pdf.find("/Length ") + 8));
    EXPECT_EQ(pdf.substr(begin + length, 9), "endstream");
}

TEST(BoardPdf, TurnsOrGrowsTheSheetForWideAndLargeBoards) {
    const PrintedPage wide = readBack(boardPdf({MarkerBoard::Kind::charuco, 9, 4, 0.03, 0.022, "4X4_50"}));
    EXPECT_NEAR(wide.width, 297.0 * kMillimetre, 0.01);
    const PrintedPage large = readBack(boardPdf({MarkerBoard::Kind::charuco, 5, 7, 0.1, 0.08, "4X4_50"}));
    EXPECT_GT(large.width, 500.0 * kMillimetre);
    EXPECT_GT(large.height, 700.0 * kMillimetre);
    EXPECT_THROW((void)boardPdf({MarkerBoard::Kind::charuco, 5, 7, 0.1, 0.2, "4X4_50"}), InvalidInput);
}

} // namespace
} // namespace lumorph
