#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace lumorph {

/// A printed board that cameras are calibrated with; lengths in the unit in which it was named.
struct CalibrationBoard {
    enum class Kind { chess, circles, charuco };
    Kind kind = Kind::chess;
    int columns = 9; ///< chess: inner corners; circles: in a row; ChArUco: squares
    int rows = 7;
    double spacing = 75.0; ///< side of a square; asymmetric circles: half the distance between neighbours of a row
    double marker = 0.0;   ///< ChArUco: side of a marker, dictionary 4X4_50
    bool operator==(const CalibrationBoard&) const = default;
};

/// Parses `chess:9x7:75`, `circles:4x11:20` (asymmetric, as OpenCV counts them) or `charuco:5x7:30:22`. Throws
/// InvalidInput naming what is wrong.
[[nodiscard]] CalibrationBoard parseCalibrationBoard(std::string_view text);

/// Points of a board and where they were seen; at least four.
struct BoardPoints {
    std::vector<cv::Point3d> board; ///< z = 0; the first point of the board, or its first corner, at the origin
    std::vector<cv::Point2d> seen;  ///< camera pixels, the centre of the first at 0
};

/// All points of the board, in the order in which it is searched.
[[nodiscard]] std::vector<cv::Point3d> pointsOf(const CalibrationBoard& board);

/// Finds the board in an 8-bit grey picture; empty where it is not to be seen, or for ChArUco too little of it. A
/// chessboard is looked for with the sector-based detector, then in the classic way. Boards that look the same when
/// turned by 180 degrees may be found so, which is harmless where each view has a pose of its own.
[[nodiscard]] std::optional<BoardPoints> findBoard(const cv::Mat& grey, const CalibrationBoard& board);

} // namespace lumorph
