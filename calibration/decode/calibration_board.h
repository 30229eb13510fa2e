#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/refusal.h"

namespace lumorph {

/// A printed board that cameras are calibrated with; lengths in the unit in which it was named.
struct CalibrationBoard {
    enum class Kind { chess, circles, charuco };
    Kind kind = Kind::chess;
    int columns = 9; ///< chess: inner corners; circles: in a row; ChArUco: squares
    int rows = 7;
    double spacing = 75.0; ///< side of a square; asymmetric circles: half the distance between neighbours of a row
    double marker = 0.0;   ///< ChArUco: side of a marker
    /// ChArUco: the dictionary of its markers as OpenCV names it, without DICT_; empty: found by itself.
    std::string dictionary = {};
    /// ChArUco with an even number of rows, as OpenCV printed it before 4.6: the upper left square is white and has a
    /// marker. Both layouts are found; the lab prints the one that is said.
    bool isOldLayout = false;
    bool operator==(const CalibrationBoard&) const = default;
};

/// Parses `chess:9x7:75`, `circles:4x11:20` (asymmetric, as OpenCV counts them), `charuco:5x7:30:22`,
/// `charuco:5x7:30:22:6X6_250` or `charuco:6x8:30:22:4X4_50:old`. Throws InvalidInput naming what is wrong.
[[nodiscard]] CalibrationBoard parseCalibrationBoard(std::string_view text);
/// The text that it parses.
[[nodiscard]] std::string boardText(const CalibrationBoard& board);

/// The dictionaries of markers that ChArUco boards can have: "4X4_50", ..., "APRILTAG_36h11".
[[nodiscard]] std::vector<std::string> markerDictionaries();
/// What OpenCV makes the markers of a ChArUco board from: 4X4_50, or the smallest that is large enough, where none is
/// said.
[[nodiscard]] int markerDictionaryOf(const CalibrationBoard& board);
/// Column and row of the square of each marker of a ChArUco board, by its number, from the upper left square.
[[nodiscard]] std::vector<cv::Point> markerSquaresOf(const CalibrationBoard& board);

/// Points of a board and where they were seen; at least four.
struct BoardPoints {
    std::vector<cv::Point3d> board; ///< z = 0; the first point of the board, or its first corner, at the origin
    std::vector<cv::Point2d> seen;  ///< camera pixels, the centre of the first at 0
    std::string dictionary = {};    ///< ChArUco: of the markers that were seen
};

/// All points of the board, in the order in which it is searched.
[[nodiscard]] std::vector<cv::Point3d> pointsOf(const CalibrationBoard& board);

/// Finds the board in an 8-bit grey picture, dark on light or light on dark; empty where it is not to be seen, or for
/// ChArUco too little of it. A chessboard is looked for with the sector-based detector, then in the classic way. Boards
/// that look the same when turned by 180 degrees may be found so, which is harmless where each view has a pose of its
/// own. Of a ChArUco board those corners are given whose four squares are in sight, in either layout, and with markers
/// of another dictionary than said where those that were said are not seen.
[[nodiscard]] std::optional<BoardPoints> findBoard(const cv::Mat& grey, const CalibrationBoard& board);

/// A warning (board_kind) where the markers that were seen are of another dictionary than was said, or of one that was
/// not said and is not the usual one.
[[nodiscard]] std::optional<Finding> checkBoardKind(const std::string& view, const CalibrationBoard& said,
                                                    const BoardPoints& found);

} // namespace lumorph
