#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/session.h"
#include "core/mdf/field.h"
#include "core/mdf/placement.h"

namespace lumorph::cli {

/// Reads a .mdf file, or stdin for "-".
[[nodiscard]] Field readFieldFile(const Session& session, const std::string& path);

/// A target as voxels of a field's frame.
struct TargetVoxels {
    BitColumns bits;
    TriangleMesh mesh;                 ///< placed, device coordinates; empty when the target came as voxels
    double voxelizeMilliseconds = 0.0; ///< median
    std::vector<std::string> warnings;
};

struct TargetArguments {
    std::string path;
    bool fit = false;
    bool surface = false; ///< voxels that its surface meets, instead of those inside it; it may be open then
    int repeat = 1;       ///< how often to voxelise, for the median
};

/// Reads a mesh, or an NRRD grid in the field's own frame, and turns it into voxels. On stdin ("-") it
/// may be NRRD, GLB or OBJ, told apart by how it begins.
[[nodiscard]] TargetVoxels readTarget(const Session& session, const Field& field, const TargetArguments& arguments);

/// Reads a mesh from a file, or from stdin for "-".
[[nodiscard]] Target readTargetMesh(const Session& session, const std::string& path);
/// Turns a mesh that has been read already into voxels; without a placement it stands where it is.
[[nodiscard]] TargetVoxels voxelsOf(const Session& session, const Field& field, const Target& target,
                                    const std::optional<Placement>& placement, int repeat);

} // namespace lumorph::cli
