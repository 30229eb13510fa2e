#pragma once

#include "core/geometry/triangle_mesh.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Surface voxelisation by box-triangle overlap (paper, Implementation; R12): a voxel is set when its
/// closed cube and a triangle share a point. Separating axes after Akenine-Moeller, evaluated a
/// column at a time. Triangles may reach beyond the frame; the mesh need not be closed.
[[nodiscard]] BitColumns voxelizeSurface(const VoxelFrame& frame, const TriangleMesh& mesh);

} // namespace lumorph
