#include <algorithm>
#include <cmath>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "core/voxels/solid.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"
#include "tests/support/cgal_oracle.h"

namespace lumorph::bench {

namespace {

constexpr std::size_t kTriangles = 70'000;

/// The mesh as OpenVDB takes it, and a transform whose voxel centres are those of the frame.
struct VdbInput {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    openvdb::math::Transform::Ptr transform;

    VdbInput(const VoxelFrame& frame, const TriangleMesh& mesh)
        : transform(openvdb::math::Transform::createLinearTransform(frame.voxelSize)) {
        for (const glm::vec3& p : mesh.positions) points.emplace_back(p.x, p.y, p.z);
        for (const glm::uvec3& t : mesh.triangles) triangles.emplace_back(t.x, t.y, t.z);
        const glm::dvec3 first = frame.centre(0, 0, 0);
        transform->postTranslate(openvdb::Vec3d(first.x, first.y, first.z));
    }

    /// The default narrow band, three voxels to each side.
    [[nodiscard]] openvdb::FloatGrid::Ptr levelSet() const {
        return openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles);
    }
};

template <typename Inside> std::size_t differences(const VoxelFrame& frame, const BitColumns& bits, Inside&& inside) {
    std::size_t count = 0;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x)
            for (int y = 0; y < frame.dimensions.y; ++y) count += inside(x, y, z) != bits.test(x, y, z) ? 1U : 0U;
    return count;
}

struct VoxelTimes {
    double ours = 0.0; ///< seconds
    double openVdb = 0.0;
    std::string note;
};

VoxelTimes measureVoxels(const std::string& name, const VoxelFrame& frame, const TriangleMesh& mesh) {
    const VdbInput input(frame, mesh);
    SolidVoxelizer voxelizer;
    BitColumns bits;
    openvdb::FloatGrid::Ptr grid;
    const std::vector<double> medians =
        interleavedMedians(5, {{[&] { voxelizer.voxelize(frame, mesh.positions, mesh.triangles, bits); }, 20},
                               {[&] { grid = input.levelSet(); }}});
    const test::InsideOracle oracle(mesh);
    const std::size_t fromOracle =
        differences(frame, bits, [&](int x, int y, int z) { return oracle(frame.centre(x, y, z)); });
    const auto values = grid->getConstAccessor();
    const std::size_t fromVdb =
        differences(frame, bits, [&](int x, int y, int z) { return values.getValue(openvdb::Coord(x, y, z)) < 0.0F; });
    return {medians[0], medians[1],
            name + ": " + std::to_string(mesh.triangles.size()) + " triangles, " + std::to_string(bits.count()) +
                " voxels set; " + fixed(1e3 * medians[0], 3) + " ms, OpenVDB " + fixed(1e3 * medians[1], 0) +
                " ms; of " + std::to_string(frame.voxelCount()) + " voxels " + std::to_string(fromOracle) +
                " differ from CGAL Side_of_triangle_mesh, " + std::to_string(fromVdb) + " from OpenVDB"};
}

} // namespace

void benchVoxelize(const Filter& filter, Report& report) {
    const std::string ratio = "voxelize-openvdb";
    const std::string absolute = "voxelize-solid";
    if (!filter.wants(ratio) && !filter.wants(absolute)) return;
    openvdb::initialize();
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);

    const Rig rig = readRig(resourceFile("models/tablet.glb"));
    Field field; // placing a mesh needs the frame and the rest surface alone
    field.frame = frameOf(rig.reach(), 33);
    field.restSurface = boundingBox(rig.restMesh().positions).max.y;
    std::vector<VoxelTimes> all{measureVoxels("bumpy ellipsoid", field.frame, fitted(field, bumpyEllipsoid()))};
    if (const auto rocker = sharedMesh("rocker-arm.obj"))
        all.push_back(measureVoxels("rocker-arm, divided", field.frame, fitted(field, dividedTo(*rocker, kTriangles))));

    double worstRatio = INFINITY;
    double slowest = 0.0;
    std::vector<std::string> notes;
    for (const VoxelTimes& of : all) {
        worstRatio = std::min(worstRatio, of.openVdb / of.ours);
        slowest = std::max(slowest, of.ours);
        notes.push_back(of.note);
    }
    if (filter.wants(ratio))
        report.add(Row{ratio, "70,000 triangles, against meshToLevelSet, one thread (worst mesh)", worstRatio, "x",
                       atLeast(150.0), atLeast(300.0), notes});
    if (filter.wants(absolute))
        report.add(Row{absolute,
                       "solid voxelisation of 70,000 triangles (slowest mesh)",
                       1e3 * slowest,
                       "ms",
                       {},
                       atMost(1.5),
                       {}});
}

} // namespace lumorph::bench
