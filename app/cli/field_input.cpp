#include "app/cli/field_input.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/statistics.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/mesh_parsers.h"
#include "core/mdf/relief.h"
#include "core/voxels/nrrd.h"
#include "core/voxels/surface.h"

namespace lumorph::cli {

namespace {

bool hasGridExtension(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    return extension == ".nrrd" || extension == ".NRRD";
}

bool beginsWith(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char a, std::byte b) { return std::byte(static_cast<unsigned char>(a)) == b; });
}

/// What is passed over of it is added to `warnings`.
TriangleMesh parseMesh(std::span<const std::byte> bytes, const std::string& name, std::vector<std::string>& warnings) {
    if (!beginsWith(bytes, "glTF")) return parseObj(bytes, name);
    const ReadModel read = readGlbBytes(bytes, name);
    TriangleMesh mesh = flatten(read.model);
    if (mesh.empty()) throw DataError(name, "holds no mesh", "export the model as a surface of polygons");
    warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
    return mesh;
}

TargetVoxels gridVoxels(const Field& field, std::span<const std::byte> bytes, const std::string& path) {
    const ByteGrid grid = parseNrrd(bytes, path);
    const VoxelFrame& frame = field.frame;
    if (grid.frame.dimensions != frame.dimensions)
        throw DataError(path, "its grid has another shape than the field's",
                        "make it with 'lumorph voxelize --like' that field");
    const double shift = static_cast<double>(
        std::max({std::abs(grid.frame.origin.x - frame.origin.x), std::abs(grid.frame.origin.y - frame.origin.y),
                  std::abs(grid.frame.origin.z - frame.origin.z)}));
    if (std::abs(grid.frame.voxelSize / frame.voxelSize - 1.0) > 1e-4 || shift > 0.01 * frame.voxelSize)
        throw DataError(path, "its grid lies elsewhere than the field's",
                        "make it with 'lumorph voxelize --like' that field");
    return {bitsOf(grid), {}, 0.0, {}};
}

/// With the warnings of its file before its own.
Target targetOf(TriangleMesh mesh, const std::vector<std::string>& warnings) {
    Target target = makeTarget(std::move(mesh));
    target.warnings.insert(target.warnings.begin(), warnings.begin(), warnings.end());
    return target;
}

/// The mesh as it is: a surface needs no repair.
TargetVoxels surfaceVoxels(const Field& field, TriangleMesh mesh, std::vector<std::string> warnings, bool fit) {
    if (fit) mesh = placed(mesh, fitPlacement(field, boundingBox(mesh.positions)));
    TargetVoxels voxels{voxelizeSurface(field.frame, mesh), std::move(mesh), 0.0, std::move(warnings)};
    if (voxels.bits.count() == 0)
        voxels.warnings.emplace_back("the mesh lies beyond the space the device can show; use --fit.");
    return voxels;
}

} // namespace

TargetVoxels voxelsOf(const Session& session, const Field& field, const Target& target,
                      const std::optional<Placement>& placement, int repeat) {
    TargetVoxels voxels{{}, placed(target.mesh, placement.value_or(Placement{})), 0.0, target.warnings};
    const Target standing{voxels.mesh, target.closed, {}};
    std::optional<ReliefRoom> room;
    if (placement && placement->relief) room = reliefRoom(field);
    SolidVoxelizer voxelizer;
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) {
        const auto start = std::chrono::steady_clock::now();
        if (room)
            voxelizeRelief(*room, standing.mesh.positions, standing.mesh.triangles, voxels.bits);
        else
            voxelizeTarget(field.frame, standing, voxelizer, voxels.bits, session.progress());
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    if (!target.closed) Session::endProgress();
    voxels.voxelizeMilliseconds = median(std::move(times));
    const double beyond = room ? 0.0 : shareBeyondFrame(field.frame, standing, voxels.bits);
    if (beyond > 0.01 && voxels.bits.count() > 0)
        voxels.warnings.push_back(std::to_string(std::lround(100.0 * beyond)) +
                                  " % of the target lies beyond the space the device can show and is ignored" +
                                  (placement ? "." : "; use --fit."));
    return voxels;
}

Target readTargetMesh(const Session& session, const std::string& path) {
    std::vector<std::string> warnings;
    TriangleMesh mesh =
        path == "-" ? parseMesh(session.readInput(path), inputName(path), warnings) : readMesh(path, &warnings);
    return targetOf(std::move(mesh), warnings);
}

TargetVoxels readTarget(const Session& session, const Field& field, const TargetArguments& arguments) {
    const std::string name = inputName(arguments.path);
    std::vector<std::byte> bytes;
    if (arguments.path == "-" || hasGridExtension(arguments.path)) bytes = session.readInput(arguments.path);
    if (hasGridExtension(arguments.path) || beginsWith(bytes, "NRRD")) {
        if (arguments.fit)
            throw InvalidInput("--fit", "a voxel grid stands where it is", "leave --fit out, or give the mesh");
        if (arguments.surface)
            throw InvalidInput("--surface", "a voxel grid has no surface to look at", "give the mesh");
        return gridVoxels(field, bytes, name);
    }
    std::vector<std::string> warnings;
    TriangleMesh mesh = arguments.path == "-" ? parseMesh(bytes, name, warnings) : readMesh(arguments.path, &warnings);
    if (arguments.surface) return surfaceVoxels(field, std::move(mesh), std::move(warnings), arguments.fit);
    const Target target = targetOf(std::move(mesh), warnings);
    std::optional<Placement> placement;
    if (arguments.fit) placement = fitPlacement(field, boundingBox(target.mesh.positions));
    return voxelsOf(session, field, target, placement, arguments.repeat);
}

} // namespace lumorph::cli
