#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/calibration_board.h"

namespace lumorph {

/// A calibration board as it is printed: how white it is at each place, with edges as sharp as numbers are. Places are
/// in the board's frame and unit, as `pointsOf` counts.
class BoardTexture {
public:
    explicit BoardTexture(const CalibrationBoard& board);

    /// The sheet of paper: the pattern and a margin around it.
    [[nodiscard]] const cv::Rect2d& page() const noexcept { return page_; }
    /// The pattern's points, the first and last of each side.
    [[nodiscard]] const cv::Rect2d& points() const noexcept { return points_; }
    /// -1: the printed side looks to the frame's -z, since y runs down the page.
    [[nodiscard]] static constexpr int printedSide() noexcept { return -1; }
    /// Of a ChArUco marker, along a side, with its border.
    [[nodiscard]] int markerCells() const noexcept { return markerCells_; }
    /// Diffuse albedo at a place on the page.
    [[nodiscard]] float albedo(double x, double y) const noexcept;

private:
    /// A marker in its square, and its upper left corner.
    struct Marker {
        cv::Point2d corner;
        cv::Mat1b cells; ///< black 0; with its border
    };

    void addMarkers();
    [[nodiscard]] bool isInk(double x, double y) const noexcept;
    [[nodiscard]] bool isMarkerInk(const Marker& marker, double x, double y) const noexcept;

    [[nodiscard]] std::size_t placeOf(int column, int row) const { // of a square in markerOfSquare_
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(board_.columns) +
               static_cast<std::size_t>(column);
    }

    CalibrationBoard board_;
    cv::Rect2d page_, points_;
    int markerCells_ = 6; ///< a side, with the border
    std::vector<Marker> markers_;
    std::vector<int> markerOfSquare_; ///< ChArUco, row after row; -1: a black square
};

} // namespace lumorph
