#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/mesh_writers.h"
#include "tests/app/literal_eq1.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/support/small_rigs.h"

// R12: `lumorph voxelize --surface` writes the voxels that triangles meet.

namespace lumorph::test {
namespace {

/// The part of a polygon where `side` x (p[axis] - border) <= 0.
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& polygon, int axis, double border, double side) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
        const double beyondA = side * (a[axis] - border), beyondB = side * (b[axis] - border);
        if (beyondA <= 0.0) kept.push_back(a);
        if ((beyondA <= 0.0) != (beyondB <= 0.0)) kept.push_back(a + beyondA / (beyondA - beyondB) * (b - a));
    }
    return kept;
}

/// Whether something of a triangle is left when it is cut by the six planes of a cube.
bool meets(std::vector<glm::dvec3> polygon, const glm::dvec3& middle, double side) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double way : {-1.0, 1.0}) polygon = clipped(polygon, axis, middle[axis] + 0.5 * way * side, way);
    return !polygon.empty();
}

class VoxelizeSurface : public ::testing::Test {
protected:
    void SetUp() override {
        // The field's frame, from the header of a grid in it.
        const std::string header = surfaceOf(boxMesh({0.01F, 0.02F, 0.01F}, {0.06F, 0.03F, 0.07F})).header;
        const auto at = header.find("space directions: (");
        const auto origin = header.find("space origin: (");
        ASSERT_NE(at, std::string::npos);
        ASSERT_NE(origin, std::string::npos);
        ASSERT_EQ(std::sscanf(header.c_str() + at, "space directions: (%lf,", &side_), 1);
        ASSERT_EQ(std::sscanf(header.c_str() + origin, "space origin: (%lf,%lf,%lf)", &first_.x, &first_.y, &first_.z),
                  3);
    }
    [[nodiscard]] glm::dvec3 middleOf(int x, int y, int z) const { return first_ + side_ * glm::dvec3(x, y, z); }

    [[nodiscard]] LiteralGrid surfaceOf(const TriangleMesh& mesh) const {
        writeFile(w["mesh.obj"], writeObj(mesh));
        const Outcome outcome =
            lumorph({"voxelize", w["mesh.obj"], "--like", w["field.mdf"], "--surface", "-o", w["surface.nrrd"]});
        EXPECT_EQ(outcome.exitCode, 0);
        EXPECT_EQ(outcome.err, "") << "an open mesh is no fault here";
        return readLiteralGrid(w["surface.nrrd"]);
    }

    SmallWorkspace w;
    double side_ = 0.0;
    glm::dvec3 first_{}; ///< middle of the first voxel
};

TEST_F(VoxelizeSurface, OfABoxIsItsShellAndWithoutALidTheShellWithoutIt) {
    // From the middle of one voxel to the middle of another, so that rounding decides nothing.
    const glm::ivec3 low(3, 4, 5), high(9, 8, 11);
    TriangleMesh box = boxMesh(glm::vec3(middleOf(low.x, low.y, low.z)), glm::vec3(middleOf(high.x, high.y, high.z)));
    for (const bool lid : {true, false}) {
        if (!lid)
            std::erase_if(box.triangles, [&](const glm::uvec3& t) {
                const float top = static_cast<float>(middleOf(0, high.y, 0).y);
                return std::min({box.positions[t.x].y, box.positions[t.y].y, box.positions[t.z].y}) >= top;
            });
        ASSERT_EQ(box.triangles.size(), lid ? 12U : 10U);
        const LiteralGrid grid = surfaceOf(box);
        int wrong = 0;
        for (int z = 0; z < grid.size[2]; ++z)
            for (int y = 0; y < grid.size[1]; ++y)
                for (int x = 0; x < grid.size[0]; ++x) {
                    const glm::ivec3 at(x, y, z);
                    const bool within =
                        glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThanEqual(at, high));
                    const bool wall = x == low.x || x == high.x || z == low.z || z == high.z || y == low.y;
                    const bool expected = within && (wall || (lid && y == high.y));
                    wrong += grid.values[grid.index(x, y, z)] != (expected ? 1 : 0);
                }
        EXPECT_EQ(wrong, 0) << (lid ? "closed" : "open");
    }
}

TEST_F(VoxelizeSurface, OfLooseTrianglesIsWhatIsLeftOfThemInEachCube) {
    std::mt19937 random(12);
    std::uniform_real_distribution<float> place(-0.02F, 0.1F); // some reach beyond the frame
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 6; ++i) {
        for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(place(random), place(random), place(random));
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const LiteralGrid grid = surfaceOf(mesh);
    int set = 0, wrong = 0;
    for (int z = 0; z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y)
            for (int x = 0; x < grid.size[0]; ++x) {
                const bool expected = std::ranges::any_of(mesh.triangles, [&](const glm::uvec3& t) {
                    return meets({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]}, middleOf(x, y, z),
                                 side_);
                });
                set += expected;
                wrong += grid.values[grid.index(x, y, z)] != (expected ? 1 : 0);
            }
    EXPECT_GT(set, 200);
    EXPECT_EQ(wrong, 0);
}

TEST_F(VoxelizeSurface, FitsAndTellsOfAMeshThatIsElsewhere) {
    writeFile(w["far.obj"], writeObj(boxMesh({5.0F, 5.0F, 5.0F}, {6.0F, 5.5F, 6.0F})));
    const std::vector<std::string> far{"voxelize",  w["far.obj"], "--like",     w["field.mdf"],
                                       "--surface", "-o",         w["far.nrrd"]};
    const Outcome elsewhere = lumorph(far);
    EXPECT_EQ(elsewhere.exitCode, 0);
    EXPECT_THAT(elsewhere.err, ::testing::HasSubstr("--fit"));
    std::vector<std::string> fitted = far;
    fitted.emplace_back("--fit");
    EXPECT_EQ(lumorph(fitted).err, "");
    const LiteralGrid grid = readLiteralGrid(w["far.nrrd"]);
    EXPECT_GT(std::ranges::count(grid.values, 1), 100);
}

} // namespace
} // namespace lumorph::test
