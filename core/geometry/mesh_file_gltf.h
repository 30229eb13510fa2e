#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// All triangles of a glTF or GLB file at its rest pose.
[[nodiscard]] TriangleMesh readGltfMesh(const std::filesystem::path& file);

/// The mesh as a GLB file with one node called `name`.
[[nodiscard]] std::vector<std::byte> writeGlbMesh(const TriangleMesh& mesh, const std::string& name);

} // namespace lumorph
