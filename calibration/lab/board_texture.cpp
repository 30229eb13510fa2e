#include "calibration/lab/board_texture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/aruco/charuco.hpp>

namespace lumorph {

namespace {

constexpr float kPaper = 0.85F;
constexpr float kInk = 0.08F;
constexpr double kMargin = 0.75;      // of the spacing
constexpr double kCircleRadius = 0.4; // of the spacing
constexpr int kMarkerCells = 6;       // a side, border included

cv::Rect2d grown(const cv::Rect2d& box, double by) {
    return {box.x - by, box.y - by, box.width + 2.0 * by, box.height + 2.0 * by};
}

} // namespace

BoardTexture::BoardTexture(const CalibrationBoard& board) : board_(board) {
    const std::vector<cv::Point3d> all = pointsOf(board);
    cv::Point2d least(all.front().x, all.front().y);
    cv::Point2d most = least;
    for (const cv::Point3d& point : all) {
        least = {std::min(least.x, point.x), std::min(least.y, point.y)};
        most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }
    points_ = cv::Rect2d(least, most);
    page_ = grown(points_, (1.0 + kMargin) * board.spacing);
    if (board.kind == CalibrationBoard::Kind::charuco) addMarkers();
}

void BoardTexture::addMarkers() {
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
    const auto charuco = cv::aruco::CharucoBoard::create(
        board_.columns, board_.rows, static_cast<float>(board_.spacing), static_cast<float>(board_.marker), dictionary);
    markerOfSquare_.assign(static_cast<std::size_t>(board_.columns * board_.rows), -1);
    for (std::size_t i = 0; i < charuco->ids.size(); ++i) {
        const auto at = [&](std::size_t corner) {
            const cv::Point3f& point = charuco->objPoints[i][corner];
            return cv::Point2d(point.x, point.y);
        };
        Marker marker{at(0), at(1) - at(0), at(3) - at(0), {}};
        cv::aruco::drawMarker(dictionary, charuco->ids[i], kMarkerCells, marker.cells, 1);
        const cv::Point2d middle = marker.corner + 0.5 * (marker.along + marker.down);
        const int square =
            static_cast<int>(middle.y / board_.spacing) * board_.columns + static_cast<int>(middle.x / board_.spacing);
        markerOfSquare_.at(static_cast<std::size_t>(square)) = static_cast<int>(i);
        // Along its row and down as it is read: their cross product points away from the reader.
        printedSide_ = marker.along.cross(marker.down) > 0.0 ? -1 : 1;
        markers_.push_back(marker);
    }
}

bool BoardTexture::isMarkerInk(const Marker& marker, double x, double y) const noexcept {
    const cv::Point2d way(x - marker.corner.x, y - marker.corner.y);
    const double side = board_.marker * board_.marker;
    const double column = kMarkerCells * way.dot(marker.along) / side;
    const double row = kMarkerCells * way.dot(marker.down) / side;
    if (column < 0.0 || row < 0.0 || column >= kMarkerCells || row >= kMarkerCells) return false;
    return marker.cells(static_cast<int>(row), static_cast<int>(column)) == 0;
}

bool BoardTexture::isInk(double x, double y) const noexcept {
    const double column = x / board_.spacing;
    const double row = y / board_.spacing;
    if (board_.kind == CalibrationBoard::Kind::circles) {
        const int j = static_cast<int>(std::lround(row));
        if (j < 0 || j >= board_.rows) return false;
        const int i = static_cast<int>(std::lround(0.5 * (column - j % 2)));
        if (i < 0 || i >= board_.columns) return false;
        return std::hypot(column - 2 * i - j % 2, row - j) < kCircleRadius;
    }
    const bool chess = board_.kind == CalibrationBoard::Kind::chess;
    const double first = chess ? -1.0 : 0.0; // of the outermost squares
    if (column < first || row < first || column >= board_.columns || row >= board_.rows) return false;
    const int i = static_cast<int>(std::floor(column));
    const int j = static_cast<int>(std::floor(row));
    if (chess) return (i + j) % 2 == 0;
    const int marker = markerOfSquare_[static_cast<std::size_t>(j * board_.columns + i)];
    return marker < 0 || isMarkerInk(markers_[static_cast<std::size_t>(marker)], x, y);
}

float BoardTexture::albedo(double x, double y) const noexcept { return isInk(x, y) ? kInk : kPaper; }

} // namespace lumorph
