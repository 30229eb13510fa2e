#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// What is wrong with a mesh as the boundary of a solid. All counts zero: fit for exact voxelisation.
struct MeshReport {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::size_t components = 0;          ///< pieces connected over shared edges
    std::size_t boundaryEdges = 0;       ///< edges with one triangle: holes
    std::size_t nonManifoldEdges = 0;    ///< edges with more than two triangles, or two that disagree
    std::size_t degenerateTriangles = 0; ///< zero area, a repeated vertex, or not finite
    std::size_t selfIntersections = 0;   ///< pairs of triangles that cross (0 when not looked for)
    std::size_t inwardComponents = 0;    ///< closed pieces whose faces look inwards, cavities not counted
    double volume = 0.0;                 ///< cubic metres, signed

    [[nodiscard]] bool closed() const noexcept { return triangles > 0 && boundaryEdges == 0; }
    [[nodiscard]] bool manifold() const noexcept { return nonManifoldEdges == 0; }
    [[nodiscard]] bool solid() const noexcept {
        return closed() && manifold() && selfIntersections == 0 && inwardComponents == 0;
    }
    /// One plain sentence for each finding; none when the mesh is a clean solid.
    [[nodiscard]] std::vector<std::string> findings() const;
};

enum class IntersectionTest { skip, run };

/// Looks the mesh over. Vertices at the same place count as one where that closes a seam. The
/// self-intersection test costs about a second per 100,000 triangles. Throws InvalidInput when a
/// triangle refers to a vertex that is not there.
[[nodiscard]] MeshReport checkMesh(const TriangleMesh& mesh, IntersectionTest intersections = IntersectionTest::run);

/// Counting crossing pairs stops here: a mesh with so many is not repaired by knowing more.
inline constexpr std::size_t kMaxIntersectionsCounted = 1'000'000;

/// Number of pairs of triangles that cross or overlap, neighbours that only share an edge or a
/// corner excepted, at most kMaxIntersectionsCounted. Triangles without area cross nothing.
[[nodiscard]] std::size_t countSelfIntersections(const TriangleMesh& mesh);

/// Two triangles that cross or overlap, by number, and the box of where they meet.
struct TriangleCrossing {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    Box where;
};

/// The same pairs among some triangles, and between them and `others`, at most `most` of them in no order. No triangle
/// stands in both lists.
[[nodiscard]] std::vector<TriangleCrossing> findCrossings(const TriangleMesh& mesh,
                                                          std::span<const std::uint32_t> triangles,
                                                          std::span<const std::uint32_t> others, std::size_t most);

struct MeshRepair {
    TriangleMesh mesh;
    MeshReport before;
    MeshReport after;
    std::vector<std::string> actions; ///< what was done, one sentence each
};

/// Repairs what is safe: merges equal vertices, drops degenerate and repeated triangles, stitches
/// matching borders, orients faces outwards, fills holes of at most `maxHoleEdges` edges (512 at
/// most). The shape of sound parts is left as it is; a mesh without findings, or with crossing
/// triangles alone, is returned unchanged. Takes any geometry; what could not be repaired stands in
/// `after`. Throws InvalidInput when a triangle refers to a vertex that is not there.
[[nodiscard]] MeshRepair repairMesh(const TriangleMesh& mesh, std::size_t maxHoleEdges = 64);

} // namespace lumorph
