#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/loop/show_stage.h"
#include "core/motion/frequency_split.h"
#include "core/motion/surface_heights.h"
#include "core/motion/view_dependence.h"
#include "core/rig/rig_file.h"
#include "tests/core/loop/loop_fixture.h"

namespace lumorph {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The soft approach follows a ramp 2 x 0.15 s behind; the loop looks ahead by as much.
constexpr double kLag = 0.3;

std::shared_ptr<const Rig> tablet() {
    static const auto rig = std::make_shared<const Rig>(readRig(LUMORPH_SOURCE_DIR "/resources/models/tablet.glb"));
    return rig;
}

Scene emptyScene() {
    Scene scene = defaultScene();
    scene.items.clear();
    return scene;
}

SceneItem itemOf(ItemRole role, decltype(SceneItem::kind) kind, int id = 1) {
    SceneItem item;
    item.id = id;
    item.name = "item";
    item.role = role;
    item.kind = std::move(kind);
    return item;
}

HeightItem waves(double amplitude, double period) {
    HeightItem water;
    water.size = {0.2F, 0.14F};
    water.waves = {{amplitude, 0.25, period, Angle{}, Angle{}}};
    return water;
}

/// `waves`, written down here: heights over the device of an item lifted to `base`, as it is turned by `yaw`.
double waveHeight(const HeightItem& water, const glm::vec2& at, double t) {
    const Wave& wave = water.waves.front();
    return wave.amplitude * std::sin(2.0 * std::numbers::pi * (at.x / wave.length - t / wave.period));
}

class SceneLoopTest : public testing::Test {
protected:
    MatchWish wishWith(Scene scene, std::shared_ptr<const Rig> rig = tablet()) {
        MatchWish wish;
        wish.strokes.assign(rig->actuatorCount(), 0.0);
        wish.rig = std::move(rig);
        wish.scene = std::make_shared<const Scene>(std::move(scene));
        wish.assets = std::make_shared<const SceneAssets>();
        return wish;
    }
    std::shared_ptr<const MatchFrame> step(const MatchWish& wish, double seconds = kFrame) {
        clock_.advance(Microseconds(std::llround(1e6 * seconds)));
        return loop_.step(wish, seconds);
    }
    std::shared_ptr<const MatchFrame> run(const MatchWish& wish, double seconds) {
        std::shared_ptr<const MatchFrame> frame;
        for (double t = 0.0; t < seconds; t += kFrame) frame = step(wish);
        return frame;
    }

    ManualClock clock_;
    MatchLoop loop_{clock_};
};

TEST_F(SceneLoopTest, ASceneThatDrivesNothingLeavesMatchingAsItIs) {
    const auto field = test::matchFieldOf(test::cushionRig());
    MatchWish plain = test::wishFor(field, test::movingTarget());
    MatchWish shown = plain;
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::virtualOnly, waves(0.01, 3.0)));
    shown.scene = std::make_shared<const Scene>(scene);
    shown.assets = std::make_shared<const SceneAssets>();
    MatchWish driven = shown;
    scene.items.push_back(itemOf(ItemRole::physical, TargetItem{}, 2));
    driven.scene = std::make_shared<const Scene>(scene);
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
    const auto field = test::matchFieldOf(test::cushionRig());
    MatchWish wish = test::wishFor(field, test::movingTarget());
    Scene scene = emptyScene();
    scene.viewDependence.on = true;
    wish.scene = std::make_shared<const Scene>(scene);
    wish.assets = std::make_shared<const SceneAssets>();
    ASSERT_GT(std::ranges::max(run(wish, 2.0)->estimatedStrokes), 0.2);
    scene.showing = Showing::virtualOnly;
    wish.scene = std::make_shared<const Scene>(scene);
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
        Scene scene = emptyScene();
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
    Scene scene = emptyScene();
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
        Scene scene = emptyScene();
        scene.items.push_back(itemOf(ItemRole::split, TargetItem{}));
        return scene;
    }());
    wish.target = test::movingTarget();
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

TEST_F(SceneLoopTest, AShapeIsFeltWhereItIs) {
    Scene scene = emptyScene();
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
    Scene scene = emptyScene();
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
    const auto field = test::matchFieldOf(test::cushionRig());
    MatchWish wish = test::wishFor(field, test::stillTarget(test::boxMesh({0, 0, 0}, {0.06F, 0.006F, 0.05F})));
    wish.assets = std::make_shared<const SceneAssets>();
    Scene scene = emptyScene();
    wish.scene = std::make_shared<const Scene>(scene);
    const auto plain = step(wish);
    scene.viewDependence.on = true;
    scene.eye = {0.05F, 0.1F, -0.5F};
    wish.scene = std::make_shared<const Scene>(scene);
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

TEST_F(SceneLoopTest, SceneTimePlaysPausesAndIsSoughtOnce) {
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::virtualOnly, waves(0.01, 2.0)));
    MatchWish wish = wishWith(scene);
    EXPECT_NEAR(step(wish, 0.5)->sceneSeconds, 0.5, 1e-12);
    wish.sceneSeek = 7.0;
    EXPECT_EQ(step(wish, 0.5)->sceneSeconds, 7.0);
    EXPECT_EQ(step(wish, 0.5)->sceneSeconds, 7.5) << "heeded once";
    wish.scenePlaying = false;
    EXPECT_EQ(step(wish, 0.5)->sceneSeconds, 7.5);
    EXPECT_TRUE(loop_.settled());
    wish.sceneSeek = 1.25;
    EXPECT_EQ(step(wish, 0.5)->sceneSeconds, 1.25);
    wish.sceneSeek.reset();
    (void)step(wish);
    wish.sceneSeek = 1.5;
    EXPECT_EQ(step(wish)->sceneSeconds, 1.5);
    wish.sceneSeek = kNan;
    EXPECT_THROW((void)step(wish), InvalidInput);
}

TEST_F(SceneLoopTest, RestsOnlyWhenNothingInTheSceneMoves) {
    const auto lamp = [](double spin) {
        Scene scene = emptyScene();
        SceneItem light = itemOf(ItemRole::virtualOnly, LightItem{});
        light.position = {0.3F, 0.5F, 0.1F};
        light.motion.spin = spin;
        scene.items.push_back(light);
        return scene;
    };
    const auto texture = [](glm::vec2 velocity, const char* image) {
        Scene scene = emptyScene();
        scene.device.material.normalMaps[1].image = image;
        scene.device.material.normalMaps[1].velocity = velocity;
        return scene;
    };
    const auto hidden = [&] {
        Scene scene = lamp(1.0);
        scene.items.front().visible = false;
        return scene;
    };
    struct Case {
        const char* what;
        Scene scene;
        bool moves;
    };
    FogItem drifting;
    FogItem still;
    still.drift = {0.0F, 0.0F};
    Scene fog = emptyScene();
    fog.items.push_back(itemOf(ItemRole::virtualOnly, drifting));
    Scene calm = emptyScene();
    calm.items.push_back(itemOf(ItemRole::virtualOnly, still));
    for (const Case& c : {Case{"nothing", emptyScene(), false}, Case{"light", lamp(0.0), false},
                          Case{"spinning light", lamp(0.2), true}, Case{"hidden", hidden(), false},
                          Case{"moving texture", texture({0.0F, 0.1F}, "waves"), true},
                          Case{"no texture", texture({0.0F, 0.1F}, ""), false}, Case{"fog", fog, true},
                          Case{"calm fog", calm, false}}) {
        MatchLoop loop(clock_);
        MatchWish wish = wishWith(c.scene);
        const auto first = loop.step(wish, kFrame);
        EXPECT_EQ(loop.settled(), !c.moves) << c.what;
        EXPECT_GT(loop.step(wish, kFrame)->sceneSeconds, first->sceneSeconds);
        wish.scenePlaying = false;
        (void)loop.step(wish, kFrame);
        EXPECT_TRUE(loop.settled()) << c.what << " paused";
    }
}

TEST_F(SceneLoopTest, StopFreezesServosAndLightGoesOn) {
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::split, waves(0.015, 3.0)));
    scene.items.back().position = {0.0F, 0.02F, 0.0F};
    scene.viewDependence.on = true;
    MatchWish wish = wishWith(scene);
    const auto moving = run(wish, 1.0);
    wish.stopped = true;
    double seconds = moving->sceneSeconds;
    const auto frozen = step(wish);
    for (int k = 0; k < 120; ++k) {
        const auto frame = step(wish);
        EXPECT_EQ(frame->estimatedStrokes, moving->estimatedStrokes);
        EXPECT_EQ(frame->devicePositions, frozen->devicePositions);
        EXPECT_GT(frame->sceneSeconds, seconds);
        EXPECT_FALSE(loop_.settled());
        seconds = frame->sceneSeconds;
    }
}

TEST_F(SceneLoopTest, APausedSplitComesToRest) {
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::split, waves(0.015, 3.0)));
    scene.items.back().position = {0.0F, 0.025F, 0.0F};
    MatchWish wish = wishWith(scene);
    (void)run(wish, 1.0);
    wish.scenePlaying = false;
    std::shared_ptr<const MatchFrame> frame;
    for (int k = 0; k < 600 && !loop_.settled(); ++k) frame = step(wish);
    ASSERT_TRUE(loop_.settled());
    EXPECT_EQ(frame->estimatedStrokes, frame->wantedStrokes);
    // An edit moves them although time stands still.
    auto higher = std::make_shared<Scene>(*wish.scene);
    higher->items.front().position.y = 0.05F;
    wish.scene = higher;
    EXPECT_GT(step(wish)->wantedStrokes[0], frame->wantedStrokes[0] + 0.05);
    EXPECT_FALSE(loop_.settled());
}

// R25
TEST_F(SceneLoopTest, DeviceAndHeadArePredictedForTheMomentOfTheLight) {
    Scene scene = emptyScene();
    scene.predictionSeconds = 0.06;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    EXPECT_EQ(step(wish)->eye, scene.eye) << "without a head the scene's own eye";
    EXPECT_EQ(step(wish)->worldFromDevice, scene.worldFromDevice);
    EXPECT_TRUE(loop_.settled());

    const auto device = board->stream("tablet", PoseRole::device);
    const auto head = board->stream("Ada", PoseRole::head);
    EXPECT_FALSE(step(wish)->eye) << "heads are tracked, and nobody is there";
    std::shared_ptr<const MatchFrame> frame;
    double t = 0.0;
    for (int k = 0; k < 120; ++k) {
        t = 1e-6 * static_cast<double>(clock_.now().count());
        ASSERT_TRUE(head->push({clock_.now(), true, {{0.3 * t, 0.5, 0.4}, {1, 0, 0, 0}}}));
        ASSERT_TRUE(
            device->push({clock_.now(), true, {{0.0, 0.1, -0.2 * t}, glm::angleAxis(0.5 * t, glm::dvec3(0, 1, 0))}}));
        clock_.advance(Microseconds{4'000});
        frame = loop_.step(wish, kFrame);
        EXPECT_FALSE(loop_.settled());
        clock_.advance(Microseconds{4'000});
    }
    ASSERT_TRUE(frame->eye);
    EXPECT_EQ(frame->viewer, "Ada");
    EXPECT_NEAR(frame->eye->x, 0.3 * (t + 0.064), 1e-3);
    const glm::mat4 truth =
        glm::rotate(glm::translate(glm::mat4(1.0F), {0.0F, 0.1F, -0.2F * static_cast<float>(t + 0.064)}),
                    static_cast<float>(0.5 * (t + 0.064)), {0, 1, 0});
    for (int c = 0; c < 4; ++c) EXPECT_LT(glm::distance(frame->worldFromDevice[c], truth[c]), 2e-3F) << c;
    EXPECT_NEAR(frame->ms.poseAge, 4.0, 1e-6);
    EXPECT_NEAR(frame->ms.latency, 64.0, 1e-6);

    scene.predictionSeconds = 0.0;
    wish.scene = std::make_shared<const Scene>(scene);
    EXPECT_NEAR(loop_.step(wish, kFrame)->eye->x, 0.3 * (t + 0.008), 1e-3);

    clock_.advance(Microseconds{300'000});
    frame = loop_.step(wish, kFrame);
    EXPECT_FALSE(frame->eye) << "lost";
    EXPECT_EQ(frame->worldFromDevice, scene.worldFromDevice);
    EXPECT_EQ(frame->ms.latency, 0.0);
    EXPECT_TRUE(loop_.settled());
}

TEST_F(SceneLoopTest, HandsOverFromViewerToViewer) {
    Scene scene = emptyScene();
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto push = [&](const char* name, double x) {
        ASSERT_TRUE(board->stream(name, PoseRole::head)->push({clock_.now(), true, {{x, 0.4, 0.4}, {1, 0, 0, 0}}}));
    };
    std::vector<std::string> followed;
    glm::vec3 last(0.0F);
    float farthest = 0.0F;
    bool gliding = false;
    for (int k = 0; k < 180; ++k) {
        push("Ada", 0.3 + 0.01 * k); // walks away
        push("Bo", -0.6);
        const auto frame = step(wish);
        ASSERT_TRUE(frame->eye);
        if (followed.empty() || followed.back() != frame->viewer) followed.push_back(frame->viewer);
        if (k > 0) farthest = std::max(farthest, glm::distance(*frame->eye, last));
        last = *frame->eye;
        gliding |= frame->handingOver;
    }
    EXPECT_EQ(followed, (std::vector<std::string>{"Ada", "Bo"}));
    EXPECT_TRUE(gliding);
    EXPECT_LT(farthest, 0.12F) << "no jump of the view";
}

TEST_F(SceneLoopTest, ShowStageHandsOnWhatTheLoopFound) {
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::split, waves(0.01, 3.0)));
    scene.items.push_back(itemOf(ItemRole::virtualOnly, LightItem{}, 2));
    scene.items.back().position = {0.2F, 0.5F, 0.1F};
    scene.worldFromDevice = glm::translate(glm::mat4(1.0F), {0.1F, 0.0F, 0.0F});
    const auto match = run(wishWith(scene), 0.5);
    ShowStage stage;
    const ShowFrame show = stage.frame(*match);
    EXPECT_EQ(show.scene, match->scene);
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
}

TEST_F(SceneLoopTest, ShowStageShowsTheTargetWhereTheLoopHasIt) {
    Scene scene = emptyScene();
    scene.items.push_back(itemOf(ItemRole::physical, TargetItem{}));
    MatchWish wish = wishWith(scene);
    wish.target = test::movingTarget();
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
} // namespace lumorph
