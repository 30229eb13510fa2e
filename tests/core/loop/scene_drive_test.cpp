#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/motion/frequency_split.h"
#include "core/motion/surface_heights.h"
#include "core/motion/view_dependence.h"
#include "tests/core/loop/scene_loop_fixture.h"
#include "tests/support/animated_target.h"

// What servos do with a scene.

namespace lumorph::test {
namespace {

/// The soft approach follows a ramp 2 x 0.15 s behind; the loop looks ahead by as much.
constexpr double kLag = 0.3;

TEST_F(SceneLoopTest, ASceneThatDrivesNothingLeavesMatchingAsItIs) {
    const auto field = matchFieldOf(cushionRig());
    MatchWish plain = wishFor(field, movingTarget());
    MatchWish shown = plain;
    SceneInRoom scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::virtualOnly, waves(0.01, 3.0)));
    setSceneInRoom(shown, scene);
    shown.assets = std::make_shared<const SceneAssets>();
    MatchWish driven = shown;
    scene.items.push_back(itemOf(ItemRole::physical, TargetItem{}, 2));
    setSceneInRoom(driven, scene);
    MatchLoop bare(clock_);
    MatchLoop matched(clock_);
    for (int k = 0; k < 60; ++k) {
        const auto expected = bare.step(plain, kFrame);
        for (const auto& frame : {step(shown, kFrame), matched.step(driven, kFrame)}) {
            EXPECT_EQ(frame->wanted, expected->wanted);
            EXPECT_EQ(frame->wantedStrokes, expected->wantedStrokes);
            EXPECT_EQ(frame->estimatedStrokes, expected->estimatedStrokes);
            EXPECT_EQ(frame->iouWanted, expected->iouWanted);
            EXPECT_TRUE(frame->viewStrokes.empty() && frame->splitStrokes.empty());
        }
    }
}

// Fig. 2
TEST_F(SceneLoopTest, LightAloneLetsTheServosRest) {
    const auto field = matchFieldOf(cushionRig());
    MatchWish wish = wishFor(field, movingTarget());
    SceneInRoom scene = emptyScene();
    scene.viewDependence.on = true;
    setSceneInRoom(wish, scene);
    wish.assets = std::make_shared<const SceneAssets>();
    ASSERT_GT(std::ranges::max(run(wish, 2.0)->estimatedStrokes), 0.2);
    scene.showing = Showing::virtualOnly;
    setSceneInRoom(wish, scene);
    wish.strokes = {1.0, 1.0, 1.0};
    const auto frame = run(wish, 6.0);
    EXPECT_EQ(frame->wantedStrokes, std::vector<double>(3, 0.0));
    EXPECT_EQ(frame->wanted, State(3));
    EXPECT_EQ(frame->estimatedStrokes, std::vector<double>(3, 0.0));
    EXPECT_TRUE(frame->viewStrokes.empty());
    EXPECT_TRUE(frame->matched);
    EXPECT_EQ(frame->iouWanted, 0.0) << "of what the servos do";
}

// R33
TEST_F(SceneLoopTest, AHeightFieldWithAPhysicalRoleIsFittedAsItStands) {
    for (const Anchor anchor : {Anchor::device, Anchor::world}) {
        SceneInRoom scene = emptyScene();
        const HeightItem water = waves(0.012, 4.0);
        SceneItem item = itemOf(ItemRole::physical, water);
        item.position = {0.01F, 0.025F, -0.005F};
        item.anchor = anchor;
        if (anchor == Anchor::world) {
            // The device has been moved and turned, and the water with it.
            scene.worldFromDevice = glm::rotate(glm::translate(glm::mat4(1.0F), {0.2F, 0.1F, -0.1F}), 0.7F, {0, 1, 0});
            item.position = glm::vec3(scene.worldFromDevice * glm::vec4(item.position, 1.0F));
            item.rotation = glm::quat_cast(scene.worldFromDevice);
        }
        scene.items.push_back(item);
        MatchLoop loop(clock_);
        FrequencySplit split(*tablet());
        for (int k = 0; k < 20; ++k) {
            const auto frame = loop.step(wishWith(scene), 0.1);
            ASSERT_NEAR(frame->sceneSeconds, 0.1 * (k + 1), 1e-9);
            std::vector<float> heights(split.restHeights().begin(), split.restHeights().end());
            for (std::size_t p = 0; p < heights.size(); ++p) {
                const glm::vec2 at = split.points()[p] - glm::vec2(0.01F, -0.005F);
                if (std::abs(at.x) < 0.1F && std::abs(at.y) < 0.07F)
                    heights[p] = static_cast<float>(0.025 + waveHeight(water, at, frame->sceneSeconds));
            }
            const std::vector<double> expected = split.fit(heights);
            for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(frame->wantedStrokes[i], expected[i], 2e-3) << k;
            EXPECT_TRUE(frame->splitStrokes.empty());
        }
    }
}

// R33, Fig. 2
TEST_F(SceneLoopTest, ServosCarryTheSlowPartOfASplitItem) {
    SceneInRoom scene = emptyScene();
    HeightItem water = waves(0.012, 8.0);
    water.size = {0.25F, 0.2F}; // over the whole device
    water.waves.push_back({0.004, 0.03, 0.3, Angle::degrees(60.0), Angle{}});
    scene.items.push_back(itemOf(ItemRole::split, water));
    scene.items.back().position = {0.0F, 0.02F, 0.0F};
    const MatchWish wish = wishWith(scene);
    FrequencySplit split(*tablet());
    std::vector<float> reached(split.points().size());
    std::vector<float> possible(split.points().size());
    double whole = 0.0;
    double left = 0.0;
    double best = 0.0;
    double fastest = 0.0;
    std::vector<double> last;
    for (int k = 0; k < 16 * 60; ++k) {
        const auto frame = step(wish);
        ASSERT_EQ(frame->splitStrokes.size(), 6U);
        EXPECT_EQ(frame->wantedStrokes, frame->splitStrokes);
        EXPECT_FALSE(loop_.settled());
        for (std::size_t i = 0; i < last.size(); ++i)
            fastest = std::max(fastest, std::abs(frame->splitStrokes[i] - last[i]) / kFrame);
        last = frame->splitStrokes;
        if (k < 180 || k % 6 != 0) continue;
        std::vector<float> wished(split.points().size());
        for (std::size_t p = 0; p < wished.size(); ++p)
            wished[p] = static_cast<float>(0.02 + waveHeight(water, split.points()[p], frame->sceneSeconds));
        split.heights(frame->estimatedStrokes, reached);
        split.heights(split.fit(wished), possible);
        for (std::size_t p = 0; p < wished.size(); ++p) {
            const auto square = [](double x) { return x * x; };
            whole += square(static_cast<double>(wished[p]) - static_cast<double>(split.restHeights()[p]));
            left += square(static_cast<double>(wished[p]) - static_cast<double>(reached[p]));
            best += square(static_cast<double>(wished[p]) - static_cast<double>(possible[p]));
        }
    }
    EXPECT_GE(whole - left, 0.9 * (whole - best)) << "by where the servos really are, not where they were sent";
    EXPECT_LE(fastest, tablet()->actuators()[0].maxVelocity * 1.001);
}

TEST_F(SceneLoopTest, ASplitTargetIsLiftedWhereItStands) {
    MatchWish wish = wishWith([] {
        SceneInRoom scene = emptyScene();
        scene.items.push_back(itemOf(ItemRole::split, TargetItem{}));
        return scene;
    }());
    wish.target = movingTarget();
    wish.placement.scale = 0.03;
    wish.placement.translation = {-0.08F, 0.015F, 0.055F};
    wish.spin = 0.2;
    FrequencySplit split(*tablet());
    std::vector<double> expected;
    // The target starts at 0; the frame of the first step stands at second 0.
    const FrequencySplit::Wish heights = [&](double t, std::span<float> out) {
        Placement placement = wish.placement;
        placement.yaw = Angle::radians(0.2 * t);
        const TriangleMesh mesh = placed(meshAt(*wish.target, t), placement);
        heightsOfMesh(mesh, split.points(), out);
    };
    std::shared_ptr<const MatchFrame> frame;
    for (int k = 0; k < 150; ++k) {
        frame = step(wish);
        expected = split.strokes(heights, static_cast<double>(k) * kFrame + kLag);
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(frame->wantedStrokes[i], expected[i], 5e-3) << k << ' ' << i;
    }
    EXPECT_GT(frame->wantedStrokes[0], 0.05) << "the flap under it";
    EXPECT_EQ(frame->wantedStrokes[3], 0.0) << "the flap across";

    wish.playing = false;
    wish.spin = 0.0;
    for (int k = 0; k < 600 && !loop_.settled(); ++k) frame = step(wish);
    EXPECT_TRUE(loop_.settled());
    wish.target = nullptr;
    EXPECT_EQ(run(wish, 1.0)->wantedStrokes, wish.strokes) << "without a target there is nothing to follow";
}

TEST_F(SceneLoopTest, ASplitModelIsLiftedAsItsAnimationMovesIt) {
    const Model model = animatedEllipsoid(24, 16);
    auto shown = std::make_shared<SceneModel>();
    shown->model = model;
    shown->materials.resize(model.materials.size());
    auto assets = std::make_shared<SceneAssets>();
    assets->models["ball.glb"] = std::move(shown);
    SceneInRoom scene = emptyScene();
    SceneItem item = itemOf(ItemRole::split, MeshItem{"ball.glb"});
    item.position = {-0.08F, 0.015F, 0.055F};
    item.scale = glm::vec3(0.03F);
    scene.items.push_back(item);
    MatchWish wish = wishWith(scene);
    wish.assets = assets;
    FrequencySplit split(*tablet());
    const FrequencySplit::Wish heights = [&](double t, std::span<float> out) {
        TriangleMesh mesh = flatten(model, model.animations[0], std::fmod(t, 2.0));
        for (glm::vec3& corner : mesh.positions) corner = item.position + item.scale * corner;
        heightsOfMesh(mesh, split.points(), out);
    };
    double least = 1.0;
    double most = 0.0;
    for (int k = 0; k < 240; ++k) {
        const auto frame = step(wish);
        const std::vector<double> expected = split.strokes(heights, frame->sceneSeconds + kLag);
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(frame->wantedStrokes[i], expected[i], 5e-3) << k << ' ' << i;
        if (k < 120) continue;
        least = std::min(least, std::ranges::max(frame->wantedStrokes));
        most = std::max(most, std::ranges::max(frame->wantedStrokes));
    }
    EXPECT_GT(most, 0.1);
    EXPECT_GT(most, least + 0.01) << "it swells and turns";
}

TEST_F(SceneLoopTest, AShapeIsFeltWhereItIs) {
    SceneInRoom scene = emptyScene();
    SceneItem group = itemOf(ItemRole::virtualOnly, GroupItem{}, 1);
    group.position = {0.08F, 0.0F, 0.0F};
    scene.items.push_back(group);
    SceneItem ball = itemOf(ItemRole::physical, ShapeItem{ShapeItem::Form::sphere, glm::vec3(0.05F)}, 2);
    ball.parent = 1;
    ball.position = {0.0F, 0.03F, -0.05F};
    scene.items.push_back(ball);
    const auto frame = step(wishWith(scene));
    for (std::size_t i = 0; i < 6; ++i) {
        const bool under = tablet()->actuators()[i].name == "corner back right";
        EXPECT_EQ(frame->wantedStrokes[i] > 0.05, under) << tablet()->actuators()[i].name;
    }
    scene.items.front().visible = false;
    EXPECT_EQ(step(wishWith(scene))->wantedStrokes, std::vector<double>(6, 0.0)) << "what is hidden drives nothing";
}

// R22
TEST_F(SceneLoopTest, ViewDependenceJoinsByTheLargerStroke) {
    SceneInRoom scene = emptyScene();
    scene.viewDependence.on = true;
    scene.eye = {0.0F, 0.3F, 0.5F};
    MatchWish wish = wishWith(scene);
    wish.strokes.assign(6, 0.3);
    const auto frame = step(wish);
    const std::vector<double> rule = ViewRule(*tablet()).strokes(glm::dvec3(scene.eye));
    EXPECT_EQ(frame->viewStrokes, rule);
    EXPECT_GT(std::ranges::max(rule), 0.5);
    EXPECT_EQ(std::ranges::min(rule), 0.0);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(frame->wantedStrokes[i], std::max(0.3, rule[i]));

    // Seen by the device as it lies: turned half way round, the other side bends.
    scene.worldFromDevice = glm::rotate(glm::mat4(1.0F), std::numbers::pi_v<float>, {0, 1, 0});
    const auto turned = step(wishWith(scene));
    const std::vector<double> behind = ViewRule(*tablet()).strokes({0.0, 0.3, -0.5});
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(turned->viewStrokes[i], behind[i], 1e-6);

    scene.viewer = ViewerChoice::none;
    const auto alone = step(wishWith(scene));
    EXPECT_FALSE(alone->eye);
    EXPECT_EQ(alone->viewStrokes, std::vector<double>(6, 0.0)) << "nobody looks";
}

TEST_F(SceneLoopTest, ViewDependenceRaisesTheLevelsOfAMatch) {
    const auto field = matchFieldOf(cushionRig());
    MatchWish wish = wishFor(field, stillTarget(boxMesh({0, 0, 0}, {0.06F, 0.006F, 0.05F})));
    wish.assets = std::make_shared<const SceneAssets>();
    SceneInRoom scene = emptyScene();
    setSceneInRoom(wish, scene);
    const auto plain = step(wish);
    scene.viewDependence.on = true;
    scene.eye = {0.05F, 0.1F, -0.5F};
    setSceneInRoom(wish, scene);
    const auto joined = step(wish);
    ASSERT_TRUE(joined->matched);
    bool raised = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const int bent = static_cast<int>(std::lround(8.0 * joined->viewStrokes[i]));
        EXPECT_EQ(joined->wanted[i].index, std::max(plain->wanted[i].index, bent));
        EXPECT_EQ(joined->wantedStrokes[i], std::max(plain->wantedStrokes[i], joined->viewStrokes[i]));
        raised |= bent > plain->wanted[i].index;
    }
    EXPECT_TRUE(raised);
    BitColumns covered;
    CoverageScratch scratch;
    field->coverage.covered(joined->wanted, covered, scratch);
    TriangleMesh mesh = placed(wish.target->solid.mesh, wish.placement);
    BitColumns target = voxelizeSolid(field->field.frame, mesh);
    target -= field->field.body;
    EXPECT_NEAR(joined->iouWanted, intersectionOverUnion(covered, target), 1e-12) << "of the joined state";
}

} // namespace
} // namespace lumorph::test
