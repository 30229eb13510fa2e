#pragma once

#include "core/geometry/mesh_topology.h"

namespace lumorph {

/// Pairs the half-edges of edges with more than two triangles where as many run one way as the
/// other: each with the one across the solid wedge behind it, so that solids that touch along an
/// edge come apart. Edges where the turn around the edge does not decide are left alone.
void joinCrowdedEdges(const TriangleMesh& mesh, MeshTopology& topology);

} // namespace lumorph
