#include "core/rig/sheet/levered_sheet.h"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/rig/sheet/small_sheet.h"

namespace lumorph {
namespace {

LeveredSheet leveredSheet(const ElasticSheet& sheet, double edgeLength) {
    return {sheet, meshSheet(sheet, edgeLength)};
}

TEST(LeveredSheet, LiftsItsLinesToTheirHeights) {
    const ElasticSheet sheet = smallSheet();
    LeveredSheet levered = leveredSheet(sheet, 0.008);
    const std::array strokes{0.3, 1.0};
    const SheetPose pose = levered.followed(strokes);
    for (std::size_t l = 0; l < 2; ++l)
        for (const std::uint32_t node : levered.mesh().lineNodes[l])
            EXPECT_NEAR(pose.state.positions[node].y, sheet.levers[l].heightAt(strokes[l]), 1e-12);
    EXPECT_NEAR(sheet.levers[1].heightAt(1.0), 0.02, 1e-12);
    EXPECT_DOUBLE_EQ(sheet.levers[1].heightAt(0.0), 0.0);
}

TEST(LeveredSheet, ForceIsTheSlopeOfTheEnergyOverTheHeight) {
    const ElasticSheet sheet = smallSheet();
    LeveredSheet levered = leveredSheet(sheet, 0.01);
    const auto at = [&](double stroke) { return levered.followed(std::array{0.4, stroke}); };
    const SheetPose pose = at(0.6);
    const double slope =
        (at(0.61).energy - at(0.59).energy) / (sheet.levers[1].heightAt(0.61) - sheet.levers[1].heightAt(0.59));
    EXPECT_NEAR(pose.loads[1].force, slope, 1e-3 * slope);
    EXPECT_NEAR(pose.loads[1].torque, pose.loads[1].force * 0.026 * std::cos(sheet.levers[1].angleAt(0.6)), 1e-12);
}

TEST(LeveredSheet, MirroredStrokesGiveTheMirrorImage) {
    LeveredSheet levered = leveredSheet(smallSheet(), 0.01);
    const SheetPose one = levered.followed(std::array{1.0, 0.5});
    const SheetPose other = levered.followed(std::array{0.5, 1.0});
    const SheetState image = mirrored(levered.mesh(), levered.mesh().mirrors[0], one.state);
    for (std::size_t k = 0; k < image.positions.size(); ++k)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(image.positions[k][axis], other.state.positions[k][axis], 1e-6);
}

TEST(LeveredSheet, NothingSinksBelowWhereItRests) {
    const SheetPose pose = leveredSheet(smallSheet(), 0.008).followed(std::array{1.0, 0.0});
    for (const glm::dvec3& p : pose.state.positions) EXPECT_GT(p.y, -2e-4);
}

TEST(LeveredSheet, AgreesWithAMeshTwiceAsFine) {
    const std::array strokes{1.0, 1.0};
    LeveredSheet coarse = leveredSheet(smallSheet(), 0.005);
    LeveredSheet fine = leveredSheet(smallSheet(), 0.0025);
    const SheetPose a = coarse.followed(strokes, 1);
    const SheetPose b = fine.followed(strokes, 1);
    EXPECT_NEAR(a.energy, b.energy, 0.05 * b.energy);
    EXPECT_NEAR(a.loads[0].force, b.loads[0].force, 0.05 * b.loads[0].force);
}

TEST(LeveredSheet, LeversThatPullAgainstEachOtherAreNamed) {
    ElasticSheet sheet = smallSheet();
    sheet.levers[0] = {"rim", {0.056, -0.01}, {0.056, 0.01}, 0.026, Angle::degrees(40.0), Angle::degrees(-40.0)};
    LeveredSheet levered = leveredSheet(sheet, 0.01);
    try {
        (void)levered.followed(std::array{1.0, 1.0});
        ADD_FAILURE();
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("'rim'"), testing::HasSubstr("'right'")));
    }
    EXPECT_THROW((void)levered.followed(std::array{1.0}), InvalidInput);
    EXPECT_THROW((void)levered.followed(std::array{1.0, 1.5}), InvalidInput);
}

} // namespace
} // namespace lumorph
