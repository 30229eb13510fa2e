#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/rig/rig.h"
#include "core/voxels/column_raster.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Triangles moved by the same actuators, with their vertices numbered afresh.
struct RigGroup {
    std::vector<std::uint16_t> actuators; ///< ascending; none: the part that stays
    std::optional<Rig::Subset> vertices;  ///< of the rig; none without triangles
    std::vector<glm::uvec3> triangles;    ///< into the subset
    ColumnRange range;                    ///< columns it can reach
};

/// One closed piece of the rig, cavities included.
struct RigBody {
    std::vector<RigGroup> groups; ///< the first is the part that stays, maybe without triangles
    std::vector<std::uint16_t> actuators;
    ColumnRange range;
    int stepsPerLevel = 0; ///< path samples between neighbouring levels; 0: no sweep needed
};

/// Takes a rig apart into bodies and groups. `levels` sets how finely the path of a rig that does not
/// hold its path must be sampled.
[[nodiscard]] std::vector<RigBody> bodiesOf(const Rig& rig, const VoxelFrame& frame, int levels);

} // namespace lumorph
