#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// How the triangles of a mesh meet at their edges. Half-edge `3 * t + k` runs from corner k of
/// triangle t to the next one. Half-edges of the same two vertices belong together first, those of
/// the same two places after that: so the seams of a textured model are no holes, and two solids
/// that touch along an edge, each with its own vertices, stay two solids.
struct MeshTopology {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::uint32_t> places;                    ///< one a vertex; equal where positions are equal
    std::vector<std::uint32_t> partner;                   ///< one a half-edge: the one across the edge, or kNone
    std::vector<std::vector<std::uint32_t>> crowdedEdges; ///< half-edges of edges with more than two triangles
    std::vector<std::uint32_t> boundary;                  ///< half-edges whose edge has one triangle
    std::size_t disagreements = 0; ///< edges whose two triangles run along them in the same direction
    std::vector<bool> ignored;     ///< triangles not looked at: not finite, or two corners at one place

    [[nodiscard]] std::uint32_t startPlace(const TriangleMesh& mesh, std::uint32_t halfEdge) const noexcept;
    [[nodiscard]] std::uint32_t endPlace(const TriangleMesh& mesh, std::uint32_t halfEdge) const noexcept;
};

[[nodiscard]] constexpr std::uint32_t nextInTriangle(std::uint32_t halfEdge) noexcept {
    return halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1;
}

/// Vertex of a corner, numbered as the half-edge that starts there.
[[nodiscard]] inline std::uint32_t vertexAt(const TriangleMesh& mesh, std::uint32_t corner) noexcept {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

/// Throws InvalidInput when a triangle refers to a vertex that is not there.
[[nodiscard]] MeshTopology meshTopology(const TriangleMesh& mesh);

/// A piece of a mesh connected over edges.
struct MeshComponent {
    std::vector<std::uint32_t> triangles;
    bool closed = true;   ///< no boundary edge
    bool coherent = true; ///< its triangles agree on what is outside
    double volume = 0.0;  ///< signed, in cubic metres
    Box box;
};

/// The pieces in the order of their first triangles; ignored triangles belong to none.
[[nodiscard]] std::vector<MeshComponent> meshComponents(const TriangleMesh& mesh, const MeshTopology& topology);

/// How many times the closed piece winds around the point: 1 inside an outward piece, -1 inside an
/// inward one, 0 outside. A point on the surface counts to one side or the other.
[[nodiscard]] int windingNumber(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                                const glm::vec3& point) noexcept;

/// Whether `inner` lies inside `outer` (a closed piece that may look outwards or inwards), and by how
/// many turns: the winding number of the outer one at most of a few points of the inner one.
[[nodiscard]] int nesting(const TriangleMesh& mesh, const MeshComponent& inner, const MeshComponent& outer) noexcept;

/// Components that look inwards although they are no cavity of one that looks outwards, by number.
[[nodiscard]] std::vector<std::size_t> inwardComponents(const TriangleMesh& mesh,
                                                        std::span<const MeshComponent> components);

} // namespace lumorph
