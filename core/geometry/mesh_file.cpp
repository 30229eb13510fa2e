#include "core/geometry/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/mesh_file_gltf.h"
#include "core/geometry/mesh_parsers.h"
#include "core/geometry/mesh_writers.h"

namespace lumorph {
namespace {

std::string lowerExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

using Bytes = std::span<const std::byte>;
using Parser = TriangleMesh (*)(Bytes, const std::string&, std::vector<std::string>*);

Parser parserOf(const std::string& extension) {
    if (extension == ".obj")
        return [](Bytes bytes, const std::string& name, std::vector<std::string>*) { return parseObj(bytes, name); };
    if (extension == ".off")
        return [](Bytes bytes, const std::string& name, std::vector<std::string>*) { return parseOff(bytes, name); };
    if (extension == ".stl") return parseStl;
    if (extension == ".ply") return parsePly;
    return nullptr;
}

void checkWritable(const TriangleMesh& mesh, const std::filesystem::path& file) {
    if (mesh.empty()) throw InvalidInput(file.string(), "the mesh to write has no triangles", "give it some");
    for (const glm::vec3& p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw InvalidInput(file.string(), "the mesh to write has a coordinate that is not finite",
                               "repair it first");
    for (const glm::uvec3& t : mesh.triangles)
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size())
            throw InvalidInput(file.string(), "the mesh to write refers to a vertex it does not have",
                               "repair it first");
}

} // namespace

bool isGltfFile(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    return extension == ".gltf" || extension == ".glb";
}

bool isMeshFile(const std::filesystem::path& file) {
    return parserOf(lowerExtension(file)) != nullptr || isGltfFile(file);
}

TriangleMesh readMesh(const std::filesystem::path& file, std::vector<std::string>* warnings) {
    const std::string extension = lowerExtension(file);
    if (const Parser parse = parserOf(extension)) {
        const std::vector<std::byte> bytes = readFile(file, kMaxFileBytes);
        if (bytes.empty()) throw DataError(file.string(), "the file is empty", "export the model again");
        return parse(bytes, file.string(), warnings);
    }
    if (!isGltfFile(file))
        throw DataError(file.string(), "is of no kind known by its extension",
                        "use .gltf, .glb, .obj, .stl, .ply or .off");
    std::vector<std::string> unread;
    TriangleMesh mesh = readGltfMesh(file, warnings != nullptr ? *warnings : unread);
    if (mesh.triangles.size() > kMaxTriangles)
        throw DataError(file.string(), "has more than " + std::to_string(kMaxTriangles) + " triangles, the limit",
                        "reduce its detail (decimate it) before exporting");
    return mesh;
}

void writeMesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
    checkWritable(mesh, file);
    const std::string extension = lowerExtension(file);
    if (extension == ".obj") {
        const std::string text = writeObj(mesh);
        writeFileAtomically(file, std::as_bytes(std::span(text)));
    } else if (extension == ".stl") {
        writeFileAtomically(file, writeStl(mesh));
    } else if (extension == ".glb") {
        writeFileAtomically(file, writeGlbMesh(mesh, file.stem().string()));
    } else {
        throw InvalidInput(file.string(), "meshes are not written in the kind its extension names",
                           "use .obj, .stl or .glb");
    }
}

} // namespace lumorph
