#pragma once

#include <memory>
#include <vector>

#include "core/rig/deform_program.h"

namespace lumorph {

/// For every vertex a box that holds it in every joint state. Exact up to rounding where slides and
/// morph targets alone move it; else a grid over the strokes of its (up to three) strongest actuators,
/// widened by the second derivatives between the grid's states and by the ways of the others. Of a sheet see
/// SheetReach.
[[nodiscard]] std::vector<Box> reachBoxes(const std::shared_ptr<const RigCore>& core);

} // namespace lumorph
