#pragma once

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// How a board differs from a flat one whose squares are square; what lies in a board's size alone no picture tells.
struct BoardMeasurement {
    BoardShape shape;
    double bend = 0.0;      ///< between its highest and lowest point over the plane through them, the board's unit
    double bendSigma = 0.0; ///< standard deviation
    double stretch = 0.0;   ///< how much longer its squares are along x than along y, a share
    double stretchSigma = 0.0;

    /// Whether the board is bent by more than noise makes it seem, and by more than a 300th of its length.
    [[nodiscard]] bool isWarped() const;
    /// Whether squares are oblong by more than noise makes it seem, and by more than a 200th.
    [[nodiscard]] bool isStretched() const;
};

/// Lets go of the board's shape in a calibration that was solved from `views`, all else with it, and tells what becomes
/// of it. Whether or not the calibration had a bent board itself.
[[nodiscard]] BoardMeasurement measureBoard(const std::vector<ViewObservations>& views,
                                            const ProcamCalibration& calibration);

/// Between the highest and the lowest of the points of all views over the plane through them, the board's unit.
[[nodiscard]] double bendOf(const BoardShape& board, const std::vector<ViewObservations>& views);

} // namespace lumorph
