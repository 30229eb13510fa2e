#include "core/geometry/mesh_file_gltf.h"

#include "core/base/error.h"
#include "core/geometry/gltf_reader.h"

namespace lumorph {

TriangleMesh readGltfMesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const ReadModel read = readModelFile(file);
    TriangleMesh mesh = flatten(read.model);
    if (mesh.empty())
        throw DataError(file.string(),
                        "holds no mesh" + (read.warnings.empty() ? std::string() : " (" + read.warnings.front() + ")"),
                        "export the model as a surface of polygons");
    warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
    return mesh;
}

std::vector<std::byte> writeGlbMesh(const TriangleMesh& mesh, const std::string& name) {
    return writeGlb(modelOf(mesh, name));
}

} // namespace lumorph
