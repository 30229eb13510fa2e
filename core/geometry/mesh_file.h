#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Limits stated to users; a file beyond them is refused with a message, not tried.
inline constexpr std::size_t kMaxTriangles = 10'000'000;
inline constexpr std::size_t kMaxFileBytes = std::size_t{2} << 30;

/// Whether the extension is one that `readMesh` knows, and whether it is one of glTF.
[[nodiscard]] bool isMeshFile(const std::filesystem::path& file);
[[nodiscard]] bool isGltfFile(const std::filesystem::path& file);

/// Reads a mesh of any supported kind by its extension: .gltf .glb .obj .stl .ply .off (any case).
/// Polygons are triangulated; vertices of .stl files at the same place are merged. Units and axes
/// are the file's own. What of a sound mesh is passed over, or stands in for something, is added to `warnings`.
/// Throws DataError naming the file, the line or element where known, and the remedy: not readable,
/// empty, unknown extension, truncated, an index out of range, NaN or infinite coordinates, too large.
[[nodiscard]] TriangleMesh readMesh(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr);

/// Writes by extension: .obj, .stl (binary), .glb. Written beside the target and renamed, so that a
/// failure leaves no half file. Throws DeviceError when the disk refuses.
void writeMesh(const TriangleMesh& mesh, const std::filesystem::path& file);

} // namespace lumorph
