#include "app/studio/shell/loop_text.h"

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

MatchFrame toldFrame() {
    MatchFrame frame;
    frame.matched = true;
    frame.target = std::make_shared<MatchTarget>();
    frame.ms.match = 0.0213;
    frame.ms.refine = 3.14;
    return frame;
}

TEST(LoopText, SaysRateAndTimes) {
    MatchFrame frame = toldFrame();
    EXPECT_EQ(loopText(&frame, frame.ms, 59.8, false), "60 Hz, matched in 0.02 ms + refined 3.1 ms");
    frame.ms.refine = 0.0;
    EXPECT_EQ(loopText(&frame, frame.ms, 59.8, false), "60 Hz, matched in 0.02 ms");
    EXPECT_EQ(loopText(&frame, frame.ms, 59.8, true), "Stopped, matched in 0.02 ms");
    frame.matched = false;
    EXPECT_EQ(loopText(&frame, frame.ms, 30.0, false), "30 Hz, not matching");
    frame.target = nullptr;
    EXPECT_EQ(loopText(&frame, frame.ms, 0.0, false), "Idle, no target");
    frame.splitStrokes = {0.5};
    EXPECT_EQ(loopText(&frame, frame.ms, 59.8, false), "60 Hz, servos follow the scene");
    EXPECT_EQ(loopText(nullptr, {}, 0.0, false), "Idle");
}

TEST(LoopText, KeepsTheTimesOfTheLastMatchWhileNothingChanges) {
    MatchFrame frame = toldFrame();
    MatchTimes last = lastMatch({}, frame);
    frame.ms = {}; // the device moves on to what was found
    last = lastMatch(last, frame);
    EXPECT_EQ(loopText(&frame, last, 0.0, false), "Idle, matched in 0.02 ms + refined 3.1 ms");
    frame.ms.refine = 1.5; // refinement goes on where its time had ended
    last = lastMatch(last, frame);
    EXPECT_EQ(loopText(&frame, last, 0.0, false), "Idle, matched in 0.02 ms + refined 1.5 ms");
    frame.ms = {};
    frame.ms.match = 0.04; // a new match by voting
    last = lastMatch(last, frame);
    EXPECT_EQ(loopText(&frame, last, 60.0, false), "60 Hz, matched in 0.04 ms");
    frame.matched = false;
    EXPECT_EQ(lastMatch(last, frame).match, 0.0) << "what comes next is another match";
    frame.matched = true;
    EXPECT_EQ(loopText(&frame, {}, 0.0, false), "Idle, matched");
}

TEST(LoopText, WarnsOfWhatTheDeviceCannotShow) {
    MatchFrame frame = toldFrame();
    EXPECT_TRUE(frameWarnings(&frame).empty());
    EXPECT_TRUE(frameWarnings(nullptr).empty());
    frame.shareBeyondFrame = 0.004;
    EXPECT_TRUE(frameWarnings(&frame).empty()) << "less than a hundredth is not worth telling";
    frame.shareBeyondFrame = 0.12;
    frame.shareUnreachable = 0.3;
    const auto warnings = frameWarnings(&frame);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_TRUE(warnings[0].startsWith("12 %"));
    EXPECT_TRUE(warnings[1].startsWith("30 %"));
}

TEST(LoopText, TellsTheTargetsOwnWarnings) {
    MatchFrame frame = toldFrame();
    auto target = std::make_shared<MatchTarget>();
    target->warnings = {"The mesh has holes."};
    frame.target = target;
    ASSERT_EQ(frameWarnings(&frame).size(), 1U);
    EXPECT_EQ(frameWarnings(&frame).front(), "The mesh has holes.");
}

} // namespace
} // namespace lumorph::studio
