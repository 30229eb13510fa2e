#include "app/cli/field_input.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/cli/session.h"
#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/voxels/nrrd.h"

namespace lumorph::cli {

namespace {

bool isNrrd(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    return path == "-" || extension == ".nrrd" || extension == ".NRRD";
}

TargetVoxels readGrid(const Field& field, const std::string& path) {
    const ByteGrid grid = parseNrrd(readInput(path), path);
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

} // namespace

double medianOf(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

TargetVoxels voxelsOf(const Field& field, const Target& target, const Placement& placement, int repeat) {
    TargetVoxels voxels{{}, placed(target.mesh, placement), 0.0, target.warnings};
    const Target standing{voxels.mesh, target.closed, {}};
    SolidVoxelizer voxelizer;
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) {
        const auto start = std::chrono::steady_clock::now();
        voxelizeTarget(field.frame, standing, voxelizer, voxels.bits);
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    voxels.voxelizeMilliseconds = medianOf(times);
    return voxels;
}

TargetVoxels readTarget(const Field& field, const TargetArguments& arguments) {
    if (isNrrd(arguments.path)) {
        if (arguments.fit)
            throw InvalidInput("--fit", "a voxel grid stands where it is", "leave --fit out, or give the mesh");
        return readGrid(field, arguments.path);
    }
    const Target target = makeTarget(readMesh(arguments.path));
    const Placement placement = arguments.fit ? fitPlacement(field, boundingBox(target.mesh.positions)) : Placement{};
    return voxelsOf(field, target, placement, arguments.repeat);
}

} // namespace lumorph::cli
