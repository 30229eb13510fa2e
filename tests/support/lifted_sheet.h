#pragma once

#include "core/rig/rig.h"

namespace lumorph::test {

inline constexpr int kSheetColumns = 38;
inline constexpr int kSheetRows = 40;
inline constexpr int kSkirtShares = 12;

/// A tablet of 200 x 270 mm under one smooth sheet that six overlapping levers lift, four at its corners and two at the
/// middles of its long edges. How the sheet moves is an analytic field of their strokes, no mechanics: heights that
/// give way to each other where two levers lift the same place, and a pull to the middle that grows with their squares.
/// Top (38 x 40 vertices), skirt (12 shares of the rim's path) and body are one closed solid, which holds its path up
/// to facets.
[[nodiscard]] RigParts liftedSheetParts();

} // namespace lumorph::test
