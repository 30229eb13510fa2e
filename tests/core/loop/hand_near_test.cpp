#include "core/loop/hand_near.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace lumorph {
namespace {

constexpr Microseconds kNow{1'000'000};
const Box kTablet{{-0.10F, 0.0F, -0.08F}, {0.10F, 0.05F, 0.08F}};

void see(PoseBoard& board, const char* name, PoseRole role, const glm::dvec3& at, Microseconds time = kNow,
         bool valid = true) {
    board.stream(name, role)->push({time, valid, {at, {1.0, 0.0, 0.0, 0.0}}});
}

double distanceTo(const glm::dvec3& hand, const glm::mat4& worldFromDevice = glm::mat4(1.0F)) {
    PoseBoard board;
    see(board, "hand", PoseRole::pointer, hand);
    return handDistance(board, kTablet, worldFromDevice, kNow).value_or(-1.0);
}

TEST(HandDistance, IsToTheNearestPointOfTheBox) {
    EXPECT_NEAR(distanceTo({0.0, 0.25, 0.0}), 0.20, 1e-6) << "above a face";
    EXPECT_NEAR(distanceTo({0.13, 0.09, 0.0}), 0.05, 1e-6) << "off an edge: 3, 4, 5";
    EXPECT_NEAR(distanceTo({0.12, 0.06, 0.10}), 0.03, 1e-6) << "off a corner: 2, 1, 2 is 3";
    EXPECT_EQ(distanceTo({0.05, 0.02, -0.03}), 0.0) << "inside";
    EXPECT_NEAR(distanceTo({0.0, -0.04, 0.0}), 0.04, 1e-6) << "below";
}

TEST(HandDistance, GoesWithTheDeviceWhereverItStandsAndHoweverItTurns) {
    glm::mat4 placed = glm::translate(glm::mat4(1.0F), {1.0F, 0.7F, -2.0F});
    EXPECT_NEAR(distanceTo({1.0, 0.95, -2.0}, placed), 0.20, 1e-6);
    // On its side, by a quarter turn about z: what was its height of 0.05 points to -x.
    placed = glm::rotate(placed, glm::radians(90.0F), {0.0F, 0.0F, 1.0F});
    EXPECT_NEAR(distanceTo({0.75, 0.7, -2.0}, placed), 0.20, 1e-6);
    EXPECT_NEAR(distanceTo({1.0, 0.95, -2.0}, placed), 0.15, 1e-6);
}

TEST(HandDistance, CountsHandsOnlyAndTheNearestOfThem) {
    PoseBoard board;
    see(board, "anna", PoseRole::head, {0.0, 0.06, 0.0});
    see(board, "tablet", PoseRole::device, {0.0, 0.0, 0.0});
    EXPECT_FALSE(handDistance(board, kTablet, glm::mat4(1.0F), kNow)) << "nobody sees a hand";
    see(board, "left", PoseRole::pointer, {0.0, 0.55, 0.0});
    see(board, "right", PoseRole::pointer, {0.0, 0.35, 0.0});
    EXPECT_NEAR(handDistance(board, kTablet, glm::mat4(1.0F), kNow).value_or(-1.0), 0.30, 1e-6);
    see(board, "third", PoseRole::pointer, {0.0, 0.95, 0.0});
    EXPECT_NEAR(handDistance(board, kTablet, glm::mat4(1.0F), kNow).value_or(-1.0), 0.30, 1e-6) << "whoever came last";
}

TEST(HandDistance, AHandThatIsLostOrLongSilentIsNotSensed) {
    PoseBoard board;
    see(board, "hand", PoseRole::pointer, {0.0, 0.1, 0.0});
    EXPECT_TRUE(handDistance(board, kTablet, glm::mat4(1.0F), kNow + Microseconds{200'000}));
    EXPECT_FALSE(handDistance(board, kTablet, glm::mat4(1.0F), kNow + Microseconds{300'000})) << "silent for 0.3 s";
    see(board, "hand", PoseRole::pointer, {0.0, 0.1, 0.0}, kNow + Microseconds{1}, false);
    EXPECT_FALSE(handDistance(board, kTablet, glm::mat4(1.0F), kNow + Microseconds{2})) << "lost";
}

TEST(HandDistance, WithoutABoxThereIsNothingToBeNear) {
    PoseBoard board;
    see(board, "hand", PoseRole::pointer, {0.0, 0.0, 0.0});
    EXPECT_FALSE(handDistance(board, Box{}, glm::mat4(1.0F), kNow));
}

TEST(HandShape, ReachesFromTheTipOverTheBodyToTheArm) {
    Installation room;
    const Pose body{{0.1, 0.3, 0.2}, {1.0, 0.0, 0.0, 0.0}};
    const std::vector<Capsule> ball = handShape(room, body, std::nullopt);
    ASSERT_EQ(ball.size(), 1U) << "nobody knows where its fingers point";
    EXPECT_EQ(ball[0].from, ball[0].to);
    EXPECT_EQ(ball[0].from, glm::vec3(body.position));

    const std::vector<Capsule> visitors = handShape(room, body, glm::vec3(0.1F, 0.5F, 0.9F));
    ASSERT_EQ(visitors.size(), 2U);
    EXPECT_LT(visitors[0].from.z, visitors[0].to.z) << "fingers point away from him";
    EXPECT_GT(visitors[1].to.z, 0.5F) << "and the arm comes from him";

    room.pointerTip = {0.0F, -0.1F, 0.0F};
    room.worldFromTracker = glm::translate(glm::mat4(1.0F), {1.0F, 0.0F, 0.0F});
    const std::vector<Capsule> hand = handShape(room, body, glm::vec3(0.1F, 0.5F, 0.9F));
    ASSERT_EQ(hand.size(), 2U);
    const auto isAt = [](const glm::vec3& point, const glm::vec3& expected) {
        return glm::distance(point, expected) < 1e-5F;
    };
    EXPECT_TRUE(isAt(hand[0].from, {1.1F, 0.2F, 0.2F})) << "the tip, in the room";
    EXPECT_TRUE(isAt(hand[0].to, {1.1F, 0.3F, 0.2F}));
    EXPECT_EQ(hand[1].from, hand[0].to);
    EXPECT_NEAR(hand[1].to.x, 1.1F, 1e-5F);
    EXPECT_GT(hand[1].to.y, 0.5F) << "the arm goes on in the finger's direction";
    EXPECT_LT(hand[0].radius, hand[1].radius);
}

} // namespace
} // namespace lumorph
