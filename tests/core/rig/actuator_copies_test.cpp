#include "core/rig/actuator_copies.h"

#include <functional>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/cut_tablet.h"
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
    const RigParts tablet = test::cutTablet().parts();
    const MirroredActuator mirrored = mirroredActuator(tablet, 0, mirrorPlaneOf(tablet, 0));
    EXPECT_FALSE(mirrored.added);
    EXPECT_EQ(mirrored.parts.actuators.size(), tablet.actuators.size());
    EXPECT_NE(mirrored.actuator, 0U);
}

/// Every copy moves the place that is the first one's, turned and carried, as the first one moves that: by a search
/// through all vertices.
void expectCopies(const RigParts& parts, std::size_t first, const std::vector<std::size_t>& copies,
                  const std::function<glm::dmat4(int)>& placed) {
    const Rig rig(parts);
    const auto& rest = parts.restMesh.positions;
    const auto at = [&](std::size_t actuator) {
        std::vector<double> strokes(parts.actuators.size(), 0.0);
        strokes[actuator] = 0.6;
        return deformed(rig, strokes).positions;
    };
    const auto one = at(first);
    for (std::size_t k = 0; k < copies.size(); ++k) {
        const auto other = at(copies[k]);
        const glm::dmat4 to = placed(static_cast<int>(k) + 1);
        double farthest = 0.0;
        int moved = 0;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            if (glm::distance(one[v], rest[v]) < 1e-6F) continue;
            ++moved;
            const glm::vec3 there(to * glm::dvec4(rest[v], 1.0));
            std::size_t image = 0;
            for (std::size_t w = 0; w < rest.size(); ++w)
                if (glm::distance(rest[w], there) < glm::distance(rest[image], there)) image = w;
            farthest =
                std::max(farthest, glm::distance(glm::dvec3(other[image]), glm::dvec3(to * glm::dvec4(one[v], 1.0))));
        }
        EXPECT_GT(moved, 3);
        EXPECT_EQ(rig.verticesOf(copies[k]).size(), rig.verticesOf(first).size());
        EXPECT_LT(farthest, 1e-5) << k;
    }
}

/// A square board about the middle, one corner of which moves.
RigParts square(Deformer deformer) {
    RigParts parts = board(std::move(deformer));
    parts.restMesh = test::boxMesh({-0.08F, 0.0F, -0.08F}, {0.08F, 0.01F, 0.08F}, 8);
    auto& influences = parts.actuators[0].influences;
    influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v) {
        const glm::vec3& p = parts.restMesh.positions[v];
        if (p.x > 0.03F && p.z > 0.03F) influences.push_back({v, 10.0F * p.x});
    }
    return parts;
}

TEST(ActuatorCopies, StandAroundTheMiddle) {
    const Deformer kinds[] = {
        Hinge{{0.03F, 0.01F, 0.03F}, {-0.4F, 0.1F, 1.0F}, {}, Angle::degrees(70.0)},
        Bend{{0.03F, 0.005F, 0.03F}, {-1.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 1.0F}, 0.02, {}, Angle::degrees(70.0)},
        Slide{{0.3F, 1.0F, 0.2F}, 0.0, 0.03},
    };
    for (const Deformer& kind : kinds) {
        const ActuatorCopies copies = copiesAround(square(kind), 0, 4);
        EXPECT_EQ(copies.added, 3);
        EXPECT_EQ(copies.actuators, (std::vector<std::size_t>{1, 2, 3}));
        EXPECT_EQ(copies.parts.actuators[1].name, "right copy");
        EXPECT_EQ(copies.parts.actuators[3].name, "right copy 3");
        EXPECT_EQ(copies.parts.actuators[2].drive.channel, -1);
        expectCopies(copies.parts, 0, copies.actuators, [](int k) {
            return glm::rotate(glm::dmat4(1.0), 0.5 * std::numbers::pi * k, glm::dvec3(0, 1, 0));
        });
        const ActuatorCopies again = copiesAround(copies.parts, 0, 4);
        EXPECT_EQ(again.added, 0);
        EXPECT_EQ(again.parts, copies.parts) << "they are there already";
    }
}

TEST(ActuatorCopies, StandAlongALine) {
    RigParts parts = board(Slide{{0.2F, 1.0F, 0.0F}, 0.0, 0.02});
    auto& influences = parts.actuators[0].influences;
    influences.clear();
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v) {
        const glm::vec3& p = parts.restMesh.positions[v];
        if (p.x < -0.07F && p.y > 0.005F && std::abs(p.z) < 0.03F) influences.push_back({v, 0.5F});
    }
    const glm::vec3 step(0.05F, 0.0F, 0.0F);
    const ActuatorCopies copies = copiesAlong(parts, 0, 4, step);
    EXPECT_EQ(copies.added, 3);
    expectCopies(copies.parts, 0, copies.actuators,
                 [&](int k) { return glm::translate(glm::dmat4(1.0), static_cast<double>(k) * glm::dvec3(step)); });
}

TEST(ActuatorCopies, SayWhyThereAreNone) {
    const RigParts parts = square(Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03});
    EXPECT_THROW((void)copiesAround(parts, 0, 5), InvalidInput) << "a square has no five corners";
    EXPECT_THROW((void)copiesAround(parts, 0, 1), InvalidInput);
    EXPECT_THROW((void)copiesAround(parts, 0, kMostCopies + 1), InvalidInput);
    EXPECT_THROW((void)copiesAlong(parts, 0, 3, {0.0F, 0.0F, 0.0F}), InvalidInput);
    EXPECT_THROW((void)copiesAlong(parts, 0, 3, {0.02F, 0.0F, 0.0F}), InvalidInput) << "beyond the edge";
    RigParts upright = parts;
    upright.actuators[0].influences.clear();
    for (std::uint32_t v = 0; v < upright.restMesh.positions.size(); ++v)
        upright.actuators[0].influences.push_back({v, 1.0F});
    EXPECT_THROW((void)copiesAround(upright, 0, 4), InvalidInput) << "each would be itself";
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
