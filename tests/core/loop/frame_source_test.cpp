#include <cmath>

#include <gtest/gtest.h>

#include "core/loop/frame_source.h"
#include "core/loop/match_loop.h"
#include "core/motion/rig_motion.h"
#include "tests/support/small_rigs.h"

// Frames from elsewhere, such as a recording's, take the place of the loop's own, and the way back has no jump.

namespace lumorph {
namespace {

class StandingSource : public FrameSource {
public:
    explicit StandingSource(std::vector<double> strokes) : strokes_(std::move(strokes)) {}
    std::shared_ptr<const MatchFrame> frame(const MatchWish& wish, Microseconds now) override {
        auto made = std::make_shared<MatchFrame>();
        made->number = 77;
        made->time = now;
        made->rig = wish.rig;
        made->estimatedStrokes = strokes_;
        return made;
    }
    bool moves() const override { return playing; }
    bool playing = true;

private:
    std::vector<double> strokes_;
};

struct FrameSourceTest : ::testing::Test {
    FrameSourceTest() {
        wish.rig = std::make_shared<const Rig>(test::cushionRig());
        wish.driver = Driver::hand;
        wish.strokes.assign(wish.rig->actuatorCount(), 0.0);
    }
    ManualClock clock;
    MatchLoop loop{clock};
    MatchWish wish;
};

TEST_F(FrameSourceTest, ItsFramesAreGivenAsTheyAre) {
    const std::vector<double> strokes(wish.rig->actuatorCount(), 0.625);
    const auto source = std::make_shared<StandingSource>(strokes);
    wish.source = source;
    wish.driver = Driver::recording;
    const auto frame = loop.step(wish, 0.01);
    EXPECT_EQ(frame->number, 77U);
    EXPECT_EQ(frame->estimatedStrokes, strokes);
    EXPECT_FALSE(loop.settled());
    source->playing = false;
    (void)loop.step(wish, 0.01);
    EXPECT_TRUE(loop.settled()) << "while it stands still nothing has to be done";
}

TEST_F(FrameSourceTest, TheWayBackStartsWhereTheActuatorsStandAndKeepsTheirLimits) {
    wish.source = std::make_shared<StandingSource>(std::vector<double>(wish.rig->actuatorCount(), 1.0));
    wish.driver = Driver::recording;
    (void)loop.step(wish, 0.01);
    wish.source.reset();
    wish.driver = Driver::hand;
    const std::vector<MotionLimits> limits = motionLimits(*wish.rig);
    std::vector<double> before(wish.rig->actuatorCount(), 1.0);
    for (int step = 0; step < 2000; ++step) {
        const auto frame = loop.step(wish, 0.01);
        for (std::size_t k = 0; k < before.size(); ++k) {
            ASSERT_LE(frame->estimatedStrokes[k], before[k]);
            ASSERT_LE(before[k] - frame->estimatedStrokes[k], limits[k].maxVelocity * 0.01 + 1e-9) << "step " << step;
        }
        before = frame->estimatedStrokes;
    }
    EXPECT_EQ(before, wish.strokes);
}

} // namespace
} // namespace lumorph
