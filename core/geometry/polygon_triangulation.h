#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// Cuts a polygon of at least three corners into `corners.size() - 2` triangles of the same
/// orientation and appends them. Convex polygons become a fan; others are cut ear by ear in their
/// best-fit plane, so that dents stay dents and corners on a straight side make no flat triangles
/// where that can be avoided. A polygon that crosses itself gives some triangulation of it.
/// Time grows with the square of the corners of a dented polygon.
void triangulatePolygon(std::span<const glm::vec3> positions, std::span<const std::uint32_t> corners,
                        std::vector<glm::uvec3>& triangles);

} // namespace lumorph
