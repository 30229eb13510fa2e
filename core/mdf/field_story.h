#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/mdf/field.h"
#include "core/mdf/voting.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What tells how a field comes about and how a target is matched with it, step by step (paper, Figures 7 and 8):
/// planes cut through it, what single actuators and pairs reach, which target voxels speak for which level.

/// One layer of voxels that stands upright in a frame: all of one x (`axis` 0, seen from the right) or of one z (`axis`
/// 2, seen from the front).
struct VoxelPlane {
    int axis = 2;
    int index = 0;
    bool operator==(const VoxelPlane&) const = default;
};

/// Voxels across and upwards.
[[nodiscard]] glm::ivec2 sizeOf(const VoxelPlane& plane, const glm::ivec3& dimensions) noexcept;
/// The voxel at a place of the plane, counted from the lower left corner as it is seen.
[[nodiscard]] glm::ivec3 voxelOf(const VoxelPlane& plane, const glm::ivec3& dimensions, const glm::ivec2& at) noexcept;
/// Where a point in device metres lies in the plane, in voxels from the lower left corner as it is seen.
[[nodiscard]] glm::dvec2 placeIn(const VoxelPlane& plane, const VoxelFrame& frame, const glm::dvec3& point) noexcept;
/// The coordinate of the layer's middle along its axis, metres.
[[nodiscard]] double middleOf(const VoxelPlane& plane, const VoxelFrame& frame) noexcept;

/// The plane that shows best what an actuator does: one in which it moves rather than one that it moves through (across
/// a bend, not along it), and of those the one with the most voxels that it changes. Of planes that are as good the
/// middle one; the frame's middle for an actuator that changes nothing. `rig` is that of the field. Throws InvalidInput
/// for an actuator that is not there.
[[nodiscard]] VoxelPlane tellingPlane(const Field& field, const Rig& rig, std::size_t actuator);
/// The plane with the most of these voxels; the frame's middle when there are none.
[[nodiscard]] VoxelPlane fullestPlane(const BitColumns& voxels);

/// What actuators reach one at a time, and what only two of them moved together reach.
struct JointReach {
    BitColumns alone;    ///< voxels of V(s) for some level of one actuator, the others at rest
    BitColumns together; ///< voxels of V(s) for some levels of two actuators, and not of `alone`
    struct Pair {
        std::size_t first = 0, second = 0; ///< actuators
        std::size_t voxels = 0;            ///< of `together` that these two reach; always more than none
        bool operator==(const Pair&) const = default;
    };
    std::vector<Pair> pairs; ///< those that reach the most first
};
/// Looks at every level of every actuator and at all levels of every two that are coupled: no others reach more
/// together than alone. Throws Cancelled.
[[nodiscard]] JointReach jointReach(const Coverage& coverage, const Progress& progress = {});

/// The voxels that an actuator changes. Throws InvalidInput for one that is not there.
[[nodiscard]] BitColumns changedVoxels(const Field& field, std::size_t actuator);

/// How many voxels of a target speak for each level of an actuator: those that it first covers at that level (v0 of
/// their ramps). Throws InvalidInput for an actuator that is not there or a target of another shape.
[[nodiscard]] std::vector<std::size_t> candidateCounts(const Field& field, std::size_t actuator,
                                                       const BitColumns& target);

/// A target matched both ways.
struct StoryMatch {
    BitColumns target; ///< its voxels in the domain
    Votes votes;
    struct Fit {
        State state;
        BitColumns covered; ///< V(state)
        FitQuality quality;
    };
    Fit voting, refined;
};
/// Eq. 1, and refinement from there until nothing helps any more. `target` may hold voxels of the body. Throws
/// InvalidInput for a target of another shape, Cancelled.
[[nodiscard]] StoryMatch matchStory(const Coverage& coverage, const Voting& voting, BitColumns target,
                                    const Progress& progress = {});

} // namespace lumorph
