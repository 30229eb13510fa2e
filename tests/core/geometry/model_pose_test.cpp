#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/model.h"

namespace lumorph {
namespace {

using Path = Model::Path;
using Interpolation = Model::Interpolation;

void expectNear(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-6F) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

glm::quat turnAboutZ(float angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

TriangleMesh smallTetrahedron() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// A node with one channel.
Model moving(Path path, Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    Model model = modelOf(smallTetrahedron(), "moving");
    model.animations.push_back({"it", {{0, path, interpolation, std::move(times), std::move(values)}}});
    return model;
}

glm::vec3 originAt(const Model& model, double seconds) {
    return glm::vec3(nodeTransforms(model, model.animations[0], seconds)[0][3]);
}

TEST(ModelPose, TransformsChainFromParentToChild) {
    Model model;
    model.nodes.resize(2);
    model.nodes[0].children = {1};
    model.nodes[0].translation = {1, 2, 3};
    model.nodes[0].rotation = turnAboutZ(std::numbers::pi_v<float> / 2);
    model.nodes[0].scale = {2, 2, 2};
    model.nodes[1].parent = 0;
    model.nodes[1].translation = {1, 0, 0};
    model.roots = {0};
    const auto world = nodeTransforms(model);
    expectNear(glm::vec3(world[1][3]), {1, 4, 3});
    expectNear(glm::vec3(world[1] * glm::vec4(0, 1, 0, 1)), {-1, 4, 3});
}

struct Sample {
    double seconds;
    float expected;
};

TEST(ModelPose, LinearKeysAreHeldBeyondTheEnds) {
    const Model model = moving(Path::translation, Interpolation::linear, {1, 2, 4}, {0, 0, 0, 10, 0, 0, 20, 0, 0});
    EXPECT_DOUBLE_EQ(model.animations[0].duration(), 4.0);
    for (const Sample& sample : {Sample{-1, 0}, {1, 0}, {1.25, 2.5F}, {2, 10}, {3, 15}, {4, 20}, {99, 20}})
        expectNear(originAt(model, sample.seconds), {sample.expected, 0, 0});
}

TEST(ModelPose, StepKeysJump) {
    const Model model = moving(Path::translation, Interpolation::step, {1, 2}, {3, 0, 0, 7, 0, 0});
    for (const Sample& sample : {Sample{0, 3}, {1.999, 3}, {2, 7}, {3, 7}})
        expectNear(originAt(model, sample.seconds), {sample.expected, 0, 0});
}

TEST(ModelPose, RotationsTakeTheShortWay) {
    const float angle = std::numbers::pi_v<float> / 2;
    const glm::quat q = turnAboutZ(angle);
    // The second key is the negative quaternion: the same turn, which a naive blend would reach the long way round.
    const Model model = moving(Path::rotation, Interpolation::linear, {0, 1}, {0, 0, 0, 1, -q.x, -q.y, -q.z, -q.w});
    for (const float t : {0.0F, 0.25F, 0.5F, 1.0F}) {
        const glm::mat4 world = nodeTransforms(model, model.animations[0], static_cast<double>(t))[0];
        expectNear(glm::vec3(world[0]), {std::cos(t * angle), std::sin(t * angle), 0});
    }
}

TEST(ModelPose, CubicSplinesFollowTheFormula) {
    // in-tangent, value, out-tangent for keys at 1 s and 3 s
    const float v0 = 1;
    const float out0 = 2;
    const float in1 = -1;
    const float v1 = 5;
    const Model model = moving(Path::translation, Interpolation::cubicSpline, {1, 3},
                               {9, 9, 9, v0, 0, 0, out0, 0, 0, in1, 0, 0, v1, 0, 0, 9, 9, 9});
    for (const double seconds : {1.0, 1.5, 2.0, 2.7, 3.0}) {
        const auto t = static_cast<float>((seconds - 1.0) / 2.0);
        const float expected = (2 * t * t * t - 3 * t * t + 1) * v0 + 2 * (t * t * t - 2 * t * t + t) * out0 +
                               (-2 * t * t * t + 3 * t * t) * v1 + 2 * (t * t * t - t * t) * in1;
        expectNear(originAt(model, seconds), {expected, 0, 0}, 1e-5F);
    }
    expectNear(originAt(model, 0), {v0, 0, 0});
    expectNear(originAt(model, 4), {v1, 0, 0});
}

TEST(ModelPose, CubicRotationsStayUnit) {
    const Model model = moving(Path::rotation, Interpolation::cubicSpline, {0, 1},
                               {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    const glm::mat4 world = nodeTransforms(model, model.animations[0], 0.4)[0];
    EXPECT_NEAR(glm::determinant(glm::mat3(world)), 1.0F, 1e-5F);
}

TEST(ModelPose, MorphTargetsAddUp) {
    Model model = modelOf(smallTetrahedron(), "morph");
    Model::Mesh& mesh = model.meshes[0];
    mesh.primitives[0].morphTargets = {{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}},
                                       std::vector<glm::vec3>(4, {8, 0, 0})};
    expectNear(flatten(model).positions[1], {1, 0, 0});
    mesh.weights = {0.5F, 0.25F};
    expectNear(flatten(model).positions[1], {3, 0, 1});
    model.nodes[0].weights = {-1, 0};
    expectNear(flatten(model).positions[1], {1, 0, -2});
    model.animations.push_back({"it", {{0, Path::weights, Interpolation::linear, {0, 1}, {0, 0, 1, 1}}}});
    expectNear(flatten(model, model.animations[0], 0.5).positions[1], {5, 0, 1});
}

/// A vertical strip with its joints at heights 0 and 1; the node that shows it is far away, which must not matter.
Model bendingStrip() {
    Model model = modelOf({{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2}}}, "strip");
    model.meshes[0].primitives[0].joints = {{0, 1, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}};
    model.meshes[0].primitives[0].weights = {{1, 0, 0, 0}, {0.5F, 0.5F, 0, 0}, {0, 1, 0, 0}};
    model.nodes.resize(3);
    model.nodes[0].translation = {100, 100, 100};
    model.nodes[0].skin = 0;
    model.nodes[1].children = {2};
    model.nodes[2].parent = 1;
    model.nodes[2].translation = {0, 1, 0};
    model.roots = {0, 1};
    glm::mat4 upperFromWorld(1.0F);
    upperFromWorld[3] = glm::vec4(0, -1, 0, 1);
    model.skins.push_back({"", {1, 2}, {glm::mat4(1.0F), upperFromWorld}});
    const glm::quat q = turnAboutZ(std::numbers::pi_v<float> / 2);
    model.animations.push_back(
        {"bend", {{2, Path::rotation, Interpolation::linear, {0, 1}, {0, 0, 0, 1, q.x, q.y, q.z, q.w}}}});
    return model;
}

TEST(ModelPose, SkinsIgnoreTheNodeThatShowsThem) {
    const TriangleMesh rest = flatten(bendingStrip());
    for (int i = 0; i < 3; ++i) expectNear(rest.positions[static_cast<std::size_t>(i)], {0, i, 0});
}

TEST(ModelPose, SkinsFollowTheirJoints) {
    const Model model = bendingStrip();
    const TriangleMesh bent = flatten(model, model.animations[0], 1.0);
    expectNear(bent.positions[0], {0, 0, 0});
    expectNear(bent.positions[1], {0, 1, 0});
    expectNear(bent.positions[2], {-1, 1, 0});
}

TEST(ModelPose, MorphsComeBeforeSkins) {
    Model model = bendingStrip();
    model.meshes[0].primitives[0].morphTargets = {{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}}};
    model.meshes[0].weights = {1};
    expectNear(flatten(model, model.animations[0], 1.0).positions[2], {-2, 1, 0});
}

struct Mirror {
    glm::vec3 scale;
    double volume;
};

TEST(ModelPose, OutsideStaysOutsideWhenMirrored) {
    for (const Mirror& mirror : {Mirror{{1, 1, 1}, 1}, {{-1, 1, 1}, 1}, {{-2, -1, 1}, 2}, {{-1, -2, -3}, 6}}) {
        Model model = modelOf(smallTetrahedron(), "mirror");
        model.nodes[0].scale = mirror.scale;
        EXPECT_NEAR(signedVolume(flatten(model)), mirror.volume / 6.0, 1e-6);
    }
}

TEST(ModelPose, MirroredSkinsKeepOutsideOutside) {
    Model model = modelOf(smallTetrahedron(), "mirror");
    model.meshes[0].primitives[0].joints.assign(4, {0, 0, 0, 0});
    model.meshes[0].primitives[0].weights.assign(4, {1, 0, 0, 0});
    model.skins.push_back({"", {0}, {glm::mat4(1.0F)}});
    model.nodes[0].skin = 0;
    model.nodes[0].scale = {1, -1, 1};
    EXPECT_NEAR(signedVolume(flatten(model)), 1.0 / 6.0, 1e-6);
}

TEST(ModelPose, TrianglesAreTheSameAtEveryTime) {
    const Model model = moving(Path::scale, Interpolation::linear, {0, 1}, {1, 1, 1, -1, 1, 1});
    EXPECT_EQ(flatten(model, model.animations[0], 1.0).triangles, flatten(model).triangles);
    EXPECT_NEAR(signedVolume(flatten(model, model.animations[0], 1.0)), -1.0 / 6.0, 1e-6);
}

TEST(ModelPose, OnlyTheSceneIsShown) {
    Model model = modelOf(smallTetrahedron(), "one");
    model.nodes.resize(2);
    model.nodes[1].mesh = 0;
    EXPECT_EQ(flatten(model).triangles.size(), 4U);
    model.roots = {0, 1};
    EXPECT_EQ(flatten(model).triangles.size(), 8U);
    EXPECT_EQ(flatten(model).triangles[4], glm::uvec3(4, 6, 5));
}

TEST(ModelPose, PositionsBeyondFloatAreRefused) {
    Model model = modelOf(smallTetrahedron(), "huge");
    model.nodes[0].scale = glm::vec3(1e38F);
    model.meshes[0].primitives[0].positions[1] = {100, 0, 0};
    EXPECT_THROW((void)flatten(model), InvalidInput);
}

} // namespace
} // namespace lumorph
