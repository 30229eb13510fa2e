#include "core/rig/actuator_weights.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

const glm::vec3 kUp(0.0F, 1.0F, 0.0F);

/// A board of 16 x 16 cm whose top is raised by one actuator of any kind.
RigParts weightBoard(Deformer deformer, float thick = 0.01F) {
    RigParts parts;
    parts.name = "board";
    parts.restMesh = test::boxMesh({-0.08F, 0.0F, -0.08F}, {0.08F, thick, 0.08F}, 16);
    Actuator actuator;
    actuator.name = "raised";
    if (auto* morph = std::get_if<MorphTarget>(&deformer)) {
        morph->keys = {1.0F};
        morph->displacements.emplace_back();
        for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
            if (parts.restMesh.positions[v].y > 0.5F * thick && parts.restMesh.positions[v].x > 0.0F) {
                actuator.influences.push_back({v, 1.0F});
                morph->displacements[0].emplace_back(0.0F, 0.03F, 0.0F);
            }
    }
    actuator.deformer = std::move(deformer);
    parts.actuators.push_back(std::move(actuator));
    return parts;
}

const Deformer kSlide = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03};

/// One joint below another, and every vertex follows the first alone.
RigParts skinned() {
    RigParts parts = weightBoard(SkinJoint{1, SkinJoint::Motion::translate, {0.0F, 1.0F, 0.0F}, 0.0, 0.03});
    Skeleton skeleton;
    skeleton.joints = {{-1, glm::mat4(1.0F)}, {0, glm::mat4(1.0F)}};
    skeleton.vertexJoints.assign(parts.restMesh.positions.size(), glm::u16vec4(0));
    skeleton.vertexWeights.assign(parts.restMesh.positions.size(), glm::vec4(1.0F, 0.0F, 0.0F, 0.0F));
    parts.skeleton = skeleton;
    return parts;
}

TEST(ActuatorWeights, SetMoveEachVertexByItsShare) {
    for (const Deformer& kind : {kSlide, Deformer(MorphTarget{"raised", {}, {}})}) {
        RigParts parts = weightBoard(kind);
        const std::vector<bool> follows = canFollow(parts, 0);
        std::vector<float> weights;
        for (const glm::vec3& p : parts.restMesh.positions) weights.push_back(std::abs(p.z) / 0.08F);
        setActuatorWeights(parts, 0, weights);
        const auto now = deformed(Rig(parts), std::vector{1.0}).positions;
        int moved = 0;
        for (std::size_t v = 0; v < now.size(); ++v) {
            const float expected = follows[v] ? 0.03F * weights[v] : 0.0F;
            EXPECT_NEAR(now[v].y - parts.restMesh.positions[v].y, expected, 0.03F * 0.0006F);
            moved += follows[v];
        }
        EXPECT_GT(moved, 100);
        const Rig again = readRigGlb(writeRigGlb(Rig(parts)), "again.glb");
        EXPECT_EQ(again.parts().actuators, parts.actuators) << "kept by the file, to the last bit";
    }
}

TEST(ActuatorWeights, OfAMorphTargetCanBeTakenAwayAndGivenBack) {
    const RigParts before = weightBoard(MorphTarget{"raised", {}, {}});
    RigParts parts = before;
    const std::vector<float> weights = actuatorWeights(parts, 0);
    setActuatorWeights(parts, 0, std::vector<float>(weights.size(), 0.0F));
    EXPECT_EQ(deformed(Rig(parts), std::vector{1.0}).positions, parts.restMesh.positions);
    setActuatorWeights(parts, 0, weights);
    EXPECT_EQ(parts, before);
}

TEST(ActuatorWeights, OfAJointMakeRoomForIt) {
    RigParts parts = skinned();
    std::vector<float> weights(parts.restMesh.positions.size(), 0.0F);
    for (std::size_t v = 0; v < weights.size(); ++v) weights[v] = static_cast<float>(v % 5) / 4.0F;
    setActuatorWeights(parts, 0, weights);
    EXPECT_EQ(actuatorWeights(parts, 0), weights);
    const auto now = deformed(Rig(parts), std::vector{1.0}).positions;
    for (std::size_t v = 0; v < now.size(); ++v)
        EXPECT_NEAR(now[v].y - parts.restMesh.positions[v].y, 0.03F * weights[v], 1e-6F);
    // What it gives up goes to the joint it hangs on, where it was the only one.
    setActuatorWeights(parts, 0, std::vector<float>(weights.size(), 1.0F));
    setActuatorWeights(parts, 0, std::vector<float>(weights.size(), 0.25F));
    for (std::size_t v = 0; v < weights.size(); ++v) {
        float root = 0.0F;
        for (int k = 0; k < 4; ++k)
            if (parts.skeleton->vertexJoints[v][k] == 0) root += parts.skeleton->vertexWeights[v][k];
        EXPECT_NEAR(root, 0.75F, 1e-6F);
    }
}

TEST(ActuatorWeights, FallOffSmoothly) {
    const std::vector<float> metres{0.0F, 0.02F, 0.025F, 0.03F, 0.035F, 0.04F, 1.0F, INFINITY};
    const std::vector<float> weights = weightsByDistance(metres, {0.02, 0.02});
    const float expected[] = {1.0F, 1.0F, 0.84375F, 0.5F, 0.15625F, 0.0F, 0.0F, 0.0F};
    for (std::size_t i = 0; i < metres.size(); ++i) EXPECT_NEAR(weights[i], expected[i], 1e-6F) << i;
    EXPECT_EQ(weightsByDistance(metres, {0.03, 0.0})[3], 1.0F);
    EXPECT_EQ(weightsByDistance(metres, {0.03, 0.0})[4], 0.0F) << "a hard edge";
    EXPECT_THROW((void)weightsByDistance(metres, {-0.01, 0.0}), InvalidInput);
}

TEST(ActuatorWeights, SpreadAroundAPlaceAndToOneSideOfALine) {
    const RigParts thin = weightBoard(kSlide, 0.003F);
    const auto& at = thin.restMesh.positions;
    const WeightFalloff falloff{0.02, 0.03};
    const auto expected = [&](double metres) { return weightsByDistance(std::vector{float(metres)}, falloff)[0]; };
    const auto around = weightsAround(thin.restMesh, {0.01F, 0.003F, 0.0F}, falloff);
    const auto beside =
        weightsBeside(thin.restMesh, {glm::vec3(0.0F, 0.0015F, -0.08F), glm::vec3(0.0F, 0.0015F, 0.08F)},
                      {1.0F, 0.0F, 0.0F}, falloff);
    for (std::size_t v = 0; v < at.size(); ++v) {
        if (at[v].y < 0.002F) continue; // the bottom is two triangles, seen below by its corners
        EXPECT_NEAR(around[v], expected(std::hypot(at[v].x - 0.01, at[v].z)), 0.12) << v;
        EXPECT_NEAR(beside[v], at[v].x < -1e-4F ? 0.0F : expected(at[v].x), 0.12) << v;
    }
    EXPECT_EQ(*std::max_element(around.begin(), around.end()), 1.0F);
}

TEST(ActuatorWeights, AreRefusedWhenTheyAreNone) {
    RigParts parts = weightBoard(kSlide);
    const RigParts before = parts;
    std::vector<float> weights(parts.restMesh.positions.size(), 0.5F);
    weights[3] = 1.5F;
    EXPECT_THROW(setActuatorWeights(parts, 0, weights), InvalidInput);
    weights[3] = NAN;
    EXPECT_THROW(setActuatorWeights(parts, 0, weights), InvalidInput);
    weights.pop_back();
    EXPECT_THROW(setActuatorWeights(parts, 0, weights), InvalidInput);
    EXPECT_EQ(parts, before);
}

TEST(WeightStroke, PaintsWithinItsRadiusAndOnBothSidesOfASheetAlone) {
    const WeightBrush brush{WeightBrush::Tool::paint, 0.03, 0.4};
    for (const float thick : {0.004F, 0.01F}) {
        const RigParts parts = weightBoard(kSlide, thick);
        const glm::vec3 place(0.0F, thick, 0.0F);
        WeightStroke stroke(parts, 0);
        stroke.moveTo(place, kUp, brush);
        for (std::size_t v = 0; v < parts.restMesh.positions.size(); ++v) {
            const glm::vec3& p = parts.restMesh.positions[v];
            const double far = glm::distance(p, place);
            double inside = std::max(0.0, 1.0 - far * far / (0.03 * 0.03));
            if (thick > 0.006F && p.y < 0.5F * thick) inside = 0.0;
            EXPECT_NEAR(stroke.weights()[v], 0.4 * inside * inside, 1e-5) << v;
        }
    }
    const RigParts parts = weightBoard(kSlide);
    WeightStroke stroke(parts, 0);
    // Again and again: never above 1; the eraser takes it all away.
    for (int i = 0; i < 40; ++i) stroke.moveTo({i % 2 == 0 ? 0.008F : 0.0F, 0.01F, 0.0F}, kUp, brush);
    EXPECT_EQ(*std::max_element(stroke.weights().begin(), stroke.weights().end()), 1.0F);
    for (int i = 0; i < 60; ++i)
        stroke.moveTo({i % 2 == 0 ? 0.008F : 0.0F, 0.01F, 0.0F}, kUp, {WeightBrush::Tool::erase, 0.06, 1.0});
    EXPECT_EQ(*std::max_element(stroke.weights().begin(), stroke.weights().end()), 0.0F);
}

TEST(WeightStroke, ComesToTheSameInFewMovesAndInMany) {
    const RigParts parts = weightBoard(kSlide);
    const WeightBrush brush{WeightBrush::Tool::paint, 0.02, 0.1};
    WeightStroke few(parts, 0), many(parts, 0);
    few.moveTo({-0.05F, 0.01F, 0.0F}, kUp, brush);
    few.moveTo({0.05F, 0.01F, 0.0F}, kUp, brush);
    for (int i = 0; i <= 200; ++i) many.moveTo({-0.05F + 0.0005F * static_cast<float>(i), 0.01F, 0.0F}, kUp, brush);
    double worst = 0.0;
    for (std::size_t v = 0; v < few.weights().size(); ++v)
        worst = std::max<double>(worst, std::abs(few.weights()[v] - many.weights()[v]));
    EXPECT_LT(worst, 0.05);
}

TEST(WeightStroke, SmoothsTowardsTheMeanAround) {
    RigParts parts = weightBoard(kSlide);
    const auto& mesh = parts.restMesh;
    std::vector<float> weights;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) weights.push_back(v % 2 == 0 ? 1.0F : 0.0F);
    setActuatorWeights(parts, 0, weights);
    WeightStroke stroke(parts, 0);
    stroke.moveTo({0.0F, 0.01F, 0.0F}, kUp, {WeightBrush::Tool::smooth, 0.05, 1.0});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        double sum = 0.0;
        int count = 0;
        for (const glm::uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k)
                if (mesh.positions[t[k]] == mesh.positions[v])
                    sum += weights[t[(k + 1) % 3]] + weights[t[(k + 2) % 3]], count += 2;
        const double far = glm::distance(mesh.positions[v], glm::vec3(0.0F, 0.01F, 0.0F));
        const double inside = std::max(0.0, 1.0 - far * far / (0.05 * 0.05));
        EXPECT_NEAR(stroke.weights()[v], weights[v] + inside * inside * (sum / count - weights[v]), 1e-5) << v;
    }
}

TEST(WeightStroke, LeavesWhatCannotFollow) {
    const RigParts parts = weightBoard(MorphTarget{"raised", {}, {}});
    WeightStroke stroke(parts, 0);
    stroke.moveTo({0.0F, 0.01F, 0.0F}, kUp, {WeightBrush::Tool::paint, 0.2, 1.0});
    const auto follows = canFollow(parts, 0);
    for (std::size_t v = 0; v < follows.size(); ++v)
        if (!follows[v]) {
            EXPECT_EQ(stroke.weights()[v], 0.0F);
        }
}

} // namespace
} // namespace lumorph
