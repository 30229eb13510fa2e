#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/shaded_mesh.h"

namespace lumorph {

/// How a mesh that deforms is shaded: which corners share a normal is decided once, on the mesh it is
/// made from, so that new positions cost one pass over the triangles. Immutable; safe to share between
/// threads.
class SurfaceShading {
public:
    /// Smooth where neighbouring faces meet at less than `crease` in `mesh`, as `shade` does it. Throws
    /// InvalidInput for an index beyond the positions.
    SurfaceShading(const TriangleMesh& mesh, Angle crease);

    /// Triangles over the drawn vertices.
    [[nodiscard]] std::span<const glm::uvec3> triangles() const noexcept { return triangles_; }
    /// A coarser form of the same surface over drawn vertices of its own, for pictures in motion: at most some ten
    /// thousand triangles.
    [[nodiscard]] std::span<const glm::uvec3> coarseTriangles() const noexcept {
        return coarse_.empty() ? triangles() : std::span<const glm::uvec3>(coarse_);
    }
    /// For each drawn vertex, the vertex of the mesh it shows.
    [[nodiscard]] std::span<const std::uint32_t> sources() const noexcept { return sources_; }
    /// Vertices of the mesh.
    [[nodiscard]] std::size_t meshVertexCount() const noexcept { return meshVertexCount_; }
    /// Whether the mesh it was made from is closed and looks outwards: its back faces are never seen.
    [[nodiscard]] bool closed() const noexcept { return closed_; }

    /// Positions and normals of all drawn vertices for these positions of the mesh's vertices (metres,
    /// one a mesh vertex); normals are the mean of the faces around, weighted by area. `out` has one
    /// entry a drawn vertex. A vertex without area around it gets a normal of length 0.
    void shade(std::span<const glm::vec3> positions, std::span<ShadedMesh::Vertex> out) const noexcept;

private:
    void addCoarseForm(std::span<const glm::vec3> positions);

    std::vector<glm::uvec3> triangles_;
    std::vector<glm::uvec3> coarse_; // empty: the triangles are few
    std::vector<std::uint32_t> sources_;
    std::vector<std::uint32_t> leaders_; // for each drawn vertex the first one with the same normal
    bool closed_ = false;
    std::size_t meshVertexCount_ = 0;
};

} // namespace lumorph
