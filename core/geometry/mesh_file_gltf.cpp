#include "core/geometry/mesh_file_gltf.h"

#include "core/base/error.h"
#include "core/geometry/model.h"

namespace lumorph {

TriangleMesh readGltfMesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const Model model = readModel(file);
    TriangleMesh mesh = flatten(model);
    if (mesh.empty())
        throw DataError(file.string(),
                        "holds no mesh" +
                            (model.warnings.empty() ? std::string() : " (" + model.warnings.front() + ")"),
                        "export the model as a surface of polygons");
    warnings.insert(warnings.end(), model.warnings.begin(), model.warnings.end());
    return mesh;
}

std::vector<std::byte> writeGlbMesh(const TriangleMesh& mesh, const std::string& name) {
    return writeGlb(modelOf(mesh, name));
}

} // namespace lumorph
