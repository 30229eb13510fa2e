#include "core/loop/tracked_room.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/loop/hand_near.h"
#include "core/loop/viewer_stage.h"
#include "tests/core/loop/scene_loop_fixture.h"

// R25: where trackers, device, pointer and eye are in the room was measured, and is applied to every pose.

namespace lumorph::test {
namespace {

const Pose kSeen{{0.31, -0.2, 0.77}, glm::normalize(glm::dquat(0.8, 0.1, -0.5, 0.3))};

glm::mat4 rigid(const glm::vec3& place, float degrees, const glm::vec3& axis) {
    return glm::rotate(glm::translate(glm::mat4(1.0F), place), glm::radians(degrees), glm::normalize(axis));
}

/// A room whose figures all say something.
Installation measuredRoom() {
    Installation room;
    room.worldFromTracker = rigid({0.4F, 0.1F, -0.7F}, 130.0F, {0.1F, 1.0F, 0.2F});
    room.bodyFromDevice = rigid({0.01F, -0.02F, 0.03F}, 7.0F, {1.0F, 0.0F, 0.5F});
    room.pointerTip = {0.003F, -0.16F, 0.002F};
    room.eyeFromHead = {0.03F, -0.05F, -0.08F};
    return room;
}

double farthest(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) most = std::max(most, std::abs(a[column][row] - b[column][row]));
    return most;
}

TEST(TrackedRoom, FiguresThatSayNothingLeaveEveryPoseBitForBit) {
    const Installation room;
    for (const PoseRole role : {PoseRole::head, PoseRole::device, PoseRole::pointer})
        EXPECT_EQ(inRoom(room, role, kSeen), kSeen);
    EXPECT_EQ(bodyInRoom(room, kSeen), kSeen);
}

TEST(TrackedRoom, EachRoleIsThatOfItsMatrices) {
    const Installation room = measuredRoom();
    const glm::dmat4 body = glm::dmat4(room.worldFromTracker) * matrixOf(kSeen);
    EXPECT_LT(farthest(matrixOf(bodyInRoom(room, kSeen)), body), 1e-6);
    EXPECT_LT(farthest(matrixOf(inRoom(room, PoseRole::head, kSeen)), body), 1e-6);
    EXPECT_LT(farthest(matrixOf(inRoom(room, PoseRole::device, kSeen)), body * glm::dmat4(room.bodyFromDevice)), 1e-6);
    const glm::dvec3 tip(body * glm::dvec4(glm::dvec3(room.pointerTip), 1.0));
    EXPECT_LT(glm::distance(inRoom(room, PoseRole::pointer, kSeen).position, tip), 1e-6);
}

TEST(TrackedRoom, WhatATrackerSaysLeadsBackToWhatStandsThere) {
    const Installation room = measuredRoom();
    for (const PoseRole role : {PoseRole::device, PoseRole::pointer}) {
        const Pose back = inRoom(room, role, trackedOf(room, role, kSeen));
        EXPECT_LT(farthest(matrixOf(back), matrixOf(kSeen)), 1e-6);
    }
    const Pose head = inRoom(room, PoseRole::head, trackedOf(room, PoseRole::head, kSeen));
    EXPECT_LT(glm::distance(head.position + head.rotation * glm::dvec3(room.eyeFromHead), kSeen.position), 1e-6);
    EXPECT_GT(glm::distance(trackedOf(room, PoseRole::device, kSeen).position,
                            trackedOf(room, PoseRole::pointer, kSeen).position),
              0.1);
    for (const PoseRole role : {PoseRole::head, PoseRole::device, PoseRole::pointer})
        EXPECT_EQ(trackedOf(Installation(), role, kSeen), kSeen);
}

TEST(TrackedRoom, AHandIsAsNearAsItsTipOrItsBody) {
    const Box box{{-0.1F, 0.0F, -0.08F}, {0.1F, 0.05F, 0.08F}};
    constexpr Microseconds kNow{1'000'000};
    Installation room;
    room.worldFromTracker = glm::translate(glm::mat4(1.0F), {0.0F, 1.0F, 0.0F});
    PoseBoard board;
    board.stream("stick", PoseRole::pointer)->push({kNow, true, {{0.0, -0.7, 0.0}, {1, 0, 0, 0}}});
    const auto distance = [&] { return handDistance(board, box, glm::mat4(1.0F), kNow, room).value_or(-1.0); };
    EXPECT_NEAR(distance(), 0.25, 1e-6) << "the body, 0.3 m over the table";
    room.pointerTip = {0.0F, -0.16F, 0.0F};
    EXPECT_NEAR(distance(), 0.09, 1e-6) << "its tip";
    room.pointerTip = {0.0F, 0.16F, 0.0F};
    EXPECT_NEAR(distance(), 0.25, 1e-6) << "the tip points away: still the body";
}

TEST(LookAhead, PosesThatAreOlderThanTheySayArePredictedFarther) {
    Installation room;
    room.predictionSeconds = 0.06;
    room.trackerSeconds = 0.012;
    EXPECT_DOUBLE_EQ(lookAhead(room, 0.02), 0.072);
    EXPECT_DOUBLE_EQ(lookAhead(room, 0.09), 0.102);
    room.predictionSeconds = 0.0;
    EXPECT_EQ(lookAhead(room, 0.09), 0.0) << "nothing is predicted";
}

TEST_F(SceneLoopTest, DeviceAndEyeLieWhereTheMeasuredRoomPutsThem) {
    SceneInRoom scene = emptyScene();
    const Installation room = measuredRoom();
    scene.worldFromTracker = room.worldFromTracker;
    scene.bodyFromDevice = room.bodyFromDevice;
    scene.eyeFromHead = room.eyeFromHead;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    (void)step(wish);
    for (const auto& [name, role] : {std::pair{"tablet", PoseRole::device}, {"Ada", PoseRole::head}})
        ASSERT_TRUE(board->stream(name, role)->push({clock_.now(), true, kSeen}));
    const auto frame = step(wish, 0.01);
    const glm::dmat4 body = glm::dmat4(room.worldFromTracker) * matrixOf(kSeen);
    EXPECT_LT(farthest(frame->worldFromDevice, body * glm::dmat4(room.bodyFromDevice)), 1e-6);
    ASSERT_TRUE(frame->eye);
    const glm::dvec3 eye(body * glm::dvec4(glm::dvec3(room.eyeFromHead), 1.0));
    EXPECT_LT(glm::distance(glm::dvec3(*frame->eye), eye), 1e-6);
}

TEST_F(SceneLoopTest, OlderPosesAreTakenFartherAndSaidToBeOlder) {
    SceneInRoom scene = emptyScene();
    scene.predictionSeconds = 0.06;
    scene.trackerSeconds = 0.02;
    MatchWish wish = wishWith(scene);
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto head = board->stream("Ada", PoseRole::head);
    std::shared_ptr<const MatchFrame> frame;
    double t = 0.0;
    for (int k = 0; k < 120; ++k) {
        clock_.advance(Microseconds{8'000});
        t = 1e-6 * static_cast<double>(clock_.now().count());
        // What it says of now is where Ada was 20 ms ago.
        ASSERT_TRUE(head->push({clock_.now(), true, {{0.3 * (t - 0.02), 0.5, 0.4}, {1, 0, 0, 0}}}));
        frame = loop_.step(wish, kFrame);
    }
    ASSERT_TRUE(frame->eye);
    EXPECT_NEAR(frame->eye->x, 0.3 * (t + 0.06), 1e-3);
    EXPECT_NEAR(frame->ms.poseAge, 20.0, 1e-6);
    EXPECT_NEAR(frame->ms.latency, 80.0, 1e-6);
}

} // namespace
} // namespace lumorph::test
