#pragma once

#include <optional>
#include <span>

#include "core/mdf/field.h"
#include "core/mdf/placement.h"

namespace lumorph {

/// Where a device shows reliefs: from the rest surface up to what it rises to.
struct ReliefRoom {
    VoxelFrame frame;
    float rest = 0.0F; ///< metres
    float top = 0.0F;  ///< metres, above `rest`: so high rise all but the highest twentieth of what moves
    Box reach;         ///< of all that moves
};

/// None for a device that moves nothing above its rest surface.
[[nodiscard]] std::optional<ReliefRoom> reliefRoom(const Field& field);

/// The target as a head on a coin: the heights that are seen from above are compressed to the room's, and all below
/// them is filled. The compression is one rising curve for the whole target, half linear and half by how much of the
/// picture lies at each height, so that what is higher stays higher and edges stay edges. Seen from above a target
/// need not be closed. `out` gets the frame's shape; the body is not taken out.
void voxelizeRelief(const ReliefRoom& room, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                    BitColumns& out);

/// Where a target stands to be shown as a relief: one of the 24 orientations along the axes, by `index`, the first of
/// which has the front (+Z) up and the top (+Y) away from the viewer; stretched over what moves, its highest point as
/// high as the device rises. Throws InvalidInput for a target without extent.
[[nodiscard]] Placement reliefPlacement(const ReliefRoom& room, const TriangleMesh& mesh, int index);
inline constexpr int kReliefPlacements = 24;

} // namespace lumorph
