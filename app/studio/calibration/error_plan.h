#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/report/calibrated_room.h"
#include "calibration/solve/error_map.h"
#include "core/base/progress.h"

namespace lumorph::studio {

/// How far light may land beside, seen from above: a grid over the table, and the same as high as the device lifts its
/// surface.
struct ErrorPlan {
    static constexpr int kColumns = 48, kRows = 36;
    glm::dvec2 size{1.2, 0.9};  ///< metres in x and z, around the world's origin
    double height = 0.05;       ///< of the upper plane, metres
    std::vector<double> table;  ///< millimetres, 95 of 100, row by row from the back; not a number where no light falls
    std::vector<double> device; ///< likewise
    /// The world's middle, where the device stands: mean and worst within this.
    static constexpr double kMiddle = 0.2; // metres
    double mean = 0.0, worst = 0.0;        ///< millimetres, of both planes
    [[nodiscard]] glm::dvec2 placeOf(int column, int row) const {
        return {size.x * ((column + 0.5) / kColumns - 0.5), size.y * ((row + 0.5) / kRows - 0.5)};
    }
};

/// The plan of a calibration whose board of `placement.tableView`, seen as `flat`, lay on the table. Throws as
/// `worldFromCamera`; Cancelled.
[[nodiscard]] ErrorPlan errorPlanOf(const ProcamCalibration& solved, const BoardPoints& flat,
                                    const CalibrationBoard& board, const Installation& room,
                                    const RoomPlacement& placement, const Progress& progress = {});

} // namespace lumorph::studio
