#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/geometry/shaded_mesh.h"

/// A coarser form of a surface. Private to core/render.
namespace lumorph {

struct CoarseSurface {
    std::vector<std::uint32_t>
        vertices;                      ///< those of the fine form whose positions it takes, so that it moves with them
    std::vector<glm::uvec3> triangles; ///< over `vertices`
};

/// What is left of a surface when all vertices in a cell of a grid become one; the cells are as large as leaves about
/// `wanted` triangles. Vertices whose normals are more than 40 degrees apart stay two vertices at one place, so that
/// edges stay sharp. Vertices of different `parts`, one number a vertex, never become one, since parts may move apart;
/// a part that is narrower than a cell has smaller cells. Empty where that would gain little. Metres; triangles index
/// `vertices`.
[[nodiscard]] CoarseSurface coarseSurface(std::span<const ShadedMesh::Vertex> vertices,
                                          std::span<const std::uint32_t> parts, std::span<const glm::uvec3> triangles,
                                          std::size_t wanted);

} // namespace lumorph
