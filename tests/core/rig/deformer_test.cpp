#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/core/rig/point_rig.h"

namespace lumorph {
namespace {

using test::pointParts;
using test::positionsAt;

void expectNear(const glm::vec3& a, const glm::dvec3& b, double tolerance = 1e-7) {
    EXPECT_LE(glm::distance(glm::dvec3(a), b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

const std::vector<glm::vec3> kSomePoints{{0.03F, 0.01F, -0.02F}, {-0.05F, 0.02F, 0.04F}, {0.1F, 0.0F, 0.07F}};

// R4
TEST(Deformers, AHingeTurnsAsGlmDoes) {
    const Hinge hinge{{0.01F, 0.02F, 0.0F}, {1.0F, 2.0F, -0.5F}, Angle::degrees(-10.0), Angle::degrees(60.0)};
    const Rig rig(pointParts(kSomePoints, {hinge}));
    for (const double stroke : {0.0, 0.2, 0.71, 1.0}) {
        glm::dmat4 turn = glm::translate(glm::dmat4(1.0), glm::dvec3(hinge.origin));
        turn = glm::rotate(turn, glm::radians(70.0 * stroke), glm::normalize(glm::dvec3(hinge.axis)));
        turn = glm::translate(turn, -glm::dvec3(hinge.origin));
        const auto positions = positionsAt(rig, {stroke});
        for (std::size_t k = 0; k < positions.size(); ++k)
            expectNear(positions[k], glm::dvec3(turn * glm::dvec4(kSomePoints[k], 1.0)));
    }
}

// A bend written independently: the neutral line is integrated numerically from its curvature, and
// the point is set off along the normal where it ends.
glm::dvec2 bentByIntegration(double u, double h, double length, double angle) {
    if (u <= 0.0) return {u, h};
    constexpr int kSteps = 20000;
    glm::dvec2 at(0.0);
    for (int k = 0; k < kSteps; ++k) {
        const double way = u * (k + 0.5) / kSteps;
        const double turned = angle * std::min(way, length) / length;
        at += u / kSteps * glm::dvec2(std::cos(turned), std::sin(turned));
    }
    const double turned = angle * std::min(u, length) / length;
    return at + h * glm::dvec2(-std::sin(turned), std::cos(turned));
}

struct BendCase {
    double degrees;
    double length;
};

class DeformersBend : public testing::TestWithParam<BendCase> {};

TEST_P(DeformersBend, FollowTheIntegratedCurvature) {
    const auto [degrees, length] = GetParam();
    std::vector<glm::vec3> points;
    for (const double u : {-0.03, -0.001, 0.0, 0.001, 0.004, 0.0099, 0.01, 0.0101, 0.02, 0.05})
        for (const double h : {-0.003, 0.0, 0.002}) points.emplace_back(0.01 + u, 0.019 + h, 0.5 * u);
    const Bend bend{{0.01F, 0.019F, 0.0F},  {0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}, length, Angle(),
                    Angle::degrees(degrees)};
    const Rig rig(pointParts(points, {bend}));
    for (const double stroke : {1e-4, 0.03, 0.5, 1.0}) {
        const auto positions = positionsAt(rig, {stroke});
        for (std::size_t k = 0; k < points.size(); ++k) {
            const glm::dvec3 from = glm::dvec3(points[k]) - glm::dvec3(bend.origin);
            const glm::dvec2 to = bentByIntegration(from.x, from.y, length, glm::radians(degrees) * stroke);
            expectNear(positions[k], glm::dvec3(bend.origin) + glm::dvec3(to.x, to.y, from.z), 2e-7);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AnglesAndLengths, DeformersBend,
                         testing::Values(BendCase{90.0, 0.01}, BendCase{30.0, 0.02}, BendCase{180.0, 0.01},
                                         BendCase{359.0, 0.04}, BendCase{1.0, 0.003}));

TEST(Deformers, ABendKeepsLengthThicknessAndEndsAtItsAngle) {
    std::vector<glm::vec3> points;
    constexpr int kSamples = 2000;
    for (int k = 0; k <= kSamples; ++k)
        for (const double h : {-0.001, 0.0, 0.001}) points.emplace_back(0.02, h, 0.06 * k / kSamples - 0.01);
    // axis x direction points up, so that the free end rises
    const Bend bend{{}, {-1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.02, Angle(), Angle::degrees(90.0)};
    const Rig rig(pointParts(points, {bend}));
    for (const double stroke : {0.25, 0.5, 1.0}) {
        const auto bent = positionsAt(rig, {stroke});
        double length = 0.0;
        for (std::size_t k = 0; k < points.size(); k += 3) {
            EXPECT_NEAR(glm::distance(bent[k], bent[k + 2]), 0.002, 1e-7);
            if (k > 0) length += glm::distance(bent[k + 1], bent[k - 2]);
        }
        EXPECT_NEAR(length, 0.06, 0.06 * 1e-4);
        const glm::vec3 end = bent[points.size() - 2] - bent[points.size() - 302];
        EXPECT_NEAR(std::atan2(end.y, end.z), stroke * std::numbers::pi / 2.0, 1e-4);
    }
}

// R4: each map acts on what came before it.
TEST(Deformers, ActOneAfterTheOtherInOrder) {
    const Hinge hinge{{}, {0.0F, 0.0F, 1.0F}, Angle(), Angle::degrees(90.0)};
    const Slide slide{{1.0F, 0.0F, 0.0F}, 0.0, 0.1};
    const std::vector<glm::vec3> points{{0.1F, 0.0F, 0.0F}, {0.2F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.0F}};
    const Rig turnThenSlide(pointParts(points, {hinge, slide}));
    const Rig slideThenTurn(pointParts(points, {slide, hinge}));
    expectNear(positionsAt(turnThenSlide, {1.0, 1.0})[0], {0.1, 0.1, 0.0});
    expectNear(positionsAt(slideThenTurn, {1.0, 1.0})[0], {0.0, 0.2, 0.0});
}

TEST(Deformers, ABendCarriesWhatAnotherHasMovedIntoIt) {
    const Slide slide{{0.0F, 0.0F, 1.0F}, 0.0, 0.03};
    const Bend bend{{}, {-1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.02, Angle(), Angle::degrees(90.0)};
    const std::vector<glm::vec3> points{{0.0F, 0.0F, -0.01F}, {0.0F, 0.001F, 0.0F}, {0.1F, 0.0F, 0.01F}};
    const Rig rig(pointParts(points, {slide, bend}));
    const auto moved = positionsAt(rig, {1.0, 1.0});
    for (std::size_t k = 0; k < points.size(); ++k) {
        const glm::dvec2 to = bentByIntegration(points[k].z + 0.03, points[k].y, 0.02, std::numbers::pi / 2.0);
        expectNear(moved[k], {points[k].x, to.y, to.x}, 2e-7);
    }
}

TEST(Deformers, AWeightIsAShareOfTheStroke) {
    RigParts parts = pointParts(kSomePoints, {Hinge{{}, {0.0F, 1.0F, 0.0F}, Angle(), Angle::degrees(80.0)}});
    parts.actuators[0].influences = {{0, 1.0F}, {1, 0.25F}};
    const auto moved = positionsAt(Rig(std::move(parts)), {0.5});
    const auto turned = [](const glm::vec3& p, double degrees) {
        return glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0)) *
                          glm::dvec4(p, 1.0));
    };
    expectNear(moved[0], turned(kSomePoints[0], 40.0));
    expectNear(moved[1], turned(kSomePoints[1], 10.0));
    EXPECT_EQ(moved[2], kSomePoints[2]);
}

// R4: one mesh per deformation state is a polyline through the states.
TEST(Deformers, MorphTargetsPassThroughTheirKeys) {
    MorphTarget morph{"states", {0.25F, 0.5F, 1.0F}, {}};
    morph.displacements = {{{0.01F, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                           {{0.01F, 0.02F, 0}, {0, 0, 0.01F}, {0, 0, 0}},
                           {{0, 0.02F, 0}, {0, 0, 0.03F}, {0, 0, 0}}};
    const Rig rig(pointParts(kSomePoints, {morph}));
    const auto at = [&](double stroke) { return positionsAt(rig, {stroke})[0] - kSomePoints[0]; };
    expectNear(at(0.0), {0.0, 0.0, 0.0}, 1e-8);
    expectNear(at(0.125), {0.005, 0.0, 0.0}, 1e-8);
    expectNear(at(0.25), {0.01, 0.0, 0.0}, 1e-8);
    expectNear(at(0.4), {0.01, 0.012, 0.0}, 1e-8);
    expectNear(at(0.75), {0.005, 0.02, 0.0}, 1e-8);
    expectNear(at(1.0), {0.0, 0.02, 0.0}, 1e-8);
    expectNear(positionsAt(rig, {0.75})[1], glm::dvec3(kSomePoints[1]) + glm::dvec3(0.0, 0.0, 0.02), 1e-8);
}

// Two links of 0.1 along x, worked out by hand: the first turns about z, the second slides in its own frame.
TEST(Deformers, ASkinBlendsItsJoints) {
    RigParts parts =
        pointParts({{0.1F, 0.0F, 0.0F}, {0.2F, 0.0F, 0.0F}, {-0.1F, 0.0F, 0.0F}},
                   {SkinJoint{1, SkinJoint::Motion::rotate, {0.0F, 0.0F, 1.0F}, 0.0, std::numbers::pi / 2.0},
                    SkinJoint{2, SkinJoint::Motion::translate, {1.0F, 0.0F, 0.0F}, 0.0, 0.05}});
    Skeleton& skeleton = parts.skeleton.emplace();
    skeleton.joints = {
        {-1, glm::mat4(1.0F)}, {0, glm::mat4(1.0F)}, {1, glm::translate(glm::mat4(1.0F), glm::vec3(0.1F, 0.0F, 0.0F))}};
    skeleton.vertexJoints = {{0, 1, 0, 0}, {2, 0, 0, 0}, {0, 0, 0, 0}};
    skeleton.vertexWeights = {{0.5F, 0.5F, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    const Rig rig(std::move(parts));
    const auto moved = positionsAt(rig, {1.0, 1.0});
    expectNear(moved[0], {0.05, 0.05, 0.0}); // half way between staying and (0, 0.1)
    expectNear(moved[1], {0.0, 0.25, 0.0});
    expectNear(moved[2], {-0.1, 0.0, 0.0});
    EXPECT_EQ(std::vector<std::uint16_t>(rig.actuatorsOf(0).begin(), rig.actuatorsOf(0).end()),
              (std::vector<std::uint16_t>{0}));
    EXPECT_EQ(rig.actuatorsOf(1).size(), 2U);
    EXPECT_TRUE(rig.actuatorsOf(2).empty());
}

} // namespace
} // namespace lumorph
