#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// How far it is along a surface.
struct SurfaceDistances {
    std::vector<float> metres; ///< one a vertex of the mesh; infinite where no way leads there
    bool heat = false;         ///< by the heat method; else marched
};

/// The way along the surface from the nearest of some places to every vertex of a mesh. A place counts as the nearest
/// one on the surface. Seams of a model (vertices at one place, each with triangles of its own) are crossed.
///
/// Where the pieces that hold the places are manifold, by the heat method (K. Crane, C. Weischedel, M. Wardetzky,
/// "Geodesics in heat", ACM Transactions on Graphics 32, 2013, as CGAL has it, over an intrinsic Delaunay
/// triangulation), which is smooth, and held between what is certain: no shorter than the straight line, no longer than
/// the way along edges. Else, where edges have more than two triangles or neighbours disagree about what is outside, by
/// marching from vertex to vertex across triangles, each unfolded into the plane: it asks nothing of the mesh, and goes
/// on wherever triangles have a place in common. Some 2 s for 200,000 triangles. Throws InvalidInput without places or
/// triangles, for places that are not finite and for triangles that name vertices that are not there; Cancelled.
[[nodiscard]] SurfaceDistances surfaceDistances(const TriangleMesh& mesh, std::span<const glm::vec3> places,
                                                const Progress& progress = {});

/// The places of the surface nearest to some points, and through the solid across from each where it is at most
/// `thickness` metres thick there: what begins on both sides of a sheet spreads over both alike. Throws as
/// `surfaceDistances` does.
[[nodiscard]] std::vector<glm::vec3> placesOnBothSides(const TriangleMesh& mesh, std::span<const glm::vec3> points,
                                                       double thickness);

} // namespace lumorph
