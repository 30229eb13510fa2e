#include "app/studio/calibration/live_capture.h"

#include <algorithm>
#include <cstdio>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/studio/calibration/chain.h"
#include "app/studio/calibration/chain_live.h"
#include "calibration/lab/registration_lab.h"
#include "tests/support/cut_tablet.h"

// A person with a pointer whom the studio follows step by step, without a window: the lab's hands and tracker.

namespace lumorph::studio {
namespace {

struct LiveCaptureTest : testing::Test {
    const std::shared_ptr<const Rig> rig = std::make_shared<const Rig>(test::cutTablet());
    const Installation believed = defaultInstallation();
    const Installation truth = trueRoom(believed, rig->actuators(), 11);
    TrackerLab lab{truth, 3};

    static void feed(LiveCapture& capture, PoseRole role, const PoseTrack& track) {
        for (const TimedPose& at : track.poses) capture.add(role, at.seconds, at.pose);
    }
    /// As frames of one tracker: the poses of both bodies at each time.
    static void feed(LiveCapture& capture, const Touch& touch, PoseRole body) {
        for (std::size_t k = 0; k < touch.pointer.poses.size(); ++k) {
            if (touch.body) capture.add(body, touch.body->poses[k].seconds, touch.body->poses[k].pose);
            capture.add(PoseRole::pointer, touch.pointer.poses[k].seconds, touch.pointer.poses[k].pose);
        }
    }
    static const ChainLink& linkOf(LinkId id) { return *std::ranges::find(chainLinks(), id, &ChainLink::id); }
    LiveCapture captureOf(LinkId id, const Installation& room) {
        return LiveCapture({linkOf(id).liveRoles, linkOf(id).liveSteps(*rig, room)}, glm::dvec3(room.pointerTip));
    }
    /// What the link makes of it; the room with that.
    Installation measured(LinkId id, const LiveCapture& capture, Installation room) {
        EXPECT_TRUE(capture.isComplete()) << "step " << capture.step() << ": " << capture.trouble();
        if (!capture.isComplete()) return room;
        LiveBench bench(capture.plan(), capture.takes(), false);
        const StageSite site{rig, room};
        const StageOutcome outcome = outcomeOf(measureStage(*linkOf(id).stage, site, bench), site.room);
        EXPECT_TRUE(outcome.isGood) << wordsOf(outcome).summary.toStdString();
        if (outcome.changesRoom) linkOf(id).stage->apply(roomOf(outcome.result), room);
        return room;
    }
    /// Where the lab's first projector throws a pixel.
    [[nodiscard]] glm::dvec3 onTable(const glm::dvec2& pixel) const {
        const CalibratedCamera& camera = truth.projectors.front().camera;
        const glm::dvec3 from = positionOf(camera), along = directionOf(camera, pixel);
        return from - from.y / along.y * along;
    }
    Installation withPointer() {
        LiveCapture capture = captureOf(LinkId::pointer, believed);
        feed(capture, PoseRole::pointer, lab.swing({0.2, 0.0, 0.1}));
        for (int tries = 0; tries < 60 && !capture.isComplete(); ++tries) {
            const double at = double((capture.step() + 1) / 2);
            feed(capture, lab.touchDimple("dimple", {0.1 * at, 0.0, -0.05 * at}), PoseRole::device);
        }
        return measured(LinkId::pointer, capture, believed);
    }
};

TEST_F(LiveCaptureTest, WholeChainIsMeasuredByTouchingStepByStep) {
    Installation room = withPointer();
    const float tip = glm::distance(room.pointerTip, truth.pointerTip);
    LiveCapture dots = captureOf(LinkId::tracker, room);
    while (!dots.isComplete()) {
        const std::size_t step = dots.step();
        feed(dots, lab.touchDot("dot", onTable(dots.plan().steps[step].dot->pixel)), PoseRole::device);
        ASSERT_EQ(dots.step(), step + 1) << dots.trouble();
    }
    room = measured(LinkId::tracker, dots, room);
    LiveCapture corners = captureOf(LinkId::device, room);
    while (!corners.isComplete()) {
        const std::size_t step = corners.step();
        feed(corners, lab.touchDevice("corner", corners.plan().steps[step].corner->onModel), PoseRole::device);
        ASSERT_EQ(corners.step(), step + 1) << corners.trouble();
    }
    room = measured(LinkId::device, corners, room);
    LiveCapture marks = captureOf(LinkId::eye, room);
    int turn = 0;
    while (!marks.isComplete()) {
        const std::size_t step = marks.step();
        const glm::dvec3 eye = glm::dvec3(truth.eye) + 0.06 * glm::dvec3(turn % 3 - 1, turn % 2, (turn / 3) % 3 - 1);
        ++turn;
        feed(marks, lab.align("mark", onTable(marks.plan().steps[step].dot->pixel), eye).touch, PoseRole::head);
        ASSERT_EQ(marks.step(), step + 1) << marks.trouble();
    }
    room = measured(LinkId::eye, marks, room);
    // Where a point of the tracker's world near the table lies, by what was measured and in truth.
    const glm::vec4 near = glm::inverse(truth.worldFromTracker) * glm::vec4(0.0F, 0.1F, 0.0F, 1.0F);
    const float tracker =
        glm::distance(glm::vec3(room.worldFromTracker * near), glm::vec3(truth.worldFromTracker * near));
    const float device = glm::distance(glm::vec3(room.bodyFromDevice[3]), glm::vec3(truth.bodyFromDevice[3]));
    const float eye = glm::distance(room.eyeFromHead, truth.eyeFromHead);
    std::printf("measured by touching: tip %.2f mm, tracker %.2f mm, device %.2f mm, eye %.2f mm from the truth\n",
                1e3F * tip, 1e3F * tracker, 1e3F * device, 1e3F * eye);
    EXPECT_LT(tip, 0.001F);
    EXPECT_LT(tracker, 0.001F);
    EXPECT_LT(device, 0.001F);
    EXPECT_LT(eye, 0.005F);
}

TEST_F(LiveCaptureTest, RestThatIsNoNewOneDoesNotCount) {
    const Installation room = withPointer();
    LiveCapture dots = captureOf(LinkId::tracker, room);
    const glm::dvec3 first = onTable(dots.plan().steps[0].dot->pixel),
                     second = onTable(dots.plan().steps[1].dot->pixel);
    feed(dots, lab.touchDot("dot", first), PoseRole::device);
    ASSERT_EQ(dots.step(), 1U);
    feed(dots, lab.touchDot("dot", first), PoseRole::device);
    EXPECT_EQ(dots.step(), 1U) << "who is slow to leave touches nothing new";
    EXPECT_TRUE(dots.trouble().empty());
    feed(dots, lab.touchDot("dot", second), PoseRole::device);
    ASSERT_EQ(dots.step(), 2U);
    feed(dots, lab.touchDot("dot", first), PoseRole::device);
    EXPECT_EQ(dots.step(), 2U);
    EXPECT_NE(dots.trouble().find("rested here before"), std::string::npos) << dots.trouble();
    dots.takeBack();
    EXPECT_EQ(dots.step(), 1U);
    EXPECT_TRUE(dots.trouble().empty());
    feed(dots, lab.touchDot("dot", second), PoseRole::device);
    EXPECT_EQ(dots.step(), 2U);
}

TEST_F(LiveCaptureTest, SwingsThatTellNoTipAreRefusedAtOnce) {
    LiveCapture capture = captureOf(LinkId::pointer, believed);
    for (int k = 0; capture.trouble().empty() && k < 2000; ++k) { // about one axis: along it the tip stays open
        const double t = k / 60.0;
        capture.add(PoseRole::pointer, t, Pose{{0.1, 0.2, 0.3}, rotationOfTurn({0.8 * std::sin(t), 0.0, 0.0})});
    }
    EXPECT_EQ(capture.step(), 0U);
    EXPECT_FALSE(capture.trouble().empty());
    std::printf("one axis: %s\n", capture.trouble().c_str());
    feed(capture, PoseRole::pointer, lab.swing({0.2, 0.0, 0.1}));
    EXPECT_EQ(capture.step(), 1U) << "the next swings count afresh: " << capture.trouble();
    EXPECT_TRUE(capture.trouble().empty());
}

TEST_F(LiveCaptureTest, LostBodyEndsNoStep) {
    const Installation room = withPointer();
    LiveCapture corners = captureOf(LinkId::device, room);
    const Touch touch = lab.touchDevice("corner", corners.plan().steps[0].corner->onModel);
    feed(corners, PoseRole::pointer, touch.pointer);
    EXPECT_EQ(corners.step(), 0U) << "where the device is, nobody saw";
    EXPECT_EQ(corners.missing(), std::vector<PoseRole>{PoseRole::device});
    // The pointer blinks in the middle of a rest: the rest begins anew.
    const Touch next = lab.touchDevice("corner", corners.plan().steps[0].corner->onModel);
    for (std::size_t k = 0; k < next.pointer.poses.size(); ++k) {
        const TimedPose &pointer = next.pointer.poses[k], &body = next.body->poses[k];
        corners.add(PoseRole::device, body.seconds, body.pose);
        corners.add(PoseRole::pointer, pointer.seconds,
                    k == next.pointer.poses.size() / 2 ? std::nullopt : std::optional(pointer.pose));
    }
    EXPECT_EQ(corners.step(), 0U);
}

} // namespace
} // namespace lumorph::studio
