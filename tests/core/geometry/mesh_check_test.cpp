#include "core/geometry/mesh_check.h"

#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "tests/core/geometry/sample_meshes.h"

namespace lumorph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TriangleMesh without(TriangleMesh mesh, std::size_t triangle) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
    return mesh;
}

TriangleMesh oneTurned(TriangleMesh mesh) {
    std::swap(mesh.triangles[3].y, mesh.triangles[3].z);
    return mesh;
}

TriangleMesh tetrahedron(const glm::vec3& at) {
    TriangleMesh mesh;
    mesh.positions = {at, at + glm::vec3(2, 0, 0), at + glm::vec3(0, 2, 0), at + glm::vec3(0, 0, 2)};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

/// Two cubes that share the two vertices of one edge.
TriangleMesh cubesOnOneEdge() {
    TriangleMesh mesh = cubeAt({0, 0, 0}, 1);
    TriangleMesh other = cubeAt({1, 1, 0}, 1);
    for (glm::uvec3& t : other.triangles)
        for (int k = 0; k < 3; ++k) t[k] = t[k] == 0 ? 3U : t[k] == 4 ? 7U : t[k] + 8U;
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.triangles.insert(mesh.triangles.end(), other.triangles.begin(), other.triangles.end());
    return mesh;
}

TriangleMesh withFlatTriangles() {
    TriangleMesh mesh = cubeAt({0, 0, 0}, 1);
    mesh.triangles.emplace_back(0, 0, 1);
    return mesh;
}

TriangleMesh withNan() {
    TriangleMesh mesh = cubeAt({0, 0, 0}, 1);
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    mesh.triangles.emplace_back(0, 1, 8);
    return mesh;
}

struct Case {
    const char* name;
    TriangleMesh mesh;
    std::size_t components, boundary, nonManifold, degenerate, inward;
    bool intersects, solid;
    double volume;
};

class CheckMeshTable : public testing::TestWithParam<Case> {};

TEST_P(CheckMeshTable, CountsWhatIsWrong) {
    const Case& c = GetParam();
    const MeshReport report = checkMesh(c.mesh);
    EXPECT_EQ(report.vertices, c.mesh.positions.size());
    EXPECT_EQ(report.triangles, c.mesh.triangles.size());
    EXPECT_EQ(report.components, c.components);
    EXPECT_EQ(report.boundaryEdges, c.boundary);
    EXPECT_EQ(report.nonManifoldEdges, c.nonManifold);
    EXPECT_EQ(report.degenerateTriangles, c.degenerate);
    EXPECT_EQ(report.inwardComponents, c.inward);
    EXPECT_EQ(report.selfIntersections > 0, c.intersects);
    EXPECT_EQ(report.solid(), c.solid);
    EXPECT_NEAR(report.volume, c.volume, 1e-6);
    EXPECT_EQ(checkMesh(c.mesh, IntersectionTest::skip).selfIntersections, 0U);
}

const TriangleMesh kCube = cubeAt({0, 0, 0}, 1);
const TriangleMesh kInner = cubeAt({0.25F, 0.25F, 0.25F}, 0.5F);

// clang-format off
INSTANTIATE_TEST_SUITE_P(Meshes, CheckMeshTable, testing::Values(
    //   name                  mesh                                             parts holes nonman flat inward cross  solid  volume
    Case{"Cube",               kCube,                                           1,    0,    0,     0,   0,     false, true,  1.0},
    Case{"ShatteredCube",      shattered(kCube),                                1,    0,    0,     0,   0,     false, true,  1.0},
    Case{"MissingTriangle",    without(kCube, 0),                               1,    3,    0,     0,   0,     false, false, 1.0},
    Case{"TurnedTriangle",     oneTurned(kCube),                                1,    0,    3,     0,   0,     false, false, 2.0 / 3.0},
    Case{"InsideOut",          turned(kCube),                                   1,    0,    0,     0,   1,     false, false, -1.0},
    Case{"Cavity",             both(kCube, turned(kInner)),                     2,    0,    0,     0,   0,     false, true,  0.875},
    Case{"CavityInsideOut",    turned(both(kCube, turned(kInner))),             2,    0,    0,     0,   1,     false, false, -0.875},
    Case{"InwardBeside",       both(kCube, turned(cubeAt({3, 0, 0}, 1))),       2,    0,    0,     0,   1,     false, false, 0.0},
    Case{"CrossingTetrahedra", both(tetrahedron({0, 0, 0}), tetrahedron({0.3F, 0.2F, 0.1F})), 2, 0, 0, 0, 0,   true,  false, 8.0 / 3.0},
    Case{"CubesOnOneEdge",     cubesOnOneEdge(),                                1,    0,    1,     0,   0,     false, false, 2.0},
    Case{"CubesTouching",      both(kCube, cubeAt({1, 1, 0}, 1)),               2,    0,    0,     0,   0,     false, true,  2.0},
    Case{"CollapsedTriangle",  withFlatTriangles(),                             1,    0,    0,     1,   0,     false, true,  1.0},
    Case{"NotANumber",         withNan(),                                       1,    0,    0,     1,   0,     false, true,  1.0},
    Case{"Nothing",            TriangleMesh{},                                  0,    0,    0,     0,   0,     false, false, 0.0}),
    [](const auto& test) { return std::string(test.param.name); });
// clang-format on

TEST(MeshReport, SaysNothingOfASolidAndOneSentenceForEachFinding) {
    EXPECT_THAT(checkMesh(kCube).findings(), IsEmpty());
    EXPECT_THAT(checkMesh(without(kCube, 0)).findings(), ElementsAre(HasSubstr("3 edges have")));
    EXPECT_THAT(checkMesh(turned(kCube)).findings(), ElementsAre(HasSubstr("1 piece is inside out")));
    EXPECT_THAT(checkMesh(TriangleMesh{}).findings(), ElementsAre(HasSubstr("no triangles")));
}

TEST(MeshReport, RefusesAnIndexThatIsNotThere) {
    TriangleMesh mesh = kCube;
    mesh.triangles[5].y = 8;
    EXPECT_THROW((void)checkMesh(mesh), InvalidInput);
    EXPECT_THROW((void)countSelfIntersections(mesh), InvalidInput);
}

TEST(SelfIntersections, AreFoundBetweenNeighboursToo) {
    // Two triangles folded flat onto each other at their common edge, one of them smaller.
    const TriangleMesh folded{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.5F, 0}}, {{0, 1, 2}, {1, 0, 3}}};
    EXPECT_EQ(countSelfIntersections(folded), 1U);
    // The same opened by a hair.
    const TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.5F, 1e-6F}}, {{0, 1, 2}, {1, 0, 3}}};
    EXPECT_EQ(countSelfIntersections(open), 0U);
    // One common corner, and a cut across the other triangle.
    const TriangleMesh cut{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4F, 0.3F, -1}, {0.4F, 0.3F, 1}},
                           {{0, 1, 2}, {0, 3, 4}}};
    EXPECT_EQ(countSelfIntersections(cut), 1U);
}

TEST(SelfIntersections, CountPairsOfTwoCubesThatOverlap) {
    // Shifted along all axes by half: each cube's corner is inside the other, three faces of each cross.
    EXPECT_GT(countSelfIntersections(both(kCube, cubeAt({0.5F, 0.5F, 0.5F}, 1))), 6U);
    EXPECT_EQ(countSelfIntersections(both(kCube, kInner)), 0U);
}

TEST(SelfIntersections, StopCountingAHeapOfTriangles) {
    TriangleMesh heap;
    for (std::uint32_t i = 0; i < 3000; ++i) append(heap, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_EQ(countSelfIntersections(heap), kMaxIntersectionsCounted);
}

TEST(CheckMesh, FindsTheSharedModelsClosed) {
    const std::filesystem::path folder = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/meshes";
    if (!std::filesystem::exists(folder / "spot.obj")) GTEST_SKIP() << "no shared models here";
    const MeshReport spot = checkMesh(readMesh(folder / "spot.obj"));
    EXPECT_EQ(spot.triangles, 5856U);
    EXPECT_TRUE(spot.closed());
    EXPECT_TRUE(spot.manifold());
    EXPECT_GT(spot.volume, 0.0);
    const MeshReport rocker = checkMesh(readMesh(folder / "rocker-arm.obj"));
    EXPECT_EQ(rocker.triangles, 20088U);
    EXPECT_TRUE(rocker.closed());
    EXPECT_TRUE(rocker.manifold());
}

} // namespace
} // namespace lumorph
