#include "core/geometry/mesh_file_gltf.h"

#include "core/geometry/model.h"

namespace lumorph {

TriangleMesh readGltfMesh(const std::filesystem::path& file) { return flatten(readModel(file)); }

std::vector<std::byte> writeGlbMesh(const TriangleMesh& mesh, const std::string& name) {
    return writeGlb(modelOf(mesh, name));
}

} // namespace lumorph
