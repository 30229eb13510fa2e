#pragma once

#include <cstddef>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Steps of repair on loose triangles. Each changes the mesh and gives the number of triangles it
/// dealt with; none moves a vertex.

/// Drops triangles that are not finite or have two corners at one place.
std::size_t dropCollapsedTriangles(TriangleMesh& mesh);

/// Takes out triangles whose corners lie on one line: the neighbour over their long edge is cut in
/// two at the corner between, so that no crack opens. The shape stays exactly as it is.
std::size_t dissolveFlatTriangles(TriangleMesh& mesh);

/// Drops triangles that repeat another, corners in any turn. Of two that face opposite ways both go
/// where the surface closes without them (the wall between two solids glued together), else one.
std::size_t dropRepeatedTriangles(TriangleMesh& mesh);

} // namespace lumorph
