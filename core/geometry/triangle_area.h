#pragma once

#include <cstddef>

#include <glm/geometric.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Whether the corners lie exactly on one line. In double precision, differences and products of
/// floats are exact enough that only triangles flat to the last bit are called so.
[[nodiscard]] inline bool isFlat(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) noexcept {
    const glm::dvec3 origin(a);
    return glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin) == glm::dvec3(0.0);
}

[[nodiscard]] inline bool isFlat(const TriangleMesh& mesh, std::size_t triangle) noexcept {
    const glm::uvec3& t = mesh.triangles[triangle];
    return isFlat(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
}

} // namespace lumorph
