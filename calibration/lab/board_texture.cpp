#include "calibration/lab/board_texture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/aruco.hpp>

namespace lumorph {

namespace {

constexpr float kPaper = 0.85F;
constexpr float kInk = 0.08F;
constexpr double kMargin = 0.75;      // of the spacing
constexpr double kCircleRadius = 0.4; // of the spacing

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
    const auto dictionary = cv::aruco::getPredefinedDictionary(markerDictionaryOf(board_));
    markerCells_ = dictionary->markerSize + 2; // with the border
    markerOfSquare_.assign(static_cast<std::size_t>(board_.columns) * static_cast<std::size_t>(board_.rows), -1);
    for (const cv::Point& square : markerSquaresOf(board_)) {
        const double edge = 0.5 * (board_.spacing - board_.marker);
        Marker marker{{board_.spacing * square.x + edge, board_.spacing * square.y + edge}, {}};
        const auto number = static_cast<int>(markers_.size());
        cv::aruco::drawMarker(dictionary, number, markerCells_, marker.cells, 1);
        markerOfSquare_.at(placeOf(square.x, square.y)) = number;
        markers_.push_back(marker);
    }
}

bool BoardTexture::isMarkerInk(const Marker& marker, double x, double y) const noexcept {
    const double column = markerCells_ * (x - marker.corner.x) / board_.marker;
    const double row = markerCells_ * (y - marker.corner.y) / board_.marker;
    if (column < 0.0 || row < 0.0 || column >= markerCells_ || row >= markerCells_) return false;
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
    const int marker = markerOfSquare_[placeOf(i, j)];
    return marker < 0 || isMarkerInk(markers_[static_cast<std::size_t>(marker)], x, y);
}

float BoardTexture::albedo(double x, double y) const noexcept { return isInk(x, y) ? kInk : kPaper; }

} // namespace lumorph
