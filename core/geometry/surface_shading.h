#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/geometry/shaded_mesh.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// How a mesh that deforms is shaded: which corners share a normal is decided once, on the mesh it is
/// made from, so that new positions cost one pass over the triangles. Immutable; safe to share between
/// threads.
class SurfaceShading {
public:
    /// Smooth where neighbouring faces meet at less than `crease` in `mesh`, as `shade` does it. `parts` says what
    /// moves as one, a number a vertex of the mesh, or is empty: the coarse form keeps such parts apart, as it does
    /// pieces of the mesh that share no edge. Throws InvalidInput for an index beyond the positions, and for parts that
    /// are not as many as these.
    SurfaceShading(const TriangleMesh& mesh, Angle crease, std::span<const std::uint32_t> parts = {});

    /// The surface itself, or a form of at most some ten thousand triangles for pictures in motion. The two are one
    /// where the triangles are few.
    enum class Detail { fine, coarse };
    [[nodiscard]] bool hasCoarse() const noexcept { return !coarse_.triangles.empty(); }

    /// Triangles over the drawn vertices.
    [[nodiscard]] std::span<const glm::uvec3> triangles(Detail detail = Detail::fine) const noexcept {
        return form(detail).triangles;
    }
    /// For each drawn vertex, the vertex of the mesh it shows.
    [[nodiscard]] std::span<const std::uint32_t> sources(Detail detail = Detail::fine) const noexcept {
        return form(detail).sources;
    }
    /// Vertices of the mesh.
    [[nodiscard]] std::size_t meshVertexCount() const noexcept { return meshVertexCount_; }
    /// Whether the mesh it was made from is closed and looks outwards: its back faces are never seen.
    [[nodiscard]] bool closed() const noexcept { return closed_; }

    /// Positions and normals of all drawn vertices for these positions of the mesh's vertices (metres,
    /// one a mesh vertex); normals are the mean of the faces around, weighted by area. `out` has one
    /// entry a drawn vertex. A vertex without area around it gets a normal of length 0.
    void shade(std::span<const glm::vec3> positions, std::span<ShadedMesh::Vertex> out,
               Detail detail = Detail::fine) const noexcept;

private:
    struct Form {
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> sources;
        std::vector<std::uint32_t> leaders; // for each drawn vertex the first one with the same normal
    };
    [[nodiscard]] const Form& form(Detail detail) const noexcept {
        return detail == Detail::coarse && hasCoarse() ? coarse_ : fine_;
    }
    void addCoarseForm(std::span<const glm::vec3> positions, std::span<const std::uint32_t> parts);

    Form fine_;
    Form coarse_; // empty: the triangles are few
    bool closed_ = false;
    std::size_t meshVertexCount_ = 0;
};

} // namespace lumorph
