#include "core/loop/match_target.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "tests/support/animated_target.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

class MatchTargetTest : public testing::Test {
protected:
    std::filesystem::path write(const Model& model, const char* name) { return folder_.write(name, writeGlb(model)); }
    std::filesystem::path write(const TriangleMesh& mesh, const char* name) {
        writeMesh(mesh, folder_.path() / name);
        return folder_.path() / name;
    }
    support::TemporaryFolder folder_;
};

TEST_F(MatchTargetTest, PlainMeshStandsStill) {
    const TriangleMesh box = test::boxMesh({0, 0, 0}, {1, 2, 3});
    const auto target = readMatchTarget(write(box, "crate.obj"));
    EXPECT_EQ(target->name, "crate");
    EXPECT_EQ(target->model, nullptr);
    EXPECT_EQ(target->animation, -1);
    EXPECT_EQ(target->duration, 0.0);
    EXPECT_TRUE(target->solid.closed);
    EXPECT_TRUE(target->warnings.empty());
    EXPECT_EQ(target->box.max, glm::vec3(1, 2, 3));
    EXPECT_EQ(meshAt(*target, 5.0).positions, box.positions);
}

TEST_F(MatchTargetTest, AnimationPlaysWithoutEnd) {
    const Model model = test::animatedEllipsoid(20, 10);
    const auto target = readMatchTarget(write(model, "swim.glb"));
    EXPECT_EQ(target->name, "swim");
    EXPECT_EQ(target->animation, 0);
    EXPECT_EQ(target->duration, 2.0);
    EXPECT_TRUE(target->solid.closed);
    for (const double seconds : {0.0, 0.3, 1.99, 2.0, 2.3, 4.0, -0.5}) {
        const double within = seconds == 2.0 ? 2.0 : seconds - 2.0 * std::floor(seconds / 2.0);
        const TriangleMesh expected = flatten(model, model.animations[0], within);
        const TriangleMesh mesh = meshAt(*target, seconds);
        EXPECT_EQ(mesh.triangles, expected.triangles);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            ASSERT_LT(glm::length(mesh.positions[v] - expected.positions[v]), 1e-5F) << seconds;
    }
    // Every pose lies in the box, up to what a thirtieth of a second can hide.
    for (int k = 0; k < 200; ++k)
        for (const glm::vec3& p : meshAt(*target, 0.01 * k).positions)
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], target->box.min[axis] - 0.02F);
                ASSERT_LE(p[axis], target->box.max[axis] + 0.02F);
            }
    EXPECT_GT(target->box.max.y, boundingBox(target->solid.mesh.positions).max.y + 0.1F);
}

TEST_F(MatchTargetTest, TheAnimationAskedForIsPlayed) {
    Model model = test::animatedEllipsoid(20, 10);
    Model::Animation second = model.animations[0];
    second.name = "slow";
    for (Model::Channel& channel : second.channels)
        for (float& time : channel.times) time *= 3.0F;
    model.animations.push_back(second);
    const auto file = write(model, "two.glb");
    EXPECT_EQ(readMatchTarget(file)->duration, 2.0);
    EXPECT_EQ(readMatchTarget(file, 1)->duration, 6.0);
    EXPECT_THROW((void)readMatchTarget(file, 2), DataError);
    EXPECT_THROW((void)readMatchTarget(file, -1), DataError);
}

TEST_F(MatchTargetTest, OpenAnimatedMeshIsTakenWithAWarning) {
    Model model = test::animatedEllipsoid(20, 10);
    std::vector<glm::uvec3>& triangles = model.meshes[0].primitives[0].triangles;
    triangles.resize(triangles.size() - 40);
    const auto target = readMatchTarget(write(model, "open.glb"));
    EXPECT_FALSE(target->solid.closed);
    ASSERT_FALSE(target->warnings.empty());
    EXPECT_NE(target->warnings.back().find("animated target is not a closed solid"), std::string::npos);
    EXPECT_EQ(meshAt(*target, 0.7).triangles, target->solid.mesh.triangles);
}

TEST_F(MatchTargetTest, OpenStillMeshIsRepaired) {
    TriangleMesh box = test::boxMesh({0, 0, 0}, {1, 1, 1}, 4);
    box.triangles.pop_back();
    const auto target = readMatchTarget(write(box, "hole.obj"));
    EXPECT_TRUE(target->solid.closed);
    EXPECT_FALSE(target->warnings.empty());
    EXPECT_NEAR(signedVolume(meshAt(*target, 0.0)), 1.0, 1e-6);
}

TEST_F(MatchTargetTest, WhatHasNoVolumeIsRefusedByName) {
    TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    Model empty;
    empty.nodes.resize(1);
    empty.roots = {0};
    const std::filesystem::path files[] = {write(sheet, "sheet.obj"), write(empty, "empty.glb"),
                                           folder_.write("text.obj", std::string("v 0 0 0\n")),
                                           folder_.path() / "missing.glb"};
    for (const std::filesystem::path& file : files) {
        try {
            (void)readMatchTarget(file);
            ADD_FAILURE() << file << " was taken";
        } catch (const DataError& error) {
            EXPECT_NE(error.subject().find(file.filename().string()), std::string::npos) << error.what();
        }
    }
}

TEST_F(MatchTargetTest, TellsHowFarItIsAndCanBeStopped) {
    const auto file = write(test::animatedEllipsoid(20, 10), "swim.glb");
    double last = 0.0;
    (void)readMatchTarget(file, {}, Progress([&](double fraction, std::string_view) {
                              EXPECT_GE(fraction, last);
                              last = fraction;
                          }));
    EXPECT_EQ(last, 1.0);
    std::stop_source stop;
    const Progress stopping(
        [&](double fraction, std::string_view) {
            if (fraction > 0.7) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW((void)readMatchTarget(file, {}, stopping), Cancelled);
}

} // namespace
} // namespace lumorph
