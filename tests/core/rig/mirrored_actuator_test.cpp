#include "core/rig/mirrored_actuator.h"

#include <numeric>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

/// A board of 20 x 10 cm about the origin whose top right quarter is moved by one actuator.
RigParts board(Deformer deformer) {
    RigParts parts;
    parts.name = "board";
    parts.restMesh = test::boxMesh({-0.1F, 0.0F, -0.05F}, {0.1F, 0.01F, 0.05F}, 8);
    Actuator actuator;
    actuator.name = "right";
    actuator.drive.channel = 3;
    actuator.maxVelocity = 0.7;
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v) {
        const glm::vec3& p = parts.restMesh.positions[v];
        if (p.x > 0.03F && p.z > -0.01F && p.y > 0.005F) actuator.influences.push_back({v, 4.0F * p.x});
    }
    if (auto* morph = std::get_if<MorphTarget>(&deformer)) {
        morph->keys = {1.0F};
        morph->displacements.emplace_back();
        for (const Influence& influence : actuator.influences)
            morph->displacements[0].push_back(0.1F * parts.restMesh.positions[influence.vertex] +
                                              glm::vec3(0.0F, 0.02F, 0.0F));
    }
    actuator.deformer = std::move(deformer);
    parts.actuators.push_back(std::move(actuator));
    return parts;
}

/// Both sides are a mirror image of each other, vertex by vertex, found by a search through all.
void expectMirrorImage(const RigParts& parts, std::size_t first, std::size_t second, int axis) {
    const Rig rig(parts);
    const auto& rest = parts.restMesh.positions;
    for (const double stroke : {0.3, 1.0}) {
        std::vector<double> strokes(parts.actuators.size(), 0.0);
        strokes[first] = stroke;
        const auto one = deformed(rig, strokes).positions;
        strokes[first] = 0.0;
        strokes[second] = stroke;
        const auto other = deformed(rig, strokes).positions;
        float farthest = 0.0F, moved = 0.0F;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            glm::vec3 there = rest[v];
            there[axis] = -there[axis];
            std::size_t image = 0;
            for (std::size_t w = 0; w < rest.size(); ++w)
                if (glm::distance(rest[w], there) < glm::distance(rest[image], there)) image = w;
            glm::vec3 expected = one[v];
            expected[axis] = -expected[axis];
            farthest = std::max(farthest, glm::distance(other[image], expected));
            moved = std::max(moved, glm::distance(one[v], rest[v]));
        }
        EXPECT_LT(farthest, 1e-5F) << stroke;
        EXPECT_GT(moved, 0.001F);
    }
}

TEST(MirroredActuator, MovesAsItsImageDoes) {
    const Angle none, turn = Angle::degrees(70.0);
    const Deformer kinds[] = {
        Hinge{{0.03F, 0.01F, -0.01F}, {-0.4F, 0.1F, 1.0F}, none, turn},
        Bend{{0.03F, 0.005F, 0.0F}, {0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}, 0.02, none, turn},
        Slide{{0.3F, 1.0F, 0.2F}, 0.0, 0.03},
        MorphTarget{"raised", {}, {}},
    };
    for (const Deformer& kind : kinds)
        for (const MirrorPlane plane : {MirrorPlane::acrossX, MirrorPlane::acrossZ}) {
            const RigParts parts = board(kind);
            if (plane == MirrorPlane::acrossZ && kind.index() == 3) continue; // its vertices would be both
            const MirroredActuator mirrored = mirroredActuator(parts, 0, plane);
            EXPECT_TRUE(mirrored.added);
            ASSERT_EQ(mirrored.parts.actuators.size(), 2U);
            EXPECT_EQ(mirrored.parts.actuators[0], parts.actuators[0]);
            EXPECT_EQ(mirrored.parts.actuators[1].name, "right mirrored");
            EXPECT_EQ(mirrored.parts.actuators[1].drive.channel, -1);
            EXPECT_EQ(mirrored.parts.actuators[1].maxVelocity, 0.7);
            expectMirrorImage(mirrored.parts, 0, 1, plane == MirrorPlane::acrossX ? 0 : 2);
        }
}

TEST(MirroredActuator, TakesOverWhatStandsThereAlready) {
    RigParts parts = mirroredActuator(board(Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03}), 0, MirrorPlane::acrossX).parts;
    parts.actuators[1].name = "left";
    parts.actuators[1].drive.channel = 5;
    parts.actuators[0].deformer = Slide{{1.0F, 1.0F, 0.0F}, 0.0, 0.01};
    const MirroredActuator again = mirroredActuator(parts, 0, MirrorPlane::acrossX);
    EXPECT_FALSE(again.added);
    EXPECT_EQ(again.actuator, 1U);
    ASSERT_EQ(again.parts.actuators.size(), 2U);
    EXPECT_EQ(again.parts.actuators[1].name, "left");
    EXPECT_EQ(again.parts.actuators[1].drive.channel, 5);
    expectMirrorImage(again.parts, 0, 1, 0);
    // There and back again is where it was.
    EXPECT_EQ(mirroredActuator(again.parts, 1, MirrorPlane::acrossX).parts, again.parts);
}

TEST(MirroredActuator, OfTheTabletsCornerIsTheCornerOppositeIt) {
    const RigParts tablet = tabletRig().parts();
    const MirroredActuator mirrored = mirroredActuator(tablet, 0, mirrorPlaneOf(tablet, 0));
    EXPECT_FALSE(mirrored.added);
    EXPECT_EQ(mirrored.parts.actuators.size(), tablet.actuators.size());
    EXPECT_NE(mirrored.actuator, 0U);
}

TEST(MirroredActuator, SaysWhyThereIsNone) {
    RigParts parts = board(Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03});
    parts.restMesh.positions[parts.actuators[0].influences[0].vertex].x += 0.002F;
    EXPECT_THROW((void)mirroredActuator(parts, 0, MirrorPlane::acrossX), InvalidInput);
    RigParts all = board(Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03});
    all.actuators[0].influences.clear();
    for (std::uint32_t v = 0; v < all.restMesh.positions.size(); ++v) all.actuators[0].influences.push_back({v, 1.0F});
    EXPECT_THROW((void)mirroredActuator(all, 0, MirrorPlane::acrossX), InvalidInput);
}

} // namespace
} // namespace lumorph
