#pragma once

#include <cstddef>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A surface made of loose triangles, and what it took.
struct StitchedSurface {
    TriangleMesh mesh;
    std::size_t mergedVertices = 0;  ///< that were at the place of another, with an edge in common
    std::size_t turnedTriangles = 0; ///< the minority of each piece
    std::size_t filledHoles = 0;
    std::size_t openHoles = 0; ///< longer than allowed, or the rim of a flat sheet
};

/// Joins triangles along edges at the same places, makes the triangles of each piece face the same
/// way as most of them do, and fills holes of at most `maxHoleEdges` edges. Where more than two
/// triangles meet at an edge, those that bound the same solid are joined; what stays undecided stays
/// apart and is not filled. Vertices used by none are left out. No triangle of `mesh` may be
/// collapsed or not finite.
[[nodiscard]] StitchedSurface stitchSurface(const TriangleMesh& mesh, std::size_t maxHoleEdges);

} // namespace lumorph
