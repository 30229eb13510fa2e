#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// The mesh as a Wavefront OBJ file. Coordinates have as many digits as they need to read back
/// bit-equal, no more.
[[nodiscard]] std::string writeObj(const TriangleMesh& mesh);

/// The mesh as a binary STL file, normals included. STL has no shared vertices.
[[nodiscard]] std::vector<std::byte> writeStl(const TriangleMesh& mesh);

} // namespace lumorph
