#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/loop/show_stage.h"
#include "core/loop/viewer_stage.h"
#include "tests/core/loop/scene_loop_fixture.h"
#include "tests/support/not_a_number.h"

// A scene's time, when the loop may rest, and who looks at it.

namespace lumorph::test {
namespace {

TEST_F(SceneLoopTest, SceneTimePlaysPausesAndIsSoughtOnce) {
    SceneInRoom scene = emptyScene();
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
    wish.sceneSeek.reset();
    wish.scenePlaying = true;
    EXPECT_GT(step(wish)->sceneSeconds, 1.5);
    wish.sceneSeek = 1.5;
    EXPECT_EQ(step(wish)->sceneSeconds, 1.5) << "the same moment, asked for anew";
    wish.sceneSeek = kNan;
    EXPECT_THROW((void)step(wish), InvalidInput);
}

TEST(LookAhead, IsByTheLongerOfBothDelays) {
    Installation room;
    room.predictionSeconds = 0.06;
    EXPECT_EQ(lookAhead(room, 0.02), 0.06);
    EXPECT_EQ(lookAhead(room, 0.09), 0.09) << "drawing takes longer than was set";
    room.predictionSeconds = 0.0;
    EXPECT_EQ(lookAhead(room, 0.09), 0.0) << "nothing is predicted";
}

TEST_F(SceneLoopTest, APointerAloneIsNoViewerButItsShadowMoves) {
    SceneInRoom scene = emptyScene();
    scene.eye = {0.1F, 0.5F, 0.6F};
    scene.predictionSeconds = 0.06;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto see = [&](const char* name, PoseRole role, const glm::dvec3& at) {
        (void)board->stream(name, role)->push({clock_.now(), true, {at, {1, 0, 0, 0}}});
    };
    (void)step(wish);
    see("stick", PoseRole::pointer, {0.0, 0.1, 0.0});
    EXPECT_TRUE(anyTracked(*board, clock_.now()));
    auto frame = step(wish);
    EXPECT_FALSE(loop_.settled()) << "a hand keeps light from the device, elsewhere in each frame";
    EXPECT_EQ(frame->ms.poseAge, 0.0) << "no place that is painted waited for it";
    EXPECT_EQ(frame->ms.latency, 0.0);
    ASSERT_TRUE(frame->eye);
    EXPECT_EQ(*frame->eye, scene.eye) << "nobody's head is tracked: the simulated eye stays";
    EXPECT_EQ(frame->worldFromDevice, scene.worldFromDevice);
    EXPECT_TRUE(frame->viewer.empty());

    // An old pointer does not make a head look late.
    see("head", PoseRole::head, {0.0, 0.4, 0.5});
    frame = step(wish, 0.01);
    EXPECT_FALSE(loop_.settled());
    EXPECT_EQ(frame->viewer, "head");
    EXPECT_NEAR(frame->ms.poseAge, 10.0, 1e-9);
    EXPECT_NEAR(frame->ms.latency, 70.0, 1e-9);
}

TEST_F(SceneLoopTest, RestsOnlyWhenNothingInTheSceneMoves) {
    const auto lamp = [](double spin) {
        SceneInRoom scene = emptyScene();
        SceneItem light = itemOf(ItemRole::virtualOnly, LightItem{});
        light.position = {0.3F, 0.5F, 0.1F};
        light.motion.spin = spin;
        scene.items.push_back(light);
        return scene;
    };
    const auto texture = [](glm::vec2 velocity, const char* image) {
        SceneInRoom scene = emptyScene();
        scene.device.material.normalMaps[1].image = image;
        scene.device.material.normalMaps[1].velocity = velocity;
        return scene;
    };
    const auto hidden = [&] {
        SceneInRoom scene = lamp(1.0);
        scene.items.front().visible = false;
        return scene;
    };
    struct Case {
        const char* what;
        SceneInRoom scene;
        bool moves;
    };
    FogItem drifting;
    FogItem still;
    still.drift = {0.0F, 0.0F};
    SceneInRoom fog = emptyScene();
    fog.items.push_back(itemOf(ItemRole::virtualOnly, drifting));
    SceneInRoom standing = emptyScene();
    standing.items.push_back(itemOf(ItemRole::virtualOnly, waves(0.01, 0.0)));
    SceneInRoom calm = emptyScene();
    calm.items.push_back(itemOf(ItemRole::virtualOnly, still));
    for (const Case& c : {Case{"nothing", emptyScene(), false}, Case{"light", lamp(0.0), false},
                          Case{"spinning light", lamp(0.2), true}, Case{"hidden", hidden(), false},
                          Case{"moving texture", texture({0.0F, 0.1F}, "waves"), true},
                          Case{"no texture", texture({0.0F, 0.1F}, ""), false}, Case{"fog", fog, true},
                          Case{"waves that stand", standing, false}, Case{"calm fog", calm, false}}) {
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
    SceneInRoom scene = emptyScene();
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
    SceneInRoom scene = emptyScene();
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
    SceneInRoom scene = emptyScene();
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

    // Measured 8 ms ago; no pose is taken farther than 150 ms from where it was measured.
    for (const auto& [delay, ahead] : {std::pair{0.03, 0.068}, {0.1, 0.108}, {0.8, 0.15}}) {
        wish.lightDelay = delay;
        const auto slow = loop_.step(wish, kFrame);
        EXPECT_NEAR(slow->ms.latency, 1e3 * ahead, 1e-6) << delay;
        EXPECT_NEAR(slow->eye->x, 0.3 * (t + ahead), 1e-3) << delay;
    }

    scene.predictionSeconds = 0.0;
    setSceneInRoom(wish, scene);
    EXPECT_NEAR(loop_.step(wish, kFrame)->eye->x, 0.3 * (t + 0.008), 1e-3);

    clock_.advance(Microseconds{300'000});
    frame = loop_.step(wish, kFrame);
    EXPECT_FALSE(frame->eye) << "lost";
    EXPECT_EQ(frame->worldFromDevice, scene.worldFromDevice);
    EXPECT_EQ(frame->ms.latency, 0.0);
    EXPECT_TRUE(loop_.settled());
}

TEST_F(SceneLoopTest, WhatWaitsToBeDrawnIsPredictedAnewFromTheNewestPose) {
    SceneInRoom scene = emptyScene();
    scene.predictionSeconds = 0.083;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto device = board->stream("tablet", PoseRole::device);
    const auto head = board->stream("Ada", PoseRole::head);
    // A hand that turns back and forth: prediction is wrong where it turns.
    const auto x = [](double t) { return 0.06 * std::sin(5.0 * t); };
    const auto push = [&] {
        const double t = 1e-6 * static_cast<double>(clock_.now().count());
        ASSERT_TRUE(device->push({clock_.now(), true, {{x(t), 0.1, 0.0}, {1, 0, 0, 0}}}));
        ASSERT_TRUE(head->push({clock_.now(), true, {{0.0, 0.5, 0.4 + x(t)}, {1, 0, 0, 0}}}));
        clock_.advance(Microseconds{8'000});
    };
    double early = 0.0, late = 0.0;
    for (int k = 0; k < 200; ++k) {
        push();
        const auto frame = loop_.step(wish, 0.008);
        if (k < 60) continue;
        const NewestView same = newestView(*frame);
        EXPECT_EQ(same.worldFromDevice, frame->worldFromDevice) << "nothing newer is known";
        EXPECT_EQ(same.eye, frame->eye);
        const double then = 1e-6 * static_cast<double>(frame->lightTime.count());
        EXPECT_NEAR(then, 1e-6 * static_cast<double>(frame->time.count()) + 0.083, 1e-6);
        for (int waits = 0; waits < 4; ++waits) push(); // 32 ms, until it is drawn
        const NewestView newest = newestView(*frame);
        EXPECT_NEAR(frame->ms.latency - newest.latency, 32.0, 1e-6);
        early += std::pow(static_cast<double>(frame->worldFromDevice[3].x) - x(then), 2.0);
        late += std::pow(static_cast<double>(newest.worldFromDevice[3].x) - x(then), 2.0);
        ASSERT_TRUE(newest.eye);
        EXPECT_NEAR(newest.eye->z - 0.4F, newest.worldFromDevice[3].x, 1e-3);
        const ShowFrame shown = ShowStage().frame(*frame, newest);
        EXPECT_EQ(shown.worldFromDevice, newest.worldFromDevice);
        EXPECT_EQ(shown.eye, newest.eye);
    }
    EXPECT_LT(std::sqrt(late), 0.6 * std::sqrt(early));
}

TEST_F(SceneLoopTest, HandsArePredictedForTheMomentOfTheLightToo) {
    SceneInRoom scene = emptyScene();
    scene.predictionSeconds = 0.06;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto hand = board->stream("Ada's hand", PoseRole::pointer);
    std::shared_ptr<const MatchFrame> frame = step(wish);
    EXPECT_TRUE(frame->hands.empty());
    double t = 0.0;
    for (int k = 0; k < 120; ++k) {
        t = 1e-6 * static_cast<double>(clock_.now().count());
        ASSERT_TRUE(hand->push({clock_.now(), true, {{0.3 * t, 0.2, 0.0}, {1, 0, 0, 0}}}));
        frame = loop_.step(wish, kFrame);
        EXPECT_FALSE(loop_.settled()) << "its shadow moves";
        clock_.advance(Microseconds{8'000});
    }
    ASSERT_EQ(frame->hands.size(), 2U) << "hand and arm";
    const glm::vec3 middle = 0.5F * (frame->hands[0].from + frame->hands[0].to);
    EXPECT_NEAR(middle.x, 0.3 * (t + 0.06), 1e-3);
    EXPECT_EQ(ShowStage().frame(*frame).hands, frame->hands);
    EXPECT_EQ(frame->eye, scene.eye) << "a hand is no head";
    clock_.advance(Microseconds{300'000});
    EXPECT_TRUE(loop_.step(wish, kFrame)->hands.empty()) << "lost";
    EXPECT_TRUE(loop_.settled());
}

TEST_F(SceneLoopTest, AfterAStopLightFollowsWhatTheTrackerSeesThen) {
    SceneInRoom scene = emptyScene();
    scene.predictionSeconds = 0.06;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto device = board->stream("tablet", PoseRole::device);
    const auto head = board->stream("Ada", PoseRole::head);
    // Both swing by 0.2 m, at 0.3 m/s where they are fastest.
    const auto x = [](double t) { return 0.2 * std::sin(1.5 * t); };
    const auto seconds = [&] { return 1e-6 * static_cast<double>(clock_.now().count()); };
    const auto push = [&] {
        ASSERT_TRUE(head->push({clock_.now(), true, {{x(seconds()), 0.5, 0.4}, {1, 0, 0, 0}}}));
        ASSERT_TRUE(device->push({clock_.now(), true, {{0.0, 0.1, -x(seconds())}, {1, 0, 0, 0}}}));
    };
    const auto offOf = [&](const MatchFrame& frame, double ahead) {
        const double at = x(seconds() + ahead);
        return std::max(std::abs(frame.eye->x - at), std::abs(frame.worldFromDevice[3].z + at));
    };
    std::shared_ptr<const MatchFrame> frame;
    for (const bool tracksMeanwhile : {true, false})
        for (const double stop : {3.0, 3.7, 0.2, 3.2}) {
            for (int k = 0; k < 120; ++k) {
                clock_.advance(Microseconds{8'000});
                push();
                frame = loop_.step(wish, 0.008);
            }
            ASSERT_TRUE(frame->eye);
            EXPECT_LT(offOf(*frame, 0.06), 2e-3);
            for (int k = 0; k < std::lround(stop / 0.008); ++k) {
                clock_.advance(Microseconds{8'000});
                if (tracksMeanwhile) push();
            }
            frame = loop_.step(wish, stop);
            if (tracksMeanwhile) {
                ASSERT_TRUE(frame->eye);
                EXPECT_LT(offOf(*frame, 0.06), 2e-3) << stop;
            } else if (stop > 1.0) {
                EXPECT_FALSE(frame->eye) << "nobody knows where the head is now";
                EXPECT_EQ(frame->worldFromDevice, scene.worldFromDevice);
            }
            // The first poses after a stop say where they are, and nothing of a motion across it.
            for (int k = 0; k < 12; ++k) {
                clock_.advance(Microseconds{8'000});
                push();
                frame = loop_.step(wish, 0.008);
                ASSERT_TRUE(frame->eye);
                EXPECT_LT(offOf(*frame, 0.06), 0.3 * 0.06 + 2e-3) << stop << " s, sample " << k;
            }
        }
}

TEST_F(SceneLoopTest, ASceneNeedsARoom) {
    MatchWish wish = wishWith(emptyScene());
    const auto frame = step(wish);
    EXPECT_EQ(frame->installation, wish.installation);
    wish.installation = nullptr;
    EXPECT_THROW((void)step(wish), InvalidInput);
    wish.scene = nullptr;
    EXPECT_NO_THROW((void)step(wish));
}

TEST_F(SceneLoopTest, ATrackedHeadSeesFromItsEyeAsItIsTurned) {
    SceneInRoom scene = emptyScene();
    scene.eyeFromHead = {0.03F, 0.02F, -0.1F};
    MatchWish wish = wishWith(scene);
    EXPECT_EQ(step(wish)->eye, scene.eye) << "the simulated eye is an eye already";
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto head = board->stream("Ada", PoseRole::head);
    const double half = std::sqrt(0.5);
    const struct {
        const char* what;
        glm::dquat rotation; // w, x, y, z
        glm::dvec3 eye;
    } cases[] = {
        {"as the world", {1.0, 0.0, 0.0, 0.0}, {0.13, 0.52, 0.3}},
        {"a quarter of a turn to the left", {half, 0.0, half, 0.0}, {0.0, 0.52, 0.37}},
        {"a quarter of a turn upwards", {half, half, 0.0, 0.0}, {0.13, 0.6, 0.42}},
        {"upside down", {0.0, 0.0, 0.0, 1.0}, {0.07, 0.48, 0.3}},
    };
    for (const auto& c : cases) {
        std::shared_ptr<const MatchFrame> frame;
        for (int k = 0; k < 120; ++k) { // longer than it was turned before
            ASSERT_TRUE(head->push({clock_.now(), true, {{0.1, 0.5, 0.4}, c.rotation}}));
            frame = step(wish);
        }
        ASSERT_TRUE(frame->eye) << c.what;
        EXPECT_LT(glm::distance(glm::dvec3(*frame->eye), c.eye), 1e-5) << c.what;
    }
}

TEST_F(SceneLoopTest, HandsOverFromViewerToViewer) {
    SceneInRoom scene = emptyScene();
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

} // namespace
} // namespace lumorph::test
