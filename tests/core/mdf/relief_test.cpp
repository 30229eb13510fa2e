#include "core/mdf/relief.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

class ReliefTest : public testing::Test {
protected:
    ReliefTest()
        : rig_(test::cushionRig()), field_(buildField(rig_, options())), coverage_(rig_, field_.frame, field_.levels),
          voting_(field_), room_(reliefRoom(field_).value()) {}
    static BuildOptions options() {
        BuildOptions o;
        o.resolution = 14;
        o.levels = 11;
        o.samples = 30;
        return o;
    }
    Rig rig_;
    Field field_;
    Coverage coverage_;
    Voting voting_;
    ReliefRoom room_;
};

/// Rows of hills, a metre high over the unit square; open at the bottom.
TriangleMesh hills(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    constexpr std::uint32_t n = 12;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            mesh.positions.emplace_back(static_cast<float>(i) / (n - 1), unit(random), static_cast<float>(j) / (n - 1));
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t a = j * n + i;
            mesh.triangles.emplace_back(a, a + n, a + 1);
            mesh.triangles.emplace_back(a + 1, a + n, a + n + 1);
        }
    return mesh;
}

/// The highest point of the mesh over a place, by every triangle; -1e9 beside it.
double topAt(const TriangleMesh& mesh, double x, double z) {
    double top = -1e9;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
        if (area == 0.0) continue;
        const double u = ((x - a.x) * (c.z - a.z) - (c.x - a.x) * (z - a.z)) / area;
        const double v = ((b.x - a.x) * (z - a.z) - (x - a.x) * (b.z - a.z)) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        top = std::max(top, a.y + u * (b.y - a.y) + v * (c.y - a.y));
    }
    return top;
}

int heightOf(const BitColumns& bits, int x, int z) {
    for (int y = bits.dimensions().y - 1; y >= 0; --y)
        if (bits.test(x, y, z)) return y + 1;
    return 0;
}

TEST_F(ReliefTest, WhatIsHigherStaysHigherAndTheRoomIsUsed) {
    for (const unsigned seed : {5U, 61U, 907U}) {
        const TriangleMesh mesh = placed(hills(seed), reliefPlacement(room_, hills(seed), 1)); // its top up
        BitColumns bits;
        voxelizeRelief(room_, mesh.positions, mesh.triangles, bits);
        struct Column {
            double top;
            int height;
        };
        std::vector<Column> columns;
        for (int z = 0; z < field_.frame.dimensions.z; ++z)
            for (int x = 0; x < field_.frame.dimensions.x; ++x) {
                const glm::dvec3 at = field_.frame.centre(x, 0, z);
                const double top = topAt(mesh, at.x, at.z);
                if (top > -1e8) columns.push_back({top, heightOf(bits, x, z)});
                EXPECT_EQ(heightOf(bits, x, z) > 0, top > -1e8);
            }
        ASSERT_GT(columns.size(), 100U);
        std::ranges::sort(columns, {}, &Column::top);
        for (std::size_t k = 1; k < columns.size(); ++k) {
            if (columns[k].top <= columns[k - 1].top + field_.frame.voxelSize) continue;
            EXPECT_GE(columns[k].height, columns[k - 1].height) << seed;
        }
        const double lowest =
            static_cast<double>(field_.frame.origin.y) + columns.front().height * field_.frame.voxelSize;
        const double highest =
            static_cast<double>(field_.frame.origin.y) + columns.back().height * field_.frame.voxelSize;
        EXPECT_NEAR(highest, room_.top, field_.frame.voxelSize);
        EXPECT_GT(highest - lowest, 0.8 * static_cast<double>(room_.top - room_.rest));
    }
}

TEST_F(ReliefTest, AllBelowWhatIsSeenIsFilledFromTheRestSurfaceOn) {
    const TriangleMesh mesh = placed(hills(12), reliefPlacement(room_, hills(12), 1));
    BitColumns bits;
    voxelizeRelief(room_, mesh.positions, mesh.triangles, bits);
    const int rest = static_cast<int>(std::lround((room_.rest - field_.frame.origin.y) / field_.frame.voxelSize));
    for (int z = 0; z < field_.frame.dimensions.z; ++z)
        for (int x = 0; x < field_.frame.dimensions.x; ++x)
            for (int y = 0; y < field_.frame.dimensions.y; ++y)
                ASSERT_EQ(bits.test(x, y, z), y >= rest && y < heightOf(bits, x, z));
}

TEST_F(ReliefTest, EachPlacementLiesAlongTheAxesAndIsStretchedOverWhatMoves) {
    const TriangleMesh box = test::boxMesh({-0.3F, 2.0F, 1.0F}, {0.7F, 4.0F, 1.5F});
    const Placement front = reliefPlacement(room_, box, 0);
    EXPECT_LT(glm::distance(front.rotation() * glm::vec3(0, 0, 1), glm::vec3(0, 1, 0)), 1e-5F) << "its front is up";
    EXPECT_LT(glm::distance(front.rotation() * glm::vec3(0, 1, 0), glm::vec3(0, 0, -1)), 1e-5F)
        << "its top is away from who stands before it";
    std::vector<glm::quat> seen;
    for (int k = 0; k < kReliefPlacements; ++k) {
        const Placement at = reliefPlacement(room_, box, k);
        EXPECT_TRUE(at.relief);
        const Box stands = boundingBox(placed(box, at).positions);
        const glm::vec3 share = stands.size() / room_.reach.size();
        EXPECT_NEAR(std::max(share.x, share.z), 1.0F, 1e-3F);
        EXPECT_NEAR(stands.max.y, room_.top, 1e-4F);
        for (const glm::quat& other : seen) EXPECT_LT(std::abs(glm::dot(other, at.rotation())), 0.999F) << k;
        seen.push_back(at.rotation());
    }
}

// A tower is known again only when its heights are compressed.
TEST_F(ReliefTest, AutoPlaceTakesAReliefWhereNothingElseFits) {
    TriangleMesh tower = test::boxMesh({0, 0, 0}, {1.0F, 5.0F, 1.0F});
    append(tower, test::boxMesh({-1.0F, 0, -1.0F}, {0.0F, 9.0F, 0.0F}));
    const Target target = makeTarget(std::move(tower));
    AutoPlaceOptions options;
    const AutoPlacement plain = autoPlace(field_, coverage_, voting_, target, options);
    EXPECT_FALSE(plain.placement.relief);
    EXPECT_EQ(plain.iou, plain.iouPlain);
    options.relief = ReliefChoice::always;
    const AutoPlacement relief = autoPlace(field_, coverage_, voting_, target, options);
    EXPECT_TRUE(relief.placement.relief);
    for (const PlacementCandidate& one : relief.alternatives) EXPECT_TRUE(one.placement.relief);
    options.relief = ReliefChoice::automatic;
    const AutoPlacement chosen = autoPlace(field_, coverage_, voting_, target, options);
    EXPECT_EQ(chosen.placement.relief, plain.iou < 0.3 && relief.iou >= plain.iou + 0.1);
    // The reported IoU is that of the reported state against the relief.
    BitColumns wanted;
    const TriangleMesh mesh = placed(target.mesh, relief.placement);
    voxelizeRelief(room_, mesh.positions, mesh.triangles, wanted);
    wanted &= coverage_.domain();
    BitColumns covered;
    CoverageScratch scratch;
    coverage_.covered(relief.state, covered, scratch);
    EXPECT_NEAR(intersectionOverUnion(wanted, covered), relief.iou, 1e-12);
}

TEST(Relief, NeedsADeviceThatRises) {
    const Rig rig = test::cornersRig();
    BuildOptions built;
    built.resolution = 12;
    built.levels = 5;
    built.samples = 8;
    Field field = buildField(rig, built);
    EXPECT_TRUE(reliefRoom(field).has_value());
    for (ActuatorField& actuator : field.actuators) actuator = {actuator.name, {}, {}};
    EXPECT_FALSE(reliefRoom(field).has_value());
    const Target target = makeTarget(test::boxMesh({0, 0, 0}, {1, 1, 1}));
    AutoPlaceOptions options;
    options.relief = ReliefChoice::always;
    const Coverage coverage(rig, field.frame, field.levels);
    EXPECT_THROW((void)autoPlace(field, coverage, Voting(field), target, options), InvalidInput);
}

} // namespace
} // namespace lumorph
