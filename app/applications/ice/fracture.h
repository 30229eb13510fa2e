#pragma once

#include <random>
#include <span>
#include <vector>

#include "app/applications/ice/polygon.h"

namespace lumorph::ice {

/// The Voronoi diagram of some sites within a convex piece: out[k] is what of it lies nearer to sites[k] than to any
/// other; empty where that is nothing. Cells of neighbours share their edge to the last bits, and together they have
/// the piece's area. Sites may coincide: the first of them has the cell. Throws InvalidInput for a site that is not
/// finite.
[[nodiscard]] std::vector<Polygon> voronoiCells(const Polygon& piece, std::span<const glm::dvec2> sites);

/// The next number of a series, in [0, 1): the same on every machine.
[[nodiscard]] double chance(std::mt19937_64& random);

/// As many sites as wanted over a piece, evenly spread: chance, evened out by Lloyd's rounds.
[[nodiscard]] std::vector<glm::dvec2> evenSites(const Polygon& piece, int count, std::mt19937_64& random);

/// Sites around a place where ice gets a hole: a small cell in the middle, wedges around it, and wider pieces about
/// them.
[[nodiscard]] std::vector<glm::dvec2> holeSites(const glm::dvec2& place, std::mt19937_64& random);
/// Sites around a place where ice is struck: cracks that run out of it like a star.
[[nodiscard]] std::vector<glm::dvec2> starSites(const glm::dvec2& place, std::mt19937_64& random);

} // namespace lumorph::ice
