#include "core/rig/shape_resolution.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/reference_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "core/rig/templates/sheet_outline.h"
#include "tests/core/rig/point_rig.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using testing::HasSubstr;

double physical(const ShapeResolution& resolution, std::string_view key) {
    return metricOf(resolution, key).physical.value();
}

/// A box of 10 x 20 cm whose lid slides up by 50 cm.
Rig liftedBox() {
    RigParts parts = test::pointParts({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {Slide{{0, 1, 0}, 0.0, 0.5}});
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.2F});
    parts.actuators[0].influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (parts.restMesh.positions[v].y > 0.05F) parts.actuators[0].influences.push_back({v, 1.0F});
    parts.actuators[0].maxVelocity = 4.0;
    return Rig(std::move(parts));
}

TEST(ShapeResolution, OfASlideFollowsFromItsMeasures) {
    ShapeResolutionOptions options;
    options.light = {0.001, 60.0, Angle::degrees(45.0)};
    const ShapeResolution resolution = shapeResolution(liftedBox(), options);
    ASSERT_EQ(resolution.metrics.size(), 10U);
    EXPECT_NEAR(physical(resolution, "area"), 0.02, 1e-8);
    EXPECT_NEAR(physical(resolution, "granularity"), 50.0, 1e-4);
    EXPECT_EQ(physical(resolution, "porosity"), 0.0);
    EXPECT_EQ(physical(resolution, "curvature"), 0.0);
    EXPECT_NEAR(physical(resolution, "amplitude"), 0.5, 1e-6);
    EXPECT_EQ(physical(resolution, "zeroCrossing"), 0.0);
    EXPECT_NEAR(physical(resolution, "closure"), 0.0, 1e-9);
    EXPECT_EQ(physical(resolution, "stretchability"), 0.0);
    // 1000 of the SG90's 1900 us turn it by 94.7 degrees, which lift the lid by 50 cm.
    const double turned = std::numbers::pi * 1000.0 / 1900.0;
    const double lever = 0.5 / turned;
    EXPECT_NEAR(physical(resolution, "strength"), 0.17652 / lever, 1e-4);
    EXPECT_NEAR(physical(resolution, "speed"), 0.5 * 4.0, 1e-5); // its own limit, 4 strokes a second
    ASSERT_EQ(resolution.loads.size(), 1U);
    EXPECT_NEAR(resolution.loads[0].torque, (0.5 + 2.4 * 0.02 * 9.80665) * lever, 1e-5);
    EXPECT_TRUE(resolution.loads[0].weak);
    EXPECT_EQ(resolution.loads[0].stronger, "MG996R");
    ASSERT_EQ(resolution.warnings.size(), 1U);
    EXPECT_THAT(resolution.warnings[0], HasSubstr("too weak for 'actuator 0'"));
}

TEST(ShapeResolution, JudgesAnActuatorByItsOwnServo) {
    RigParts parts = liftedBox().parts();
    parts.actuators[0].drive.servo = "DS3218";
    const ShapeResolution resolution = shapeResolution(Rig(parts));
    ASSERT_EQ(resolution.loads.size(), 1U);
    const ServoLoad& load = resolution.loads[0];
    EXPECT_EQ(load.servo, &servoType("DS3218"));
    EXPECT_FALSE(load.weak);
    // 1000 of its 2000 us turn it by 90 degrees.
    const double lever = 0.5 / (0.5 * std::numbers::pi);
    EXPECT_NEAR(load.torque, (0.5 + 2.4 * 0.02 * 9.80665) * lever, 1e-5);
    EXPECT_TRUE(resolution.warnings.empty());
    EXPECT_NEAR(servoAngle(parts.actuators[0], *load.servo).inDegrees(), 90.0, 1e-9);

    const ServoLoad alone = servoLoad(Rig(parts), 0, &servoType("SG90"));
    EXPECT_EQ(alone.servo, load.servo) << "its own comes first";
    EXPECT_EQ(alone.torque, load.torque);
    parts.actuators[0].drive.servo.clear();
    EXPECT_EQ(servoLoad(Rig(parts), 0).servo, &servoType("SG90"));
    EXPECT_TRUE(servoLoad(Rig(parts), 0).weak);
}

TEST(ShapeResolution, OfLightFollowsFromItsPixels) {
    ShapeResolutionOptions options;
    options.light = {0.001, 60.0, Angle::degrees(60.0)};
    const ShapeResolution resolution = shapeResolution(liftedBox(), options);
    const auto light = [&](std::string_view key) { return metricOf(resolution, key).withLight; };
    const auto together = [&](std::string_view key) { return metricOf(resolution, key).together.value(); };
    EXPECT_NEAR(light("area").value(), 0.02, 1e-8);
    EXPECT_NEAR(light("granularity").value(), 1e6, 1e-3);
    EXPECT_NEAR(together("granularity"), 1e6 + 50.0, 1.0);
    EXPECT_EQ(light("porosity").value(), 1.0);
    EXPECT_NEAR(light("curvature").value(), 500.0 * std::numbers::pi, 1e-6);
    EXPECT_NEAR(light("amplitude").value(), 0.05 * std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(together("amplitude"), 0.5 + 0.05 * std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(light("zeroCrossing").value(), 199.0, 1.0);
    EXPECT_NEAR(light("speed").value(), 12.0, 1e-5);
    // What is touched is not changed by light.
    for (const char* key : {"closure", "stretchability", "strength"}) {
        EXPECT_FALSE(light(key).has_value()) << key;
        EXPECT_EQ(together(key), physical(resolution, key)) << key;
    }
}

TEST(ShapeResolution, ABookClosesHalfWay) {
    const Rig book = rigOf(rigTemplate("book"), std::vector<TemplateChoice>{{"spine", 4.0}});
    const ShapeResolution resolution = shapeResolution(book);
    EXPECT_NEAR(physical(resolution, "closure"), 0.5, 0.01);
    EXPECT_NEAR(physical(resolution, "curvature"), 0.5 * std::numbers::pi / 0.02, 1e-6);
    EXPECT_EQ(physical(resolution, "zeroCrossing"), 0.0); // both leaves bend the same way
    // The sheet's top runs 1 mm inside the neutral surface, whose radius is 40 mm / pi.
    EXPECT_NEAR(physical(resolution, "stretchability"), std::numbers::pi / 40.0, 0.003);
}

TEST(ShapeResolution, CountsTheWavesOfASine) {
    constexpr int kWaves = 3;
    RigParts parts = test::pointParts({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {MorphTarget{"wave", {1.0F}, {{}}}});
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.12F, 0.02F, 0.12F}, 60);
    parts.actuators[0].influences.clear();
    auto& morph = std::get<MorphTarget>(parts.actuators[0].deformer);
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v) {
        const glm::vec3& p = parts.restMesh.positions[v];
        if (p.y < 0.01F) continue;
        parts.actuators[0].influences.push_back({v, 1.0F});
        const double phase = 2.0 * std::numbers::pi * kWaves * static_cast<double>(p.x) / 0.12;
        morph.displacements[0].emplace_back(0.0F, static_cast<float>(0.005 * std::sin(phase)), 0.0F);
    }
    const ShapeResolution resolution = shapeResolution(Rig(std::move(parts)));
    EXPECT_EQ(physical(resolution, "zeroCrossing"), 2 * kWaves - 1);
    // A sine of amplitude a and wave number k has the curvature a k^2 at its crest.
    const double k = 2.0 * std::numbers::pi * kWaves / 0.12;
    EXPECT_NEAR(physical(resolution, "curvature"), 0.005 * k * k, 0.1 * 0.005 * k * k);
}

TEST(ShapeResolution, SeesThroughAHole) {
    RigParts parts = liftedBox().parts();
    // A frame of four boxes around an opening of 4 x 4 in 10 x 10 cm.
    parts.restMesh = {};
    append(parts.restMesh, test::boxMesh({0, 0, 0}, {0.03F, 0.01F, 0.1F}));
    append(parts.restMesh, test::boxMesh({0.07F, 0, 0}, {0.1F, 0.01F, 0.1F}));
    append(parts.restMesh, test::boxMesh({0.03F, 0, 0}, {0.07F, 0.01F, 0.03F}));
    append(parts.restMesh, test::boxMesh({0.03F, 0, 0.07F}, {0.07F, 0.01F, 0.1F}));
    parts.actuators[0].influences = {{0, 1.0F}};
    std::get<Slide>(parts.actuators[0].deformer).max = 0.001;
    EXPECT_NEAR(physical(shapeResolution(Rig(std::move(parts))), "porosity"), 0.16, 0.01);
}

TEST(ShapeResolution, OfTheReferences) {
    const std::vector<Rig> rigs = referenceRigs();
    ASSERT_EQ(rigs.size(), 3U);
    EXPECT_EQ(rigs[0].name(), "phone");
    EXPECT_EQ(rigs[1].name(), "tablet");
    EXPECT_EQ(rigs[2].name(), "pins");
    const ShapeResolution tablet = shapeResolution(rigs[1]);
    EXPECT_TRUE(tablet.warnings.empty());
    EXPECT_NEAR(physical(shapeResolution(cutTabletRig()), "closure"), 0.5, 0.01); // both long edges upright
    const ShapeResolution pins = shapeResolution(rigs[2]);
    EXPECT_NEAR(physical(pins, "area"), 900 * 0.0047 * 0.0047, 1e-5);
    EXPECT_NEAR(physical(pins, "amplitude"), 0.1, 1e-5);
    EXPECT_GE(physical(pins, "zeroCrossing"), 28.0); // every second row raised
}

TEST(ShapeResolution, RefusesWhatIsNoNumber) {
    for (const double bad : {0.0, -1.0, std::nan(""), double{INFINITY}}) {
        ShapeResolutionOptions options;
        options.light.pixelPitch = bad;
        EXPECT_THROW((void)shapeResolution(liftedBox(), options), InvalidInput) << bad;
    }
    ShapeResolutionOptions steep;
    steep.light.elevation = Angle::degrees(90.0);
    EXPECT_THROW((void)shapeResolution(liftedBox(), steep), InvalidInput);
}

} // namespace
} // namespace lumorph
