#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "core/base/progress.h"
#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/mdf/field.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/solid.h"

namespace lumorph {

/// A mesh to be matched, and whether scan conversion can be trusted with it.
struct Target {
    TriangleMesh mesh;
    bool closed = true;
    std::vector<std::string> warnings; ///< plain sentences
};

/// Looks at the mesh once, so that voxelising it every frame need not. One that is not closed is
/// repaired where that is safe (`repairMesh`) and stays open where it is not; the warnings say so.
[[nodiscard]] Target makeTarget(TriangleMesh mesh);

/// Whether scan conversion can be trusted with a mesh as it is: closed, and two triangles an edge.
[[nodiscard]] bool isClosedSolid(const TriangleMesh& mesh);

/// Voxels of the frame inside the target: scan conversion when it is closed, else generalised winding
/// numbers, which can take seconds for thousands of loose triangles. The frame's zero-state body is not taken out.
/// Throws Cancelled.
void voxelizeTarget(const VoxelFrame& frame, const Target& target, SolidVoxelizer& voxelizer, BitColumns& out,
                    const Progress& progress = {});

/// Share of a target's volume, in [0, 1], that its voxels `bits` leave out because it reaches beyond
/// the frame (R42). 0 for an open target, whose volume is not known.
[[nodiscard]] double shareBeyondFrame(const VoxelFrame& frame, const Target& target, const BitColumns& bits) noexcept;

/// Where a target stands: scaled and turned about its own origin, then moved; device coordinates.
struct Placement {
    double scale = 1.0;
    Angle yaw; ///< heading about +Y, after `orientation`
    glm::vec3 translation{0.0F};
    glm::quat orientation{1.0F, 0.0F, 0.0F, 0.0F}; ///< which side is up; a unit quaternion
    bool relief = false;                           ///< matched as `voxelizeRelief` shapes it; shown as it is

    [[nodiscard]] glm::mat4 deviceFromTarget() const;
    /// Heading and orientation in one.
    [[nodiscard]] glm::quat rotation() const;
    bool operator==(const Placement&) const = default;
};

/// Writes the points carried over by `deviceFromTarget`; reuses the memory of `out`.
void placePoints(std::span<const glm::vec3> points, const glm::mat4& deviceFromTarget, std::vector<glm::vec3>& out);

/// The mesh with the placement applied.
[[nodiscard]] TriangleMesh placed(const TriangleMesh& mesh, const Placement& placement);

/// The largest uniform scale at which a box, turned as said, fits into the frame above the rest surface, centred in x
/// and z and standing on the rest surface. Throws InvalidInput for an empty or flat box, or a frame
/// with no room above the rest surface.
[[nodiscard]] Placement fitPlacement(const VoxelFrame& frame, float restSurface, const Box& box, Angle yaw = {},
                                     const glm::quat& orientation = {1.0F, 0.0F, 0.0F, 0.0F});
[[nodiscard]] Placement fitPlacement(const Field& field, const Box& box, Angle yaw = {},
                                     const glm::quat& orientation = {1.0F, 0.0F, 0.0F, 0.0F});

} // namespace lumorph
