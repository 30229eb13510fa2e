#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/mdf/field.h"
#include "core/voxels/bit_columns.h"

namespace lumorph {

/// Which part of a field is looked at (R14).
struct FieldViewOptions {
    std::optional<std::size_t> actuator =
        std::nullopt;    ///< empty: all combined, each voxel by the lowest level of any actuator
    int lowestLevel = 0; ///< only voxels first covered at these levels
    int highestLevel = 255;
    glm::ivec3 sliceFrom{0}; ///< only voxels in this box of the frame, both ends included
    glm::ivec3 sliceTo{0x7FFF};
    const BitColumns* touchedBy = nullptr; ///< only voxels of this target
    bool surfaceOnly = true;               ///< leave out voxels whose six neighbours are all shown: they cannot be seen
};

/// A voxel to show and the level at which the actuator first covers it (v0 of its ramp).
struct FieldVoxel {
    glm::ivec3 voxel{0};
    int level = 0;
};

/// The level at which an actuator first covers each voxel (v0 of its ramp), or the lowest of any when `actuator` is
/// empty; kUnchanged where none changes it. In Field::voxelIndex order. Throws InvalidInput for an actuator that is not
/// there.
[[nodiscard]] std::vector<std::uint8_t> firstLevels(const Field& field, std::optional<std::size_t> actuator);

/// The voxels that can be seen of those from `from` to `to`, both included: at least one of their six neighbours is
/// not set, or not in that box. Column by column.
[[nodiscard]] std::vector<glm::ivec3> surfaceVoxels(const BitColumns& voxels, const glm::ivec3& from = glm::ivec3(0),
                                                    const glm::ivec3& to = glm::ivec3(0x7FFF));

/// The voxels to show, column by column. Throws InvalidInput for an actuator that is not there or a target of another
/// shape.
[[nodiscard]] std::vector<FieldVoxel> fieldVoxels(const Field& field, const FieldViewOptions& options);

/// The boundary of what is expected to be covered by at least one half at `level` by an actuator alone, or where any
/// actuator at that level does so: a closed mesh in device metres with two triangles an edge, marching over voxel
/// centres. Of the voxels that those actuators change; so without the body. Empty where nothing is. Throws InvalidInput
/// for an actuator or a level that is not there.
[[nodiscard]] TriangleMesh levelSurface(const Field& field, std::optional<std::size_t> actuator, int level);

/// Expected coverage of one voxel as each actuator goes through its levels, in [0, 1]: [actuator][level]. For an
/// actuator that does not change the voxel it is the mean over the states of the others. Throws InvalidInput outside
/// the frame.
[[nodiscard]] std::vector<std::vector<double>> rampsAt(const Field& field, const glm::ivec3& voxel);

} // namespace lumorph
