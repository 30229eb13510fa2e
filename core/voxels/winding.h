#pragma once

#include "core/base/progress.h"
#include "core/geometry/triangle_mesh.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Solid voxelisation for meshes with holes: a voxel is in when the generalised winding number of its
/// centre (Jacobson et al. 2013) is at least one half. Far clusters of triangles are summed as one
/// dipole each (after Barill et al. 2018), and what is far from a block of voxels is interpolated in it, so that
/// thousands of large loose triangles cost seconds too; tens of milliseconds for an ordinary mesh, where the scan
/// conversion takes one. Runs on all cores. Throws Cancelled.
[[nodiscard]] BitColumns voxelizeWinding(const VoxelFrame& frame, const TriangleMesh& mesh,
                                         const Progress& progress = {});

/// The generalised winding number of one point, summed exactly over all triangles.
[[nodiscard]] double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point) noexcept;

} // namespace lumorph
