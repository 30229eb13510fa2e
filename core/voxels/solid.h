#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/column_raster.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Solid voxelisation by scan conversion along y (paper, Implementation; R12): a voxel is in when its
/// centre has a winding number other than zero, so overlapping shells unite and inward-facing
/// cavities stay empty. The mesh must be closed; it may reach beyond the frame.
/// Winding numbers are counted modulo 256.
///
/// Keeps its buffers from call to call; one object for each thread.
class SolidVoxelizer {
public:
    /// `out` gets the frame's shape. Allocates only while buffers grow.
    void voxelize(const VoxelFrame& frame, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                  BitColumns& out);

private:
    static constexpr int kPlanes = 8;
    using Counter = std::array<std::uint64_t, kPlanes>; ///< 64 winding numbers, one bit of each a word

    std::vector<GridVertex> vertices_;
    std::vector<Counter> counters_;
};

/// One-off form of SolidVoxelizer.
[[nodiscard]] BitColumns voxelizeSolid(const VoxelFrame& frame, const TriangleMesh& mesh);

} // namespace lumorph
