#include "core/rig/rig_check.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Fault = RigFinding::Kind;

/// Adds a closed box all of which an actuator moves, or nobody.
void addBox(RigParts& parts, const glm::vec3& min, const glm::vec3& max, const Deformer* deformer = nullptr,
            const std::string& name = {}, double maxVelocity = 0.5) {
    const auto first = static_cast<std::uint32_t>(parts.restMesh.positions.size());
    append(parts.restMesh, test::boxMesh(min, max));
    if (!deformer) return;
    Actuator actuator;
    actuator.name = name;
    actuator.deformer = *deformer;
    actuator.maxVelocity = maxVelocity;
    for (std::uint32_t v = first; v < parts.restMesh.positions.size(); ++v) actuator.influences.push_back({v, 1.0F});
    parts.actuators.push_back(std::move(actuator));
}

Deformer turning(const glm::vec3& origin, const glm::vec3& axis, double degrees) {
    return Hinge{origin, axis, Angle(), Angle::degrees(degrees)};
}

/// A box whose side `axis` moves that way by `length`.
Rig growingBox(const glm::vec3& direction, double length, double maxVelocity = 0.5) {
    RigParts parts;
    parts.name = "box";
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.2F});
    Actuator actuator;
    actuator.name = "grow";
    actuator.deformer = Slide{direction, 0.0, length};
    actuator.maxVelocity = maxVelocity;
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (glm::dot(parts.restMesh.positions[v], glm::abs(direction)) > 0.05F)
            actuator.influences.push_back({v, 1.0F});
    parts.actuators.push_back(std::move(actuator));
    return Rig(std::move(parts));
}

bool crossesAt(const Rig& rig, std::vector<double> strokes, double by) {
    for (double& stroke : strokes) stroke = stroke > 0.0 ? std::clamp(stroke + by, 0.0, 1.0) : 0.0;
    return test::crossesItself(deformed(rig, strokes));
}

TEST(RigCheck, FindsNothingWrongWithTheBundledRigs) {
    for (const Rig& rig : {cutTabletRig(), bakedTablet(), pinDisplayRig(), ribbonRig(), hillsRig()}) {
        const auto start = std::chrono::steady_clock::now();
        const RigCheck check = checkRig(rig);
        std::printf("%s: %d levels, %d pairs, %d joint states in %.1f s\n", rig.name().c_str(), check.levelsLookedAt,
                    check.pairsLookedAt, check.jointStates,
                    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        for (const RigFinding& finding : check.findings) ADD_FAILURE() << rig.name() << ": " << finding.sentence;
        int levels = 0;
        for (const Actuator& actuator : rig.actuators()) levels += actuator.levels;
        EXPECT_EQ(check.levelsLookedAt, levels);
        EXPECT_GE(check.jointStates, 100);
    }
}

// Two posts whose upper inner edges touch when both have turned by asin(gap / 2 / height); neither reaches the other
// alone.
TEST(RigCheck, FindsWhereTwoFlapsCollide) {
    constexpr double kGap = 0.06;
    constexpr double kHeight = 0.05;
    RigParts parts;
    parts.name = "posts";
    const Deformer left = turning({-0.03F, 0, 0}, {0, 0, -1}, 50.0);
    const Deformer right = turning({0.03F, 0, 0}, {0, 0, 1}, 50.0);
    addBox(parts, {-0.034F, 0, -0.01F}, {-0.03F, kHeight, 0.01F}, &left, "left");
    addBox(parts, {0.03F, 0, -0.012F}, {0.034F, kHeight, 0.012F}, &right, "right");
    const Rig rig(parts);
    const RigCheck check = checkRig(rig);
    ASSERT_THAT(check.findings, SizeIs(1));
    const RigFinding& found = check.findings[0];
    EXPECT_EQ(found.kind, Fault::collision);
    EXPECT_THAT(found.actuators, ElementsAre(0U, 1U));
    const double degrees = std::asin(0.5 * kGap / kHeight) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(50.0 * found.first[0], degrees, 0.001);
    EXPECT_EQ(found.first[0], found.first[1]);
    EXPECT_FALSE(crossesAt(rig, found.first, -1e-4));
    EXPECT_TRUE(crossesAt(rig, found.first, 1e-4));
    EXPECT_TRUE(test::crossesItself(deformed(rig, found.worst)));
    EXPECT_NEAR(found.place.x, 0.0F, 0.005F) << "between the two";
    EXPECT_GT(found.amount, 0.02) << "their whole width at least";
    EXPECT_THAT(found.sentence, HasSubstr("'left' and 'right' collide"));
    EXPECT_THAT(found.sentence, HasSubstr("36.9 degrees"));
    EXPECT_THAT(found.remedy, HasSubstr("Narrow"));

    // With a range that ends before, there is nothing.
    for (Actuator& actuator : parts.actuators) std::get<Hinge>(actuator.deformer).max = Angle::degrees(36.8);
    EXPECT_THAT(checkRig(Rig(parts)).findings, IsEmpty());
}

// A flap 10 mm above a body: its lower edge, 60 mm from the hinge in it, meets the body's top at asin(10 / 60).
TEST(RigCheck, FindsAFlapThatTurnsIntoTheBody) {
    RigParts parts;
    parts.name = "box with a lid";
    addBox(parts, {0, 0, 0}, {0.1F, 0.03F, 0.08F});
    const Deformer down = turning({0, 0.04F, 0}, {0, 0, -1}, 30.0);
    addBox(parts, {0, 0.04F, 0.02F}, {0.06F, 0.042F, 0.05F}, &down, "lid");
    const Deformer up = turning({0.1F, 0.06F, 0}, {0, 0, 1}, 90.0);
    addBox(parts, {0.1F, 0.06F, 0}, {0.12F, 0.062F, 0.02F}, &up, "sound flap");
    const Rig rig(parts);
    const RigCheck check = checkRig(rig);
    ASSERT_THAT(check.findings, SizeIs(1));
    const RigFinding& found = check.findings[0];
    EXPECT_EQ(found.kind, Fault::collision);
    EXPECT_THAT(found.actuators, ElementsAre(0U));
    EXPECT_NEAR(30.0 * found.first[0], std::asin(10.0 / 60.0) * 180.0 / std::numbers::pi, 0.001);
    EXPECT_EQ(found.first[1], 0.0);
    EXPECT_FALSE(crossesAt(rig, found.first, -1e-4));
    EXPECT_TRUE(crossesAt(rig, found.first, 1e-4));
    EXPECT_NEAR(found.place.y, 0.03F, 0.01F) << "at the body's top";
    EXPECT_EQ(found.worst[0], 1.0) << "the deeper the longer where they meet";
    EXPECT_THAT(found.sentence,
                HasSubstr("'lid' runs into a part that stands still, from 9.6 degrees on (level 11 of"));
    EXPECT_THAT(found.remedy, HasSubstr("'lid' end at 9.6 degrees"));
}

TEST(RigCheck, FindsWhatStretchesBeyondTheMaterial) {
    const Rig rig = growingBox({1, 0, 0}, 0.05); // 0.1 m of top become 0.15 m
    EXPECT_THAT(checkRig(rig).findings, IsEmpty()) << "knitted fabric does that";
    RigCheckOptions cloth;
    cloth.maxStretch = 0.2;
    const RigCheck check = checkRig(rig, cloth);
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_EQ(check.findings[0].kind, Fault::stretch);
    EXPECT_NEAR(check.findings[0].first[0], 0.4, 1e-4);
    EXPECT_NEAR(check.findings[0].amount, 0.5, 1e-5);
    EXPECT_EQ(check.findings[0].limit, 0.2);
    EXPECT_NEAR(check.findings[0].place.x, 0.075F, 1e-4F);
    EXPECT_THAT(check.findings[0].sentence, HasSubstr("by up to 50 %, more than 20 %, from 20.0 mm on"));
    EXPECT_THAT(checkRig(growingBox({0, 1, 0}, 0.3, 0.1), cloth).findings, IsEmpty()) << "skirts stretch by design";
}

TEST(RigCheck, FindsWhatMovesFastEnoughToStartle) {
    const RigCheck slide = checkRig(growingBox({0, 1, 0}, 0.3, 1.5)); // 0.45 m/s
    ASSERT_THAT(slide.findings, SizeIs(1));
    EXPECT_EQ(slide.findings[0].kind, Fault::speed);
    EXPECT_NEAR(slide.findings[0].amount, 0.45, 1e-4);
    EXPECT_NEAR(slide.findings[0].place.y, 0.1F, 0.31F);
    EXPECT_THAT(slide.findings[0].remedy, HasSubstr("take 1.20 s or more"));

    RigParts parts; // the far corner of a flap goes round at radius x rate
    parts.name = "flap";
    const Deformer turn = turning({0, 0, 0}, {0, 0, 1}, 90.0);
    addBox(parts, {0, 0, 0}, {0.12F, 0.003F, 0.05F}, &turn, "flap", 2.0);
    const double speed = std::hypot(0.12, 0.003) * std::numbers::pi / 2.0 * 2.0;
    RigCheckOptions options;
    options.maxSpeed = 1.001 * speed;
    EXPECT_THAT(checkRig(Rig(parts), options).findings, IsEmpty());
    options.maxSpeed = 0.999 * speed;
    const RigCheck check = checkRig(Rig(parts), options);
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_NEAR(check.findings[0].amount, speed, 2e-4 * speed);
}

TEST(RigCheck, FindsWhatTurnsInsideOut) {
    // The lid of a box 0.1 m high goes down by 0.3 m: out through the bottom at a third.
    const RigCheck check = checkRig(growingBox({0, -1, 0}, 0.3));
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_EQ(check.findings[0].kind, Fault::inverted);
    EXPECT_NEAR(check.findings[0].first[0], 1.0 / 3.0, 1e-4);
    EXPECT_THAT(check.findings[0].sentence, HasSubstr("inside out"));
}

TEST(RigCheck, FindsASeamThatOpens) {
    // The lid has vertices of its own, at the same places as the walls', that alone move.
    RigParts parts = growingBox({0, 1, 0}, 0.02).parts();
    std::vector<Influence>& moved = parts.actuators[0].influences;
    const std::vector<Influence> walls = std::exchange(moved, {});
    std::vector<std::uint32_t> lid(parts.restMesh.positions.size());
    for (const Influence& one : walls) {
        lid[one.vertex] = static_cast<std::uint32_t>(parts.restMesh.positions.size());
        parts.restMesh.positions.push_back(parts.restMesh.positions[one.vertex]);
        moved.push_back({lid[one.vertex], 1.0F});
    }
    for (glm::uvec3& t : parts.restMesh.triangles) {
        bool top = true;
        for (int k = 0; k < 3; ++k) top = top && parts.restMesh.positions[t[k]].y > 0.05F;
        for (int k = 0; top && k < 3; ++k) t[k] = lid[t[k]];
    }
    ASSERT_TRUE(checkMesh(parts.restMesh).solid());
    const RigCheck check = checkRig(Rig(parts));
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_EQ(check.findings[0].kind, Fault::open);
    EXPECT_LT(check.findings[0].first[0], 1e-3);
    EXPECT_NEAR(check.findings[0].amount, 0.02, 1e-6);
}

TEST(RigCheck, FindsWhatThreeMakeTogetherAndNamesNobodyElse) {
    // A block that three slides push towards a wall 30 mm away, by 12 mm each; a fourth pushes something else.
    RigParts parts;
    parts.name = "three";
    addBox(parts, {0.07F, 0, 0}, {0.09F, 0.05F, 0.05F});
    const Deformer push = Slide{{1, 0, 0}, 0.0, 0.012};
    addBox(parts, {0.0F, 0, 0.01F}, {0.04F, 0.02F, 0.03F}, &push, "first");
    for (const char* name : {"second", "third"}) {
        parts.actuators.push_back(parts.actuators.front());
        parts.actuators.back().name = name;
    }
    addBox(parts, {0.0F, 0, 0.2F}, {0.04F, 0.02F, 0.23F}, &push, "elsewhere");
    const Rig rig(parts);
    const RigCheck check = checkRig(rig);
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_EQ(check.findings[0].kind, Fault::collision);
    EXPECT_THAT(check.findings[0].actuators, ElementsAre(0U, 1U, 2U));
    double pushed = 0.0;
    for (const double stroke : check.findings[0].first) pushed += 0.012 * stroke;
    EXPECT_NEAR(pushed, 0.03, 1e-6);
    EXPECT_EQ(check.findings[0].first[3], 0.0);
}

TEST(RigCheck, SaysOnceWhatIsWrongAtRest) {
    RigParts parts = growingBox({0, 1, 0}, 0.02).parts();
    append(parts.restMesh, test::boxMesh({0.05F, 0.02F, 0.05F}, {0.3F, 0.05F, 0.1F})); // sticks through the wall
    const RigCheck check = checkRig(Rig(parts));
    ASSERT_THAT(check.findings, SizeIs(1));
    EXPECT_EQ(check.findings[0].kind, Fault::crossing);
    EXPECT_THAT(check.findings[0].actuators, IsEmpty());
    EXPECT_NEAR(check.findings[0].place.x, 0.1F, 1e-4F);
    parts = growingBox({0, 1, 0}, 0.02).parts();
    parts.restMesh.triangles.pop_back();
    const RigCheck open = checkRig(Rig(parts));
    ASSERT_THAT(open.findings, SizeIs(1));
    EXPECT_EQ(open.findings[0].kind, Fault::open);
}

TEST(RigCheck, RefusesLimitsAndCanBeStopped) {
    RigCheckOptions options;
    options.maxSpeed = std::nan("");
    EXPECT_THROW((void)checkRig(ribbonRig(), options), InvalidInput);
    options = {};
    options.maxStretch = -0.1;
    EXPECT_THROW((void)checkRig(ribbonRig(), options), InvalidInput);
    std::stop_source stop;
    const Progress progress(
        [&](double fraction, std::string_view) {
            if (fraction > 0.2) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW((void)checkRig(test::cutTablet(), {}, progress), Cancelled);
}

TEST(MeshCheck, FindsTheSameCrossingsAmongPartsAsInTheWhole) {
    const TriangleMesh mesh = deformed(test::lifterRig(), std::vector<double>{0.9, 0.7, 0.5});
    std::vector<std::uint32_t> some, others;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) (t % 3 == 0 ? some : others).push_back(t);
    const auto count = [&](const auto& a, const auto& b) { return findCrossings(mesh, a, b, 100'000).size(); };
    const std::vector<std::uint32_t> none;
    EXPECT_EQ(count(some, others) + count(others, none), countSelfIntersections(mesh));
    EXPECT_GT(countSelfIntersections(mesh), 10U);
    EXPECT_EQ(findCrossings(mesh, some, others, 3).size(), 3U);
    // Where a box sticks through the top of another, at its height.
    TriangleMesh pierced = test::boxMesh({0, 0, 0}, {1, 1, 1});
    append(pierced, test::boxMesh({0.3F, 0.5F, 0.3F}, {0.6F, 1.5F, 0.6F}));
    std::vector<std::uint32_t> all(pierced.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    Box where;
    for (const TriangleCrossing& crossing : findCrossings(pierced, all, none, 1000)) where.include(crossing.where);
    EXPECT_NEAR(where.min.y, 1.0F, 1e-6F);
    EXPECT_NEAR(where.max.y, 1.0F, 1e-6F);
    EXPECT_NEAR(where.min.x, 0.3F, 1e-6F);
    EXPECT_NEAR(where.max.z, 0.6F, 1e-6F);
}

} // namespace
} // namespace lumorph
