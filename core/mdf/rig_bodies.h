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
    std::vector<std::uint32_t> listed;    ///< their indices in the rig
    std::vector<glm::uvec3> triangles;    ///< into the subset
    ColumnRange range;                    ///< columns it can reach
};

/// One closed piece of the rig, cavities included.
struct RigBody {
    std::vector<RigGroup> groups; ///< the first is the part that stays, maybe without triangles
    std::vector<std::uint16_t> actuators;
    ColumnRange range;
    /// For a body that does not hold its path: in how many steps the full stroke of each of its
    /// actuators must be sampled. Empty: no sweep needed.
    std::vector<double> fullStrokeSteps;

    [[nodiscard]] bool sweeps() const noexcept { return !fullStrokeSteps.empty(); }
    /// Path samples between neighbouring levels, for a body with one actuator.
    [[nodiscard]] int stepsPerLevel(int levels) const noexcept;
};

/// Takes a rig apart into bodies and groups.
[[nodiscard]] std::vector<RigBody> bodiesOf(const Rig& rig, const VoxelFrame& frame);

} // namespace lumorph
