#include "core/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/core/rig/point_rig.h"
#include "tests/core/rig/small_sheet.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/lifted_sheet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using test::pointParts;

std::vector<double> randomStrokes(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> strokes(count);
    for (double& stroke : strokes) stroke = uniform(random);
    return strokes;
}

/// Rigs of every kind of deformer, alone and one upon the other.
std::vector<Rig> allKinds() {
    const Bend bend{{0.0F, 0.01F, 0.0F}, {0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}, 0.03, Angle(), Angle::degrees(120.0)};
    const Hinge hinge{{0.02F, 0.0F, 0.0F}, {0.0F, 0.3F, 1.0F}, Angle(), Angle::degrees(70.0)};
    const Slide slide{{1.0F, 0.5F, 0.0F}, 0.0, 0.02};
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-0.05F, 0.08F);
    std::vector<glm::vec3> points(300);
    for (glm::vec3& p : points) p = {place(random), place(random), place(random)};
    MorphTarget morph{"m", {0.3F, 0.8F}, {points, points}};
    for (glm::vec3& d : morph.displacements[0]) d *= 0.1F;
    for (glm::vec3& d : morph.displacements[1]) d *= -0.2F;
    RigParts weighted = pointParts(points, {slide, hinge, bend, morph});
    for (Actuator& actuator : weighted.actuators)
        for (Influence& influence : actuator.influences) influence.weight = static_cast<float>(random() % 5) / 4.0F;
    return {test::cutTablet(),
            pinDisplayRig(),
            ribbonRig(),
            hillsRig(),
            test::cushionRig(),
            test::armRig(),
            test::lifterRig(),
            Rig(pointParts(points, {bend, hinge})),
            Rig(pointParts(points, {slide, bend})),
            Rig(pointParts(points, {morph, hinge, bend, slide})),
            Rig(std::move(weighted)),
            Rig(test::smallSheetParts()),
            Rig(test::liftedSheetParts())};
}

TEST(Rig, AtRestIsItsRestMeshBitForBit) {
    for (const Rig& rig : allKinds())
        EXPECT_EQ(deformed(rig, std::vector<double>(rig.actuatorCount(), 0.0)).positions, rig.restMesh().positions)
            << rig.name();
}

TEST(Rig, ListsAndSubsetsDeformAsTheWhole) {
    std::mt19937 random(7);
    for (const Rig& rig : allKinds()) {
        std::vector<std::uint32_t> list(rig.restMesh().positions.size());
        std::iota(list.begin(), list.end(), 0U);
        std::shuffle(list.begin(), list.end(), random);
        list.resize(list.size() / 3);
        list.push_back(list.front()); // a vertex may be listed twice
        const Rig::Subset subset = rig.subset(list);
        ASSERT_EQ(subset.size(), list.size());
        for (int state = 0; state < 10; ++state) {
            const auto strokes = randomStrokes(rig.actuatorCount(), random);
            const auto whole = deformed(rig, strokes).positions;
            std::vector<glm::vec3> listed(list.size());
            std::vector<glm::vec3> compiled(list.size());
            rig.deform(strokes, list, listed);
            subset.deform(strokes, compiled);
            for (std::size_t k = 0; k < list.size(); ++k) {
                ASSERT_EQ(listed[k], whole[list[k]]) << rig.name();
                ASSERT_EQ(compiled[k], whole[list[k]]) << rig.name();
            }
        }
    }
}

TEST(Rig, KnowsWhichActuatorMovesWhat) {
    std::mt19937 random(11);
    for (const Rig& rig : allKinds()) {
        if (rig.actuatorCount() > 10) continue;
        for (std::size_t a = 0; a < rig.actuatorCount(); ++a) {
            auto strokes = randomStrokes(rig.actuatorCount(), random);
            const auto before = deformed(rig, strokes).positions;
            strokes[a] = 0.9 * strokes[a] + 0.05;
            const auto after = deformed(rig, strokes).positions;
            const auto moved = rig.verticesOf(a);
            for (std::uint32_t v = 0; v < before.size(); ++v) {
                const auto known = rig.actuatorsOf(v);
                const bool listed = std::ranges::binary_search(moved, v);
                EXPECT_EQ(std::ranges::find(known, a) != known.end(), listed);
                if (!listed) {
                    EXPECT_EQ(before[v], after[v]) << rig.name() << ' ' << v;
                }
            }
        }
    }
}

// R7: the frame must hold every joint state.
TEST(Rig, ReachHoldsEveryJointState) {
    std::mt19937 random(3);
    for (const Rig& rig : allKinds()) {
        std::size_t outside = 0;
        std::vector<glm::vec3> positions(rig.restMesh().positions.size());
        const int states = rig.actuatorCount() > 10 ? 100 : 2000;
        for (int state = 0; state < states; ++state) {
            auto strokes = randomStrokes(rig.actuatorCount(), random);
            if (state % 4 == 0) // corners and edges of the space of states
                for (double& stroke : strokes) stroke = random() % 3 == 0 ? stroke : std::round(stroke);
            rig.deform(strokes, positions);
            for (std::uint32_t v = 0; v < positions.size(); ++v) {
                const Box& box = rig.reachOf(v);
                const glm::vec3& p = positions[v];
                for (int axis = 0; axis < 3; ++axis)
                    if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) ++outside;
            }
        }
        EXPECT_EQ(outside, 0U) << rig.name();
    }
}

/// A part that slides out of a joint that turns; between the steps of the search it swings the farther out, the farther
/// it has come. How a skin moves is tested in deformer_test.
TEST(Rig, ReachHoldsAPartThatSlidesOutOnATurningJoint) {
    for (const double length : {0.2, 1.0, 3.0})
        for (const glm::vec3& start : {glm::vec3(0.01F, 0.0F, 0.0F), {0.0F, 0.013F, 0.002F}}) {
            RigParts parts = pointParts({start, 1.5F * start, start + glm::vec3(0.0F, 0.0F, 0.003F)},
                                        {SkinJoint{0, SkinJoint::Motion::rotate, {0.1F, 0.2F, 1.0F}, -0.37, 5.1},
                                         SkinJoint{1, SkinJoint::Motion::translate, {1.0F, 0.1F, 0.0F}, 0.0, length}});
            Skeleton& skeleton = parts.skeleton.emplace();
            skeleton.joints = {{-1, glm::mat4(1.0F)},
                               {0, glm::translate(glm::mat4(1.0F), glm::vec3(0.005F, 0.0F, 0.0F))}};
            skeleton.vertexJoints.assign(3, {1, 0, 0, 0});
            skeleton.vertexWeights.assign(3, {1.0F, 0.0F, 0.0F, 0.0F});
            const Rig rig(std::move(parts));
            std::vector<glm::vec3> positions(3);
            float farthest = 0.0F;
            double beyond = 0.0;
            for (int turn = 0; turn <= 4000; ++turn)
                for (const double slide : {1.0, 0.99, 0.5, 0.0}) {
                    rig.deform(std::vector<double>{turn / 4000.0, slide}, positions);
                    for (std::uint32_t v = 0; v < 3; ++v) {
                        farthest = std::max(farthest, glm::length(positions[v]));
                        for (int axis = 0; axis < 3; ++axis) {
                            const double low = rig.reachOf(v).min[axis];
                            const double high = rig.reachOf(v).max[axis];
                            beyond = std::max({beyond, low - positions[v][axis], positions[v][axis] - high});
                        }
                    }
                }
            EXPECT_GT(farthest, 0.99 * length);
            EXPECT_LE(beyond, 0.0) << length << " m";
        }
}

TEST(Rig, ReachIsExactForSlides) {
    const Rig rig(pointParts({{0, 0, 0}, {0.1F, 0, 0}, {0, 0, 0.1F}}, {Slide{{0.0F, 2.0F, 0.0F}, 0.01, 0.06}}));
    EXPECT_EQ(rig.reachOf(1).min, glm::vec3(0.1F, 0.0F, 0.0F));
    EXPECT_EQ(rig.reachOf(1).max, glm::vec3(0.1F, static_cast<float>(0.06 - 0.01), 0.0F));
}

TEST(Rig, DeformsAlikeWhereOnlyWhatNoFieldDependsOnDiffers) {
    const RigParts parts = test::lifterRig().parts();
    struct Case {
        const char* what;
        std::function<void(RigParts&)> edit;
        bool alike;
    };
    const std::vector<Case> cases = {
        {"nothing", [](RigParts&) {}, true},
        {"rig's name", [](RigParts& p) { p.name = "other"; }, true},
        {"actuator's name", [](RigParts& p) { p.actuators[1].name = "other"; }, true},
        {"levels", [](RigParts& p) { p.actuators[1].levels = 5; }, true},
        {"velocity", [](RigParts& p) { p.actuators[1].maxVelocity = 0.5; }, true},
        {"damping", [](RigParts& p) { p.actuators[1].dampingRatio = 2.0; }, true},
        {"drive", [](RigParts& p) { p.actuators[1].drive.channel = 7; }, true},
        {"range", [](RigParts& p) { std::get<Slide>(p.actuators[1].deformer).max *= 1.5; }, false},
        {"weight", [](RigParts& p) { p.actuators[1].influences[0].weight = 0.5F; }, false},
        {"vertex", [](RigParts& p) { p.restMesh.positions[0].x += 1e-6F; }, false},
        {"triangle", [](RigParts& p) { p.restMesh.triangles.pop_back(); }, false},
        {"path", [](RigParts& p) { p.pathInside = !p.pathInside; }, false},
        {"order", [](RigParts& p) { std::swap(p.actuators[0], p.actuators[1]); }, false},
        {"count", [](RigParts& p) { p.actuators.pop_back(); }, false},
    };
    for (const Case& one : cases) {
        RigParts edited = parts;
        one.edit(edited);
        EXPECT_EQ(deformAlike(parts, edited), one.alike) << one.what;
        EXPECT_EQ(parts == edited, std::string(one.what) == "nothing") << one.what;
    }
}

TEST(Rig, StrokesOfAState) {
    const Rig rig(
        pointParts({{0, 0, 0}, {0.1F, 0, 0}, {0, 0, 0.1F}}, {Slide{{0, 1, 0}, 0, 0.1}, Slide{{0, 1, 0}, 0, 0.1}}));
    EXPECT_EQ(strokesOf(rig, {Level{0}, Level{8}}, 33), (std::vector<double>{0.0, 0.25}));
    EXPECT_EQ(strokesOf(rig, {Level{32}, Level{16}}, 33), (std::vector<double>{1.0, 0.5}));
    EXPECT_THROW((void)strokesOf(rig, {Level{0}}, 33), InvalidInput);
    EXPECT_THROW((void)strokesOf(rig, {Level{0}, Level{33}}, 33), InvalidInput);
    EXPECT_THROW((void)strokesOf(rig, {Level{-1}, Level{0}}, 33), InvalidInput);
    EXPECT_THROW((void)strokesOf(rig, {Level{0}, Level{0}}, 1), InvalidInput);
    EXPECT_THROW((void)strokesOf(rig, {Level{0}, Level{0}}, 201), InvalidInput);
    EXPECT_THROW((void)rig.subset(std::vector<std::uint32_t>{3}), InvalidInput);
}

struct BadParts {
    const char* name;
    const char* why; ///< part of the message
    std::function<void(RigParts&)> spoil;
};

class RigRefusedParts : public testing::TestWithParam<BadParts> {};

TEST_P(RigRefusedParts, AreRefusedWithTheirCause) {
    RigParts parts = pointParts({{0, 0, 0}, {0.1F, 0, 0}, {0, 0, 0.1F}},
                                {Hinge{{}, {1, 0, 0}, Angle(), Angle::degrees(90)},
                                 Bend{{}, {1, 0, 0}, {0, 0, 1}, 0.01, Angle(), Angle::degrees(90)},
                                 Slide{{0, 1, 0}, 0, 0.1}, MorphTarget{"m", {1.0F}, {{{}, {}, {}}}}});
    ASSERT_NO_THROW(Rig{parts});
    GetParam().spoil(parts);
    try {
        const Rig rig(std::move(parts));
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(error.why().find(GetParam().why), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty());
    }
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
template <class T> T& deformer(RigParts& parts) {
    for (Actuator& actuator : parts.actuators)
        if (auto* found = std::get_if<T>(&actuator.deformer)) return *found;
    throw std::logic_error("no such deformer");
}

INSTANTIATE_TEST_SUITE_P(
    Rig, RigRefusedParts,
    testing::Values(
        BadParts{"NoTriangles", "mesh is empty", [](RigParts& p) { p.restMesh.triangles.clear(); }},
        BadParts{"NaNVertex", "not finite", [](RigParts& p) { p.restMesh.positions[1].y = kNaN; }},
        BadParts{"TriangleIndex", "does not exist", [](RigParts& p) { p.restMesh.triangles[0].z = 3; }},
        BadParts{"NoName", "no name", [](RigParts& p) { p.actuators[0].name.clear(); }},
        BadParts{"SameName", "twice", [](RigParts& p) { p.actuators[0].name = p.actuators[1].name; }},
        BadParts{"HingeAxis", "no direction", [](RigParts& p) { deformer<Hinge>(p).axis = glm::vec3(0.0F); }},
        BadParts{"HingeNaN", "no direction", [](RigParts& p) { deformer<Hinge>(p).axis.x = kNaN; }},
        BadParts{"HingeRange", "backwards", [](RigParts& p) { deformer<Hinge>(p).max = Angle::degrees(-1); }},
        BadParts{"HingeTurns", "full turn", [](RigParts& p) { deformer<Hinge>(p).max = Angle::degrees(361); }},
        BadParts{"BendStart", "start at 0", [](RigParts& p) { deformer<Bend>(p).min = Angle::degrees(-5); }},
        BadParts{"BendLength", "no length", [](RigParts& p) { deformer<Bend>(p).length = 0.0; }},
        BadParts{"BendFrame", "perpendicular",
                 [](RigParts& p) {
                     deformer<Bend>(p).direction = {1, 0, 1};
                 }},
        BadParts{"SlideRange", "backwards", [](RigParts& p) { deformer<Slide>(p).max = 0.0; }},
        BadParts{"SlideNaN", "not finite", [](RigParts& p) { deformer<Slide>(p).max = kNaN; }},
        BadParts{"MorphKeys", "ascending", [](RigParts& p) { deformer<MorphTarget>(p).keys = {1.5F}; }},
        BadParts{"MorphSize", "one displacement",
                 [](RigParts& p) { deformer<MorphTarget>(p).displacements[0].pop_back(); }},
        BadParts{"NoSkeleton", "no skeleton",
                 [](RigParts& p) {
                     p.actuators[0].deformer = SkinJoint{0, {}, {1, 0, 0}, 0, 1};
                 }},
        BadParts{"Vertex", "does not exist", [](RigParts& p) { p.actuators[0].influences[2].vertex = 3; }},
        BadParts{"Order", "ascending", [](RigParts& p) { p.actuators[0].influences[1].vertex = 0; }},
        BadParts{"Weight", "within 0 and 1", [](RigParts& p) { p.actuators[0].influences[1].weight = 1.5F; }},
        BadParts{"WeightNaN", "within 0 and 1", [](RigParts& p) { p.actuators[0].influences[1].weight = kNaN; }},
        BadParts{"Levels", "level count", [](RigParts& p) { p.actuators[0].levels = 1; }},
        BadParts{"ManyLevels", "level count", [](RigParts& p) { p.actuators[0].levels = 201; }},
        BadParts{"Velocity", "velocity", [](RigParts& p) { p.actuators[0].maxVelocity = 0.0; }},
        BadParts{"Damping", "oscillate", [](RigParts& p) { p.actuators[0].dampingRatio = 0.5; }},
        BadParts{"Pulse", "pulse", [](RigParts& p) { p.actuators[0].drive.pulseMin = kNaN; }}),
    [](const auto& kind) { return std::string(kind.param.name); });

} // namespace
} // namespace lumorph
