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

/// The mesh as a 3MF file with one object of that name (3MF Core Specification 1.2), by lib3mf. One unit of the mesh is
/// a millimetre, +Z is up. Throws InvalidInput when it is no closed solid, which 3MF asks for.
[[nodiscard]] std::vector<std::byte> write3mf(const TriangleMesh& mesh, const std::string& name);

} // namespace lumorph
