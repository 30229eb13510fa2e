#pragma once

#include <random>
#include <span>
#include <vector>

#include "app/applications/ice/sheet.h"

namespace lumorph::ice {

/// Warmth over a place of the pond: the sun's spot, a finger, a hand.
struct Warmth {
    glm::dvec2 place{0.0}; ///< x and z, metres
    double radius = 0.018; ///< within which it melts ice, metres
    double power = 1.0;    ///< 1: thick ice is gone in about a second
};

/// Melts a plate that lies there, for a while: what lies under warmth becomes thinner until it has a hole, and rims of
/// ice draw back from it. True when a hole came to be or a cell was gone.
bool melt(Sheet& sheet, int plate, const Placement& placement, std::span<const Warmth> warmths, double seconds,
          std::mt19937_64& random);

/// Free rims of some cells draw back by this many metres.
void thaw(Sheet& sheet, std::span<const int> cells, double depth);

} // namespace lumorph::ice
