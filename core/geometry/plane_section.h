#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// Where triangles cross the plane on which coordinate `axis` (0 x, 1 y, 2 z) is `at`: a segment for each of them, in
/// the positions' units and in no order. Vertices on the plane count as above it, so that a closed mesh gives closed
/// outlines. Indices must lie within the positions.
[[nodiscard]] std::vector<std::array<glm::vec3, 2>>
planeSection(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, int axis, float at);

} // namespace lumorph
