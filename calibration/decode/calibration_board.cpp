#include "calibration/decode/calibration_board.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr int kMostPoints = 60; // a side
constexpr double kLongest = 1e5;
constexpr int kFewestSeen = 8;

std::vector<std::string_view> splitAt(std::string_view text, char mark) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(mark, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

/// Zero where it is none.
template <typename Number> Number numberIn(std::string_view text) {
    Number value{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    return read.ec == std::errc() && read.ptr == text.data() + text.size() ? value : Number{};
}

cv::Ptr<cv::aruco::CharucoBoard> charucoOf(const CalibrationBoard& board) {
    return cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.spacing),
                                           static_cast<float>(board.marker),
                                           cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
}

/// Corners by the edges around them, within half a square.
void refineCorners(const cv::Mat& grey, std::vector<cv::Point2f>& corners, double reach) {
    const int room = std::clamp(static_cast<int>(reach), 2, 11);
    cv::cornerSubPix(grey, corners, {room, room}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001});
}

/// The least distance between points that follow one another.
double leastDistance(const std::vector<cv::Point2f>& points) {
    double least = kLongest;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) least = std::min(least, cv::norm(points[i] - points[i + 1]));
    return least;
}

/// The picture with every place as bright as its surroundings are on average: a board in a projector's light has bright
/// paper on one side and its own deep shadow on the other, and no normalisation of the whole picture suits both.
cv::Mat evenlyLit(const cv::Mat& grey) {
    constexpr double kMean = 100.0; // of 255: white squares come to about twice that
    constexpr double kNoise = 10.0; // what is darker all around is noise, which stays dark
    const int reach = std::max(31, std::min(grey.cols, grey.rows) / 8) | 1;
    cv::Mat light, mean, even;
    grey.convertTo(light, CV_32F);
    cv::blur(light, mean, cv::Size(reach, reach));
    cv::Mat(kMean * light / (mean + kNoise)).convertTo(even, CV_8U);
    return even;
}

std::vector<cv::Point2f> findChess(const cv::Mat& grey, cv::Size size) {
    std::vector<cv::Point2f> corners;
    if (cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY))
        return corners;
    if (!cv::findChessboardCorners(grey, size, corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE) &&
        !cv::findChessboardCornersSB(evenlyLit(grey), size, corners, cv::CALIB_CB_ACCURACY))
        return {};
    refineCorners(grey, corners, 0.35 * leastDistance(corners));
    return corners;
}

/// Dark circles on light; large ones too, which the finder's own blobs are not.
std::vector<cv::Point2f> findCircles(const cv::Mat& grey, cv::Size size) {
    cv::SimpleBlobDetector::Params blobs;
    blobs.minArea = 20.0F;
    blobs.maxArea = 0.02F * static_cast<float>(grey.total());
    std::vector<cv::Point2f> centres;
    const bool found =
        cv::findCirclesGrid(grey, size, centres, cv::CALIB_CB_ASYMMETRIC_GRID | cv::CALIB_CB_CLUSTERING,
                            cv::SimpleBlobDetector::create(blobs)) ||
        cv::findCirclesGrid(grey, size, centres, cv::CALIB_CB_ASYMMETRIC_GRID, cv::SimpleBlobDetector::create(blobs));
    return found ? centres : std::vector<cv::Point2f>{};
}

BoardPoints findCharuco(const cv::Mat& grey, const CalibrationBoard& board) {
    const auto charuco = charucoOf(board);
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> ids, numbers;
    std::vector<cv::Point2f> corners;
    cv::aruco::detectMarkers(grey, charuco->dictionary, markers, ids);
    if (ids.empty()) return {};
    cv::aruco::interpolateCornersCharuco(markers, ids, grey, charuco, corners, numbers);
    if (corners.size() < kFewestSeen) return {};
    const double square = board.spacing / board.marker * leastDistance(markers.front());
    refineCorners(grey, corners, 0.4 * square * (1.0 - board.marker / board.spacing));
    BoardPoints points;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        points.board.emplace_back(charuco->chessboardCorners[static_cast<std::size_t>(numbers[i])]);
        points.seen.emplace_back(corners[i]);
    }
    return points;
}

} // namespace

CalibrationBoard parseCalibrationBoard(std::string_view text) {
    const auto refuse = [&text](const std::string& why) {
        throw InvalidInput("board " + inQuotes(text), why,
                           "write chess:9x7:75 (inner corners, side of a square), circles:4x11:20 or charuco:5x7:30:22 "
                           "(squares, side of a square, side of a marker)");
    };
    const auto parts = splitAt(text, ':');
    CalibrationBoard board;
    if (parts[0] == "chess")
        board.kind = CalibrationBoard::Kind::chess;
    else if (parts[0] == "circles")
        board.kind = CalibrationBoard::Kind::circles;
    else if (parts[0] == "charuco")
        board.kind = CalibrationBoard::Kind::charuco;
    else
        refuse("there is no such kind of board");
    const bool hasMarkers = board.kind == CalibrationBoard::Kind::charuco;
    if (parts.size() != (hasMarkers ? 4 : 3)) refuse(hasMarkers ? "it has not four parts" : "it has not three parts");
    const auto sides = splitAt(parts[1], 'x');
    board.columns = sides.size() == 2 ? numberIn<int>(sides[0]) : 0;
    board.rows = sides.size() == 2 ? numberIn<int>(sides[1]) : 0;
    if (board.columns < 3 || board.rows < 3 || board.columns > kMostPoints || board.rows > kMostPoints)
        refuse(inQuotes(parts[1]) + " is no size from 3x3 to 60x60");
    board.spacing = numberIn<double>(parts[2]);
    if (!(board.spacing > 0.0) || !(board.spacing < kLongest)) refuse(inQuotes(parts[2]) + " is no length");
    if (!hasMarkers) return board;
    board.marker = numberIn<double>(parts[3]);
    if (!(board.marker > 0.0) || !(board.marker < board.spacing)) refuse("a marker must be smaller than its square");
    if (board.columns * board.rows / 2 > 50) refuse("it needs more markers than the 50 of its dictionary, 4X4_50");
    return board;
}

std::vector<cv::Point3d> pointsOf(const CalibrationBoard& board) {
    std::vector<cv::Point3d> points;
    const bool charuco = board.kind == CalibrationBoard::Kind::charuco;
    const int first = charuco ? 1 : 0;
    for (int row = first; row < board.rows; ++row)
        for (int column = first; column < board.columns; ++column) {
            const bool circles = board.kind == CalibrationBoard::Kind::circles;
            const int across = circles ? 2 * column + row % 2 : column;
            points.emplace_back(board.spacing * across, board.spacing * row, 0.0);
        }
    return points;
}

std::optional<BoardPoints> findBoard(const cv::Mat& grey, const CalibrationBoard& board) {
    const cv::Size size(board.columns, board.rows);
    BoardPoints found;
    try {
        if (board.kind == CalibrationBoard::Kind::charuco) {
            found = findCharuco(grey, board);
        } else {
            const auto seen =
                board.kind == CalibrationBoard::Kind::chess ? findChess(grey, size) : findCircles(grey, size);
            if (!seen.empty()) found = {pointsOf(board), {seen.begin(), seen.end()}};
        }
    } catch (const cv::Exception&) { // what looked like a board is none
        return std::nullopt;
    }
    if (found.seen.empty()) return std::nullopt;
    return found;
}

} // namespace lumorph
