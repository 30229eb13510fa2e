#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/triangle_mesh.h"
#include "core/voxels/height_grid.h"
#include "core/voxels/solid.h"
#include "tests/support/cgal_oracle.h"

namespace lumorph {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

HeightGrid gridOf(int columns, int rows, glm::dvec2 min, glm::dvec2 max, const auto& height) {
    HeightGrid grid{min, max, columns, rows, {}};
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            grid.heights.push_back(static_cast<float>(
                height(min.x + (max.x - min.x) * i / (columns - 1), min.y + (max.y - min.y) * j / (rows - 1))));
    return grid;
}

/// Bilinear interpolation by its definition, a weighted sum of all samples: the weight of each falls off evenly to its
/// neighbours. NaN wherever a corner of the cell around the place is NaN.
double literalHeight(const HeightGrid& grid, double x, double z) {
    if (x < grid.min.x || x > grid.max.x || z < grid.min.y || z > grid.max.y)
        return std::numeric_limits<double>::quiet_NaN();
    const double u = (x - grid.min.x) * (grid.columns - 1) / (grid.max.x - grid.min.x);
    const double v = (z - grid.min.y) * (grid.rows - 1) / (grid.max.y - grid.min.y);
    double sum = 0.0;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
            const double weight = std::max(0.0, 1.0 - std::abs(u - i)) * std::max(0.0, 1.0 - std::abs(v - j));
            if (weight > 0.0)
                sum += weight * static_cast<double>(grid.heights[static_cast<std::size_t>(j * grid.columns + i)]);
        }
    return sum;
}

TEST(HeightGrid, VoxelsAreThoseOfALiteralLoop) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 12; ++trial) {
        const VoxelFrame frame{
            {-0.05F, -0.01F, -0.04F}, 0.0017 + 0.002 * uniform(random), {23, trial % 2 ? 70 : 130, 31}};
        const glm::dvec3 top = frame.centre(0, frame.dimensions.y, 0);
        const HeightGrid grid = gridOf(9 + trial, 7, {-0.04 - 0.02 * uniform(random), -0.05 + 0.03 * uniform(random)},
                                       {0.01 + 0.03 * uniform(random), 0.03}, [&](double, double) {
                                           return random() % 20 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                                     : -0.03 + (top.y + 0.06) * uniform(random);
                                       });
        const double floor = -0.012 + 0.03 * uniform(random);
        BitColumns bits({3, 3, 3});
        bits.set(1, 1, 1);
        voxelizeHeights(frame, grid, floor, bits);
        ASSERT_EQ(bits.dimensions(), frame.dimensions);
        std::size_t filled = 0;
        for (int z = 0; z < frame.dimensions.z; ++z)
            for (int x = 0; x < frame.dimensions.x; ++x)
                for (int y = 0; y < frame.dimensions.y; ++y) {
                    const glm::dvec3 c = frame.centre(x, y, z);
                    const double height = literalHeight(grid, c.x, c.z);
                    const bool expected = !std::isnan(height) && c.y < height && c.y > floor;
                    ASSERT_EQ(bits.test(x, y, z), expected) << x << ' ' << y << ' ' << z;
                    filled += expected ? 1 : 0;
                }
        EXPECT_EQ(bits.count(), filled);
        EXPECT_GT(filled, 1000U);
    }
}

TEST(HeightGrid, HeightAtIsExactOnSamplesAndEmptyBeyond) {
    const HeightGrid grid = gridOf(4, 3, {0.0, 1.0}, {3.0, 3.0}, [](double x, double z) { return x * 10.0 + z; });
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(heightAt(grid, {i, 1.0 + j}), i * 10.0 + 1.0 + j);
    EXPECT_DOUBLE_EQ(heightAt(grid, {1.25, 2.5}), 15.0);
    for (const glm::dvec2& beyond : {glm::dvec2(-1e-9, 2.0), glm::dvec2(3.0 + 1e-9, 2.0), glm::dvec2(1.0, 0.999),
                                     glm::dvec2(1.0, 3.001), glm::dvec2(std::nan(""), 2.0)})
        EXPECT_TRUE(std::isnan(heightAt(grid, beyond)));
    HeightGrid hole = grid;
    hole.heights[5] = kNan; // sample (1, 1)
    EXPECT_TRUE(std::isnan(heightAt(hole, {0.1, 1.1})));
    EXPECT_TRUE(std::isnan(heightAt(hole, {1.9, 2.9})));
    EXPECT_DOUBLE_EQ(heightAt(hole, {2.5, 1.5}), 26.5);
}

/// The closed solid between a plane's piece above a rectangle and a level floor.
TriangleMesh prism(const HeightGrid& grid, double floor) {
    const auto corner = [&](int k, bool top) {
        const double x = k == 0 || k == 3 ? grid.min.x : grid.max.x;
        const double z = k < 2 ? grid.min.y : grid.max.y;
        return glm::vec3(x, top ? literalHeight(grid, x, z) : floor, z);
    };
    TriangleMesh mesh;
    for (int k = 0; k < 4; ++k) mesh.positions.push_back(corner(k, false));
    for (int k = 0; k < 4; ++k) mesh.positions.push_back(corner(k, true));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
    for (unsigned k = 0; k < 4; ++k) {
        const unsigned next = (k + 1) % 4;
        mesh.triangles.push_back({k, k + 4, next});
        mesh.triangles.push_back({next, k + 4, next + 4});
    }
    return mesh;
}

TEST(HeightGrid, PlanesFillWhatTheirClosedMeshFills) {
    const VoxelFrame frame{{-0.1F, 0.0F, -0.07F}, 0.0043, {47, 29, 33}};
    struct Case {
        double level, alongX, alongZ;
    };
    for (const Case& c : {Case{0.0601, 0.0, 0.0}, Case{0.0523, 0.21, 0.0}, Case{0.0655, -0.13, 0.27}}) {
        const HeightGrid grid = gridOf(21, 15, {-0.0833, -0.0611}, {0.0777, 0.0555},
                                       [&](double x, double z) { return c.level + c.alongX * x + c.alongZ * z; });
        const double floor = 0.0107;
        BitColumns bits;
        voxelizeHeights(frame, grid, floor, bits);
        const TriangleMesh mesh = prism(grid, floor);
        EXPECT_EQ(bits, voxelizeSolid(frame, mesh)) << c.level;
        EXPECT_GT(bits.count(), 5000U);
        const test::InsideOracle inside(mesh);
        for (int z = 0; z < frame.dimensions.z; z += 3)
            for (int x = 0; x < frame.dimensions.x; x += 3)
                for (int y = 0; y < frame.dimensions.y; ++y)
                    ASSERT_EQ(bits.test(x, y, z), inside(frame.centre(x, y, z))) << x << ' ' << y << ' ' << z;
    }
}

TEST(HeightGrid, RefusesWhatIsNoGrid) {
    const HeightGrid good = gridOf(4, 3, {0, 0}, {1, 1}, [](double, double) { return 0.5; });
    const VoxelFrame frame{{0, 0, 0}, 0.1, {10, 10, 10}};
    struct Case {
        const char* why;
        void (*spoil)(HeightGrid& grid);
    };
    const Case cases[] = {
        {"fewer than two", [](HeightGrid& g) { g.columns = 1; }},
        {"fewer than two", [](HeightGrid& g) { g.rows = -3; }},
        {"heights for", [](HeightGrid& g) { g.heights.pop_back(); }},
        {"heights for", [](HeightGrid& g) { g.heights.clear(); }},
        {"at most", [](HeightGrid& g) { g.columns = g.rows = 1 << 30; }},
        {"rectangle", [](HeightGrid& g) { g.max.x = g.min.x; }},
        {"rectangle", [](HeightGrid& g) { g.min.y = std::nan(""); }},
        {"rectangle", [](HeightGrid& g) { g.max.y = HUGE_VAL; }},
        {"infinite", [](HeightGrid& g) { g.heights[7] = -HUGE_VALF; }},
    };
    BitColumns bits;
    for (const Case& c : cases) {
        HeightGrid grid = good;
        c.spoil(grid);
        try {
            voxelizeHeights(frame, grid, 0.0, bits);
            ADD_FAILURE() << c.why;
        } catch (const InvalidInput& error) {
            EXPECT_NE(error.why().find(c.why), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(voxelizeHeights(frame, good, std::nan(""), bits), InvalidInput);
    HeightGrid huge = good;
    for (float& height : huge.heights) height = 3e38F;
    voxelizeHeights(frame, huge, -3e38, bits);
    EXPECT_EQ(bits.count(), 1000U);
}

/// In numbers that are exact: a centre at the very height or floor lies neither below nor above it.
TEST(HeightGrid, CentresOnAHeightOrOnTheFloorDoNotCount) {
    const VoxelFrame frame{{0.0F, 0.0F, 0.0F}, 0.25, {3, 8, 3}};
    BitColumns bits;
    for (int floor = 0; floor < 8; ++floor)
        for (int height = 0; height < 8; ++height) {
            const auto top = static_cast<float>(0.125 + 0.25 * height); // of voxel `height`, its centre
            const HeightGrid grid = gridOf(4, 4, {-1.0, -1.0}, {2.0, 2.0}, [&](double, double) { return top; });
            voxelizeHeights(frame, grid, 0.125 + 0.25 * floor, bits);
            for (int y = 0; y < 8; ++y)
                ASSERT_EQ(bits.test(1, y, 1), y > floor && y < height) << floor << " to " << height << ": " << y;
        }
}

TEST(HeightGrid, TakesFarLessThanAMillisecond) {
    const VoxelFrame frame{{-0.1245F, 0.0F, -0.0885F}, 0.003, {83, 33, 59}};
    const HeightGrid grid = gridOf(210, 150, {-0.1245, -0.0885}, {0.1245, 0.0885}, [](double x, double z) {
        return 0.05 + 0.03 * std::sin(40.0 * x) * std::cos(30.0 * z);
    });
    BitColumns bits;
    double best = HUGE_VAL;
    for (int k = 0; k < 50; ++k) {
        const auto start = std::chrono::steady_clock::now();
        voxelizeHeights(frame, grid, 0.02, bits);
        best =
            std::min(best, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    RecordProperty("microseconds", static_cast<int>(std::lround(best)));
    EXPECT_LT(best, 1000.0);
    EXPECT_GT(bits.count(), 10'000U);
}

} // namespace
} // namespace lumorph
