#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// Longest rim that is filled, whatever the caller wishes: time grows with its cube.
inline constexpr std::size_t kMaxHoleEdges = 512;

/// Triangles between the points of a closed rim, oriented as the rim runs: those of least total
/// area, slivers avoided (dynamic programming over all triangulations; Barequet and Sharir, "Filling
/// gaps in the boundary of a polyhedron", 1995). `forbidden(i, j)` says that no new edge may join two
/// points; it is obeyed where there is a choice. Rim of 3 to kMaxHoleEdges points.
[[nodiscard]] std::vector<glm::uvec3> fillHole(std::span<const glm::vec3> rim,
                                               const std::function<bool(std::size_t, std::size_t)>& forbidden);

} // namespace lumorph
