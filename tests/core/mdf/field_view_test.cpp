#include "core/mdf/field_view.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

/// Level at which any of some actuators first covers a voxel; 255 for never.
int firstLevel(const std::vector<std::vector<Ramp>>& ramps, std::size_t voxel, std::optional<std::size_t> actuator) {
    int level = kUnchanged;
    for (std::size_t i = 0; i < ramps.size(); ++i)
        if (!actuator || *actuator == i) level = std::min<int>(level, ramps[i][voxel].v0);
    return level;
}

class FieldViewTest : public testing::Test {
protected:
    void SetUp() override {
        BuildOptions options;
        options.resolution = 20;
        options.levels = 9;
        options.samples = 32;
        field_ = buildField(test::cushionRig(), options);
        for (std::size_t i = 0; i < field_.actuators.size(); ++i) dense_.push_back(denseRamps(field_, i));
    }

    template <typename Visit> void eachVoxel(Visit&& visit) const {
        const glm::ivec3 size = field_.frame.dimensions;
        for (int z = 0; z < size.z; ++z)
            for (int x = 0; x < size.x; ++x)
                for (int y = 0; y < size.y; ++y) visit(glm::ivec3(x, y, z), field_.voxelIndex(x, y, z));
    }

    [[nodiscard]] bool shown(const glm::ivec3& v, const FieldViewOptions& o) const {
        if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, field_.frame.dimensions)))
            return false;
        const int level = firstLevel(dense_, field_.voxelIndex(v.x, v.y, v.z), o.actuator);
        return level != kUnchanged && level >= o.lowestLevel && level <= o.highestLevel &&
               glm::all(glm::greaterThanEqual(v, o.sliceFrom)) && glm::all(glm::lessThanEqual(v, o.sliceTo)) &&
               (!o.touchedBy || o.touchedBy->test(v.x, v.y, v.z));
    }

    Field field_;
    std::vector<std::vector<Ramp>> dense_;
};

// R14
TEST_F(FieldViewTest, ShowsWhatPlainLoopsShow) {
    BitColumns target(field_.frame.dimensions);
    eachVoxel([&](const glm::ivec3& v, std::size_t) {
        if ((v.x + v.y + 2 * v.z) % 3 != 0 && v.x > 5) target.set(v.x, v.y, v.z);
    });
    const FieldViewOptions views[] = {
        {},
        {.surfaceOnly = false},
        {.actuator = 1, .surfaceOnly = false},
        {.actuator = 0},
        {.lowestLevel = 2, .highestLevel = 5},
        {.sliceFrom = {3, 2, 7}, .sliceTo = {30, 60, 9}},
        {.sliceFrom = {-5, -5, 7}, .sliceTo = {9999, 9999, 7}},
        {.sliceFrom = {9, 0, 0}, .sliceTo = {8, 9, 9}},
        {.touchedBy = &target},
        {.actuator = 2, .lowestLevel = 1, .touchedBy = &target, .surfaceOnly = false},
    };
    for (const FieldViewOptions& o : views) {
        std::vector<FieldVoxel> expected;
        eachVoxel([&](const glm::ivec3& v, std::size_t index) {
            if (!shown(v, o)) return;
            bool buried = o.surfaceOnly;
            for (int axis = 0; axis < 3; ++axis)
                for (const int way : {-1, 1}) {
                    glm::ivec3 next = v;
                    next[axis] += way;
                    buried = buried && shown(next, o);
                }
            if (!buried) expected.push_back({v, firstLevel(dense_, index, o.actuator)});
        });
        const std::vector<FieldVoxel> voxels = fieldVoxels(field_, o);
        ASSERT_EQ(voxels.size(), expected.size());
        for (std::size_t i = 0; i < voxels.size(); ++i) {
            ASSERT_EQ(voxels[i].voxel, expected[i].voxel);
            ASSERT_EQ(voxels[i].level, expected[i].level);
        }
    }
    EXPECT_GT(fieldVoxels(field_, {.surfaceOnly = false}).size(), fieldVoxels(field_, {}).size());
}

TEST_F(FieldViewTest, LevelSurfaceIsClosedAndHoldsTheCoveredVolume) {
    for (const std::optional<std::size_t> actuator : {std::optional<std::size_t>(), std::optional<std::size_t>(1)})
        for (const int level : {3, 6, 8}) {
            const TriangleMesh surface = levelSurface(field_, actuator, level);
            std::size_t covered = 0;
            double soft = 0.0; // expected volume of the voxels on the border, in voxels
            eachVoxel([&](const glm::ivec3&, std::size_t v) {
                double most = 0.0;
                for (std::size_t i = 0; i < dense_.size(); ++i)
                    if ((!actuator || *actuator == i) && dense_[i][v].v0 != kUnchanged)
                        most = std::max(most, expectationAt(dense_[i][v], level));
                covered += most >= 0.5;
                soft += most;
            });
            ASSERT_GT(covered, 100U);
            const MeshReport report = checkMesh(surface);
            EXPECT_TRUE(report.closed());
            EXPECT_TRUE(report.manifold());
            EXPECT_EQ(report.degenerateTriangles, 0U);
            EXPECT_EQ(report.selfIntersections, 0U);
            EXPECT_EQ(report.inwardComponents, 0U);
            const double volume = static_cast<double>(covered) * field_.frame.voxelVolume();
            EXPECT_NEAR(report.volume, volume, 0.15 * volume) << "level " << level << ", expected " << soft;
        }
}

// A block of voxels has a surface half a voxel outside the outer centres, with its edges cut.
TEST(LevelSurface, OfABlockLiesBetweenVoxels) {
    Field field;
    field.frame = {glm::vec3(1.0F, 2.0F, 3.0F), 0.5, {6, 7, 8}};
    field.levels = 5;
    field.body = BitColumns(field.frame.dimensions);
    field.background.assign(field.frame.voxelCount(), 0);
    ActuatorField actuator;
    for (int z = 0; z < 5; ++z)
        for (int x = 1; x < 5; ++x) {
            actuator.runs.push_back({static_cast<std::uint32_t>(field.body.columnIndex(x, z)), 2, 5,
                                     static_cast<std::uint32_t>(actuator.ramps.size())});
            actuator.ramps.insert(actuator.ramps.end(), 5, Ramp{2, 2, 0, 255});
        }
    field.actuators = {actuator};
    EXPECT_TRUE(levelSurface(field, 0, 1).empty());
    const TriangleMesh surface = levelSurface(field, {}, 2);
    const Box box = boundingBox(surface.positions);
    EXPECT_EQ(box.min, glm::vec3(1.5F, 3.0F, 3.0F)); // also where it meets the frame
    EXPECT_EQ(box.max, glm::vec3(3.5F, 5.5F, 5.5F));
    EXPECT_TRUE(checkMesh(surface).solid());
    const double whole = 4 * 5 * 5 * 0.125;
    EXPECT_LT(signedVolume(surface), whole);
    EXPECT_GT(signedVolume(surface), 0.85 * whole);
}

TEST_F(FieldViewTest, RampsOfAVoxelAreThoseOfTheField) {
    std::size_t changed = 0;
    eachVoxel([&](const glm::ivec3& v, std::size_t index) {
        const auto ramps = rampsAt(field_, v);
        ASSERT_EQ(ramps.size(), dense_.size());
        for (std::size_t i = 0; i < ramps.size(); ++i) {
            ASSERT_EQ(ramps[i].size(), 9U);
            const Ramp& ramp = dense_[i][index];
            changed += ramp.v0 != kUnchanged;
            for (int level = 0; level < 9; ++level)
                ASSERT_EQ(ramps[i][static_cast<std::size_t>(level)],
                          ramp.v0 == kUnchanged ? field_.background[index] / 255.0 : expectationAt(ramp, level));
        }
    });
    EXPECT_GT(changed, 1000U);
}

TEST_F(FieldViewTest, WhatIsNotThereIsRefused) {
    const glm::ivec3 size = field_.frame.dimensions;
    EXPECT_THROW((void)rampsAt(field_, {-1, 0, 0}), InvalidInput);
    EXPECT_THROW((void)rampsAt(field_, {0, size.y, 0}), InvalidInput);
    EXPECT_THROW((void)levelSurface(field_, 3, 1), InvalidInput);
    EXPECT_THROW((void)levelSurface(field_, {}, 9), InvalidInput);
    EXPECT_THROW((void)levelSurface(field_, {}, -1), InvalidInput);
    EXPECT_THROW((void)fieldVoxels(field_, {.actuator = 3}), InvalidInput);
    const BitColumns other(size + 1);
    EXPECT_THROW((void)fieldVoxels(field_, {.touchedBy = &other}), InvalidInput);
}

} // namespace
} // namespace lumorph
