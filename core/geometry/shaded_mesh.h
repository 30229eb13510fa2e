#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A mesh ready for drawing: one normal a vertex, vertices split where the surface has a crease.
struct ShadedMesh {
    struct Vertex {
        glm::vec3 position; ///< metres
        glm::vec3 normal;   ///< of length 1
        bool operator==(const Vertex&) const = default;
    };
    std::vector<Vertex> vertices;
    std::vector<glm::uvec3> triangles;
};

/// Smooth where neighbouring faces meet at less than `crease`, sharp elsewhere; at an angle of 0 every
/// face is flat. Vertices at the same place count as one. The normal of a corner is the mean over the
/// faces around it that differ from its own by less than `crease`, weighted by their angle there.
/// Triangles without area are left out. Throws InvalidInput for an index beyond the positions and
/// coordinates that are not finite.
[[nodiscard]] ShadedMesh shade(const TriangleMesh& mesh, Angle crease);

} // namespace lumorph
