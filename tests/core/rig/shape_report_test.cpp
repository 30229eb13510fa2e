#include "core/rig/shape_report.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rig/templates/bundled_rigs.h"
#include "tests/core/rig/point_rig.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ShapeReport, TheTabletIsSound) {
    const ShapeReport report = shapeReport(cutTabletRig(), 8, 1);
    EXPECT_THAT(report.warnings, IsEmpty()) << testing::PrintToString(report.warnings);
    EXPECT_EQ(report.sampledStates, 8);
    EXPECT_EQ(report.openStates + report.intersectingStates + report.invertedStates, 0);
    EXPECT_LT(report.pathOutsideShare, 0.002);
    ASSERT_EQ(report.actuators.size(), 6U);
    EXPECT_EQ(report.actuators[4].deformer, "bend");
    EXPECT_EQ(report.actuators[4].unit, "rad");
    EXPECT_NEAR(report.actuators[4].rangeMax, std::numbers::pi / 2.0, 1e-12);
    EXPECT_NEAR(report.actuators[4].maxCurvature, std::numbers::pi / 2.0 / 0.02, 1e-9);
    EXPECT_NEAR(report.actuators[4].fullStrokeSeconds, 0.75, 1e-9);
    // The tip of an edge flap goes round a quarter of a circle of about 63 mm: its chord is how far it gets.
    EXPECT_NEAR(report.actuators[4].amplitude, 0.063 * std::numbers::sqrt2, 0.003);
    EXPECT_GT(report.area, 0.015);
    EXPECT_LT(report.area, 0.21 * 0.15 * 1.2);
    EXPECT_NEAR(report.granularity, 6.0 / report.area, 1e-9);
    EXPECT_GT(report.volumeMax, 1.2 * report.volumeMin);
    // The sheet's top runs 1 mm inside the neutral surface, whose radius is 40 mm / pi at full stroke.
    EXPECT_NEAR(report.maxStretch, std::numbers::pi / 40.0, 0.003);
}

TEST(ShapeReport, AmplitudeIsTheFarthestFromRestAndNotTheWayRound) {
    const struct {
        double degrees, farthest;
    } kTurns[] = {
        {60.0, 0.1},                       // an equilateral triangle
        {90.0, 0.1 * std::numbers::sqrt2}, //
        {180.0, 0.2},                      //
        {270.0, 0.2},                      // halfway it is farther than at full stroke; 168.75 degrees are looked at
    };
    for (const auto& turn : kTurns) {
        const Rig rig(test::pointParts({{0.1F, 0, 0}, {0.02F, 0, 0}, {0, 0, 0.03F}},
                                       {Hinge{{}, {0, 1, 0}, Angle(), Angle::degrees(turn.degrees)}}));
        EXPECT_NEAR(amplitudeOf(rig, 0), turn.farthest, 0.001) << turn.degrees;
        EXPECT_EQ(shapeReport(rig, 1, 1).actuators[0].amplitude, amplitudeOf(rig, 0));
    }
}

TEST(ShapeReport, MeasuresWhatASlideDoes) {
    RigParts parts = test::pointParts({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {Slide{{0, 1, 0}, 0.0, 0.5}});
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.2F});
    parts.actuators[0].influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (parts.restMesh.positions[v].y > 0.05F) parts.actuators[0].influences.push_back({v, 1.0F});
    parts.actuators[0].maxVelocity = 4.0;
    const ShapeReport report = shapeReport(Rig(std::move(parts)), 1, 1); // full stroke alone
    EXPECT_NEAR(report.actuators[0].amplitude, 0.5, 1e-6);
    EXPECT_EQ(report.actuators[0].unit, "m");
    EXPECT_EQ(report.actuators[0].vertices, 4U);
    EXPECT_EQ(report.actuators[0].maxCurvature, 0.0);
    EXPECT_NEAR(report.actuators[0].fullStrokeSeconds, 0.25, 1e-12);
    EXPECT_NEAR(report.actuators[0].sweptArea, 0.1 * 0.2 + 0.5 * 2.0 * 0.1 * (0.1 + 0.2),
                1e-6); // top and half the sides
    EXPECT_NEAR(report.volumeMin, 0.1 * 0.1 * 0.2, 1e-8);
    EXPECT_NEAR(report.volumeMax, 0.6 * 0.1 * 0.2, 1e-8);
    EXPECT_EQ(report.maxStretch, 0.0); // the sides grow, the top that shows does not
    EXPECT_EQ(report.pathOutsideShare, 0.0);
}

TEST(ShapeReport, MeasuresHowFarTheTopStretches) {
    RigParts parts = test::pointParts({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {Slide{{1, 0, 0}, 0.0, 0.05}});
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.2F});
    parts.actuators[0].influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (parts.restMesh.positions[v].x > 0.05F) parts.actuators[0].influences.push_back({v, 1.0F});
    EXPECT_NEAR(shapeReport(Rig(std::move(parts)), 1, 1).maxStretch, 0.5, 1e-5); // 0.1 m wide becomes 0.15 m
}

TEST(ShapeReport, TellsThatASweepingArmLeavesItsPath) {
    const ShapeReport honest = shapeReport(test::armRig(), 4, 1);
    EXPECT_GT(honest.pathOutsideShare, 0.1);
    RigParts parts = test::armRig().parts();
    parts.pathInside = true;
    EXPECT_THAT(shapeReport(Rig(std::move(parts)), 4, 1).warnings, testing::Contains(HasSubstr("claims")));
}

// R42: what a device cannot do is said, not hidden.
TEST(ShapeReport, WarnsOfWhatIsWrong) {
    RigParts parts =
        test::pointParts({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {Slide{{0, -1, 0}, 0.0, 0.3}, Slide{{0, 1, 0}, 0.0, 0.1}});
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F});
    parts.actuators[0].influences.clear();
    parts.actuators[1].influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (parts.restMesh.positions[v].y > 0.05F) parts.actuators[0].influences.push_back({v, 1.0F});
    const ShapeReport turned = shapeReport(Rig(parts), 1, 1); // the lid is pushed out through the bottom
    EXPECT_EQ(turned.invertedStates, 1);
    EXPECT_THAT(turned.warnings, testing::Contains(HasSubstr("inside out")));
    EXPECT_THAT(turned.warnings, testing::Contains(HasSubstr("\"actuator 1\" moves nothing")));
    parts.restMesh.triangles.pop_back();
    const ShapeReport open = shapeReport(Rig(parts), 2, 1);
    EXPECT_EQ(open.openStates, 2);
    EXPECT_THAT(open.warnings, testing::Contains(HasSubstr("not closed")));
}

TEST(ShapeReport, IsTheSameForTheSameSeedAndCanBeStopped) {
    const ShapeReport a = shapeReport(ribbonRig(), 5, 7);
    const ShapeReport b = shapeReport(ribbonRig(), 5, 7);
    EXPECT_EQ(a.volumeMax, b.volumeMax);
    EXPECT_EQ(a.maxStretch, b.maxStretch);
    EXPECT_GT(a.actuators[0].maxCurvature, 1.0);
    EXPECT_GT(a.maxStretch, 0.001);
    std::stop_source stop;
    const Progress progress(
        [&](double fraction, std::string_view) {
            if (fraction > 0.3) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW((void)shapeReport(ribbonRig(), 100, 7, progress), Cancelled);
}

} // namespace
} // namespace lumorph
