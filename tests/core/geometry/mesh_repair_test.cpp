#include <filesystem>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_file.h"
#include "tests/core/geometry/sample_meshes.h"

namespace lumorph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const TriangleMesh kWholeCube = cubeAt({0, 0, 0}, 1);

/// Shattered, three faces turned, one triangle missing, one twice, one collapsed.
TriangleMesh ruinedCube() {
    TriangleMesh mesh = shattered(kWholeCube);
    for (const std::size_t t : {1U, 4U, 9U}) std::swap(mesh.triangles[t].x, mesh.triangles[t].z);
    mesh.triangles.erase(mesh.triangles.begin() + 6);
    mesh.triangles.push_back(mesh.triangles[2]);
    mesh.triangles.emplace_back(0, 0, 1);
    return mesh;
}

/// A cube whose bottom edge has a corner in its middle on one side only, closed by a flat triangle.
TriangleMesh cubeWithFlatTriangle() {
    TriangleMesh mesh = kWholeCube;
    mesh.positions.emplace_back(0.5F, 0, 0);
    mesh.triangles[4] = {0, 8, 5}; // was 0, 1, 5
    mesh.triangles.emplace_back(8, 1, 5);
    mesh.triangles.emplace_back(0, 1, 8);
    return mesh;
}

TriangleMesh gluedCubes() {
    // Shattered, so that the wall between them is back to back on the same places.
    return shattered(both(kWholeCube, cubeAt({1, 0, 0}, 1)));
}

/// Welded where they touch: one edge with four triangles.
TriangleMesh cubesSharingAnEdge() { return shattered(both(kWholeCube, cubeAt({1, 1, 0}, 1))); }

TriangleMesh withoutTop() {
    TriangleMesh mesh = kWholeCube;
    mesh.triangles.erase(mesh.triangles.begin() + 6, mesh.triangles.begin() + 8);
    return mesh;
}

/// A side's two triangles and the opposite side's gone: holes that touch at no point, and two that do.
TriangleMesh withTouchingHoles() {
    TriangleMesh mesh = kWholeCube;
    // Triangles 0-2-3 of the back and 2-7-3's neighbour across corner 2 only.
    mesh.triangles.erase(mesh.triangles.begin() + 8); // 0 4 6
    mesh.triangles.erase(mesh.triangles.begin() + 1); // 0 3 1
    return mesh;
}

TriangleMesh openTube(std::uint32_t sides) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double a = 6.283185307179586 * i / sides;
        mesh.positions.emplace_back(std::cos(a), 0, -std::sin(a));
        mesh.positions.emplace_back(std::cos(a), 1, -std::sin(a));
        const std::uint32_t p = 2 * i;
        const std::uint32_t q = 2 * ((i + 1) % sides);
        mesh.triangles.emplace_back(p, q, q + 1);
        mesh.triangles.emplace_back(p, q + 1, p + 1);
    }
    return mesh;
}

double tubeVolume(std::uint32_t sides) { return 0.5 * sides * std::sin(6.283185307179586 / sides); }

TriangleMesh insideOutWithCavity() { return turned(both(kWholeCube, turned(cubeAt({0.25F, 0.25F, 0.25F}, 0.5F)))); }

struct Ruin {
    const char* name;
    TriangleMesh mesh;
    std::size_t components;
    double volume;
};

class RepairMeshTable : public testing::TestWithParam<Ruin> {};

TEST_P(RepairMeshTable, GiveASolidOfTheRightVolume) {
    const Ruin& c = GetParam();
    const MeshRepair repair = repairMesh(c.mesh);
    EXPECT_THAT(repair.after.findings(), IsEmpty());
    EXPECT_TRUE(repair.after.solid());
    EXPECT_EQ(repair.after.components, c.components);
    EXPECT_NEAR(repair.after.volume, c.volume, 1e-6);
    EXPECT_THAT(repair.before.findings(), testing::Not(IsEmpty()));
    EXPECT_THAT(repair.actions, testing::Not(IsEmpty()));
    EXPECT_NEAR(signedVolume(repair.mesh), c.volume, 1e-6);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Meshes, RepairMeshTable, testing::Values(
    //   name                   mesh                    parts volume
    Ruin{"RuinedCube",          ruinedCube(),           1,    1.0},
    Ruin{"FlatTriangle",        cubeWithFlatTriangle(), 1,    1.0},
    Ruin{"InsideOut",           turned(kWholeCube),     1,    1.0},
    Ruin{"InsideOutWithCavity", insideOutWithCavity(),  2,    0.875},
    Ruin{"GluedCubes",          gluedCubes(),           1,    2.0},
    Ruin{"CubesOnOneEdge",      cubesSharingAnEdge(),   2,    2.0},
    Ruin{"WithoutTop",          withoutTop(),           1,    1.0},
    Ruin{"TouchingHoles",       withTouchingHoles(),    1,    1.0},
    Ruin{"OpenTube",            openTube(48),           1,    tubeVolume(48)}),
    [](const auto& test) { return std::string(test.param.name); });
// clang-format on

TEST(RepairMesh, LeavesSoundMeshesAsTheyAre) {
    for (const TriangleMesh& mesh :
         {kWholeCube, torus(20, 10), shattered(kWholeCube), both(kWholeCube, cubeAt({0.5F, 0, 0}, 1))}) {
        const MeshRepair repair = repairMesh(mesh);
        EXPECT_EQ(repair.mesh.positions, mesh.positions);
        EXPECT_EQ(repair.mesh.triangles, mesh.triangles);
        EXPECT_THAT(repair.actions, IsEmpty());
    }
}

TEST(RepairMesh, MergesVerticesAndSaysWhatItDid) {
    const MeshRepair repair = repairMesh(ruinedCube());
    EXPECT_EQ(repair.mesh.positions.size(), 8U);
    EXPECT_EQ(repair.mesh.triangles.size(), 12U);
    EXPECT_THAT(repair.actions, ElementsAre(HasSubstr("collapsed"), HasSubstr("repeated"), HasSubstr("merged"),
                                            HasSubstr("turned"), HasSubstr("A hole was filled")));
}

TEST(RepairMesh, LeavesLargeHolesOpenAndSaysSo) {
    const MeshRepair repair = repairMesh(openTube(48), 47);
    EXPECT_EQ(repair.after.boundaryEdges, 96U);
    EXPECT_THAT(repair.actions, ElementsAre(HasSubstr("2 holes were left open")));
}

TEST(RepairMesh, DoesNotMakePillowsOfFlatSheets) {
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const MeshRepair repair = repairMesh(sheet);
    EXPECT_EQ(repair.mesh.triangles, sheet.triangles);
    EXPECT_EQ(repair.after.boundaryEdges, 4U);
    EXPECT_THAT(repair.actions, ElementsAre(HasSubstr("left open")));
}

TEST(RepairMesh, KeepsSoundPartsBitEqualBesideABrokenOne) {
    const TriangleMesh sound = torus(16, 8);
    TriangleMesh mesh = both(sound, cubeAt({5, 0, 0}, 1));
    mesh.triangles.pop_back();
    const MeshRepair repair = repairMesh(mesh);
    EXPECT_TRUE(repair.after.solid());
    ASSERT_GE(repair.mesh.triangles.size(), sound.triangles.size());
    for (std::size_t t = 0; t < sound.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(repair.mesh.positions[repair.mesh.triangles[t][k]], sound.positions[sound.triangles[t][k]]);
}

TEST(RepairMesh, TakesARandomHeapAndReportsTruly) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> place(0, 3);
    std::uniform_int_distribution<std::uint32_t> vertex(0, 39);
    for (int round = 0; round < 200; ++round) {
        TriangleMesh heap;
        for (int i = 0; i < 40; ++i) heap.positions.emplace_back(place(random), place(random), place(random));
        heap.positions[0].x = std::numeric_limits<float>::quiet_NaN();
        for (int i = 0; i < 30; ++i) heap.triangles.emplace_back(vertex(random), vertex(random), vertex(random));
        const MeshRepair repair = repairMesh(heap);
        const MeshReport again = checkMesh(repair.mesh);
        EXPECT_EQ(again.boundaryEdges, repair.after.boundaryEdges);
        EXPECT_EQ(again.nonManifoldEdges, repair.after.nonManifoldEdges);
        EXPECT_EQ(again.inwardComponents, 0U) << "round " << round;
        EXPECT_EQ(again.degenerateTriangles, 0U) << "round " << round;
    }
}

TEST(RepairMesh, ClosesASharedModelWithHolesCutIntoIt) {
    const std::filesystem::path file = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/meshes/spot.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared models here";
    TriangleMesh mesh = readMesh(file);
    const double volume = signedVolume(mesh);
    for (std::size_t t = mesh.triangles.size(); t > 100; t -= 97)
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t - 1));
    const MeshRepair repair = repairMesh(shattered(mesh));
    EXPECT_TRUE(repair.after.closed());
    EXPECT_TRUE(repair.after.manifold());
    EXPECT_NEAR(repair.after.volume, volume, 1e-4 * volume);
}

} // namespace
} // namespace lumorph
