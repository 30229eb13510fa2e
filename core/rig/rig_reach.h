#pragma once

#include <memory>
#include <vector>

#include "core/rig/deform_program.h"

namespace lumorph {

/// Bounds on how one stroke moves a vertex, over all states.
struct StrokeBound {
    std::uint16_t actuator = 0;
    double first = 0.0;  ///< metres a stroke
    double second = 0.0; ///< metres a stroke squared, between kinks
    double kink = 0.0;   ///< metres a stroke: how much the first derivative may jump within a grid step
};

/// One for each actuator that moves a vertex by anything but the sheet. Between the corners of a box of strokes of half
/// widths h the vertex is no farther from their multilinear interpolation than sum second h^2 / 2 + kink h / 2.
[[nodiscard]] std::vector<StrokeBound> strokeBounds(const RigCore& core, std::uint32_t vertex);

/// For every vertex a box that holds it in every joint state. Exact up to rounding where slides and
/// morph targets alone move it; else a grid over the strokes of its (up to three) strongest actuators,
/// widened by the second derivatives between the grid's states and by the ways of the others. Of a sheet see
/// SheetReach.
[[nodiscard]] std::vector<Box> reachBoxes(const std::shared_ptr<const RigCore>& core);

} // namespace lumorph
