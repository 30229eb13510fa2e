#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/loop/show_stage.h"
#include "tests/core/loop/scene_loop_fixture.h"

// What the loop hands over to those who draw.

namespace lumorph::test {
namespace {

TEST_F(SceneLoopTest, ShowStageHandsOnWhatTheLoopFound) {
    SceneInRoom scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::split, waves(0.01, 3.0)));
    scene.items.push_back(itemOf(ItemRole::virtualOnly, LightItem{}, 2));
    scene.items.back().position = {0.2F, 0.5F, 0.1F};
    scene.worldFromDevice = glm::translate(glm::mat4(1.0F), {0.1F, 0.0F, 0.0F});
    const auto match = run(wishWith(scene), 0.5);
    ShowStage stage;
    const ShowFrame show = stage.frame(*match);
    EXPECT_EQ(show.scene, match->scene);
    EXPECT_EQ(show.installation, match->installation);
    EXPECT_EQ(show.assets, match->assets);
    EXPECT_EQ(show.rig, match->rig);
    EXPECT_EQ(show.devicePositions, match->devicePositions);
    EXPECT_EQ(show.worldFromDevice, scene.worldFromDevice);
    EXPECT_EQ(show.eye, scene.eye);
    EXPECT_EQ(show.posed.seconds, match->sceneSeconds);
    ASSERT_EQ(show.posed.surfaces.size(), 1U);
    ASSERT_EQ(show.posed.lights.size(), 1U);
    // Light draws the item whole, where its waves are at that time.
    const PosedSurface& water = show.posed.surfaces.front();
    EXPECT_FLOAT_EQ(water.worldFromSurface[3].x, 0.1F);
    double worst = 0.0;
    for (const glm::vec3& p : *water.positions)
        if (p.y > -0.015F)
            worst = std::max(worst, std::abs(static_cast<double>(p.y) -
                                             waveHeight(waves(0.01, 3.0), {p.x, p.z}, match->sceneSeconds)));
    EXPECT_LT(worst, 1e-4);
    MatchWish plain = wishWith(scene);
    plain.scene = nullptr;
    EXPECT_THROW((void)stage.frame(*step(plain)), InvalidInput);
    MatchFrame nowhere = *match;
    nowhere.installation = nullptr;
    EXPECT_THROW((void)stage.frame(nowhere), InvalidInput);
}

TEST_F(SceneLoopTest, ShowStageShowsTheBareDeviceWhereServosWorkAlone) {
    SceneInRoom scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::split, waves(0.01, 3.0)));
    scene.device.show = DeviceSkin::Show::content;
    scene.device.material.roughness = 0.7F;
    scene.device.shrink = 0.3;
    scene.device.holes = {{{0.01F, 0.02F}, 0.02}};
    scene.device.creases.emphasis = 0.8;
    const struct {
        Showing showing;
        bool bare;
    } kCases[] = {{Showing::both, false}, {Showing::virtualOnly, false}, {Showing::physical, true}};
    ShowStage stage;
    for (const auto& one : kCases) {
        scene.showing = one.showing;
        const MatchWish wish = wishWith(scene);
        const auto match = run(wish, 0.3);
        const ShowFrame show = stage.frame(*match);
        EXPECT_EQ(show.posed.surfaces.size(), one.bare ? 0U : 1U);
        const DeviceSkin& skin = show.scene->device;
        EXPECT_EQ(skin.show == DeviceSkin::Show::material, one.bare) << "else one looks through it at the table";
        EXPECT_EQ(skin.shrink == 0.0 && skin.holes.empty() && skin.creases.emphasis == 0.0, one.bare);
        EXPECT_EQ(skin.material.roughness, 0.7F);
        EXPECT_EQ(stage.frame(*step(wish)).scene, show.scene) << "what does not change stays the same object";
    }
}

TEST_F(SceneLoopTest, ShowStageShowsTheTargetWhereTheLoopHasIt) {
    SceneInRoom scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::physical, TargetItem{}));
    MatchWish wish = wishWith(scene);
    wish.target = movingTarget();
    wish.placement.scale = 0.02;
    wish.placement.translation = {0.03F, 0.05F, 0.0F};
    const auto match = run(wish, 0.7);
    ShowStage stage;
    const ShowFrame show = stage.frame(*match);
    ASSERT_EQ(show.posed.surfaces.size(), 1U);
    const PosedSurface& shown = show.posed.surfaces.front();
    EXPECT_EQ(shown.topology->triangles.size(), wish.target->solid.mesh.triangles.size());
    for (const glm::vec3& p : *match->targetPositions) {
        const glm::vec3 device(match->deviceFromTarget * glm::vec4(p, 1.0F));
        const bool there = std::ranges::any_of(*shown.positions, [&](const glm::vec3& q) {
            return glm::distance(glm::vec3(shown.worldFromSurface * glm::vec4(q, 1.0F)), device) < 1e-6F;
        });
        EXPECT_TRUE(there);
    }
}

} // namespace
} // namespace lumorph::test
