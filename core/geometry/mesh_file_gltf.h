#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// All triangles of a glTF or GLB file at its rest pose; its warnings are added to `warnings`. Throws DataError as
/// `readModel`, and for one without triangles.
[[nodiscard]] TriangleMesh readGltfMesh(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The mesh as a GLB file with one node called `name`.
[[nodiscard]] std::vector<std::byte> writeGlbMesh(const TriangleMesh& mesh, const std::string& name);

} // namespace lumorph
