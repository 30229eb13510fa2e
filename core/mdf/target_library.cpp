#include "core/mdf/target_library.h"

#include <algorithm>
#include <system_error>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {
namespace {

/// So much of the body must lie in a target that is taken for a pose of the device.
constexpr double kHoldsBody = 0.95;

} // namespace

std::vector<std::filesystem::path> meshFilesIn(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (isMeshFile(entry->path())) files.push_back(entry->path());
    if (error)
        throw DataError(folder.string(), "it cannot be read as a folder (" + error.message() + ")",
                        "give a folder with meshes");
    if (files.empty())
        throw DataError(folder.string(), "it holds no mesh", "put .glb, .gltf, .obj, .stl, .ply or .off files there");
    std::ranges::sort(files);
    return files;
}

std::vector<LibraryTarget> readTargets(const std::vector<std::filesystem::path>& files, const Progress& progress) {
    std::vector<LibraryTarget> library;
    for (std::size_t k = 0; k < files.size(); ++k) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(k) / static_cast<double>(files.size()), "reading targets");
        LibraryTarget target;
        const bool twin = std::ranges::count(files, files[k].stem(), [](const auto& file) { return file.stem(); }) > 1;
        target.name = (twin ? files[k].filename() : files[k].stem()).string();
        std::vector<std::string> warnings;
        TriangleMesh mesh = readMesh(files[k], &warnings);
        target.target = makeTarget(std::move(mesh));
        target.target.warnings.insert(target.target.warnings.begin(), warnings.begin(), warnings.end());
        target.box = boundingBox(target.target.mesh.positions);
        const glm::vec3 size = target.box.size();
        if (target.box.empty() || !(std::min({size.x, size.y, size.z}) > 0.0F))
            throw DataError(files[k].string(), "it has no volume", "give a solid, or leave it out");
        library.push_back(std::move(target));
    }
    return library;
}

std::vector<LibraryTarget> readTargetLibrary(const std::filesystem::path& folder, const Progress& progress) {
    return readTargets(meshFilesIn(folder), progress);
}

Placement placeTarget(const VoxelFrame& frame, float restSurface, const BitColumns& body, const LibraryTarget& target,
                      TargetPlacing placing) {
    if (placing == TargetPlacing::automatic) {
        const Box room = frame.box();
        const bool meets = target.box.min.x < room.max.x && target.box.max.x > room.min.x &&
                           target.box.min.z < room.max.z && target.box.max.z > room.min.z;
        placing = TargetPlacing::fitted;
        if (meets && target.target.closed && body.count() > 0) {
            BitColumns bits;
            SolidVoxelizer voxelizer;
            voxelizer.voxelize(frame, target.target.mesh.positions, target.target.mesh.triangles, bits);
            if (static_cast<double>(bits.countAnd(body)) >= kHoldsBody * static_cast<double>(body.count()))
                placing = TargetPlacing::asIs;
        }
    }
    return placing == TargetPlacing::asIs ? Placement{} : fitPlacement(frame, restSurface, target.box);
}

} // namespace lumorph
