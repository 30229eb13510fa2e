#include "app/studio/rendering/frame_schedule.h"

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using Time = FrameSchedule::Time;

FrameRequest wanted(double scale = 1.0, bool refine = true) {
    return {std::make_shared<ViewportScene>(), {}, {100, 80}, scale, refine};
}

TEST(FrameSchedule, TheNewestRequestIsDrawnAtOnceAndOnceMoreInFullQualityWhenItIsQuiet) {
    FrameSchedule schedule;
    const Time t{};
    schedule.request(1, wanted(1.0), t);
    schedule.request(1, wanted(2.0), t + 1ms);
    const auto first = schedule.next(t + 1ms);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->quality, ViewportQuality::moving);
    EXPECT_EQ(first->request.scale, 2.0);
    EXPECT_FALSE(schedule.next(t + 100ms));
    ASSERT_TRUE(schedule.nextAt());
    EXPECT_EQ(*schedule.nextAt(), t + 1ms + FrameSchedule::kQuiet);
    const auto second = schedule.next(*schedule.nextAt());
    ASSERT_TRUE(second);
    EXPECT_EQ(second->quality, ViewportQuality::still);
    EXPECT_FALSE(schedule.next(t + 10s));
    EXPECT_FALSE(schedule.nextAt());
}

TEST(FrameSchedule, AFrameThatWasGivenUpComesAgainUnlessSomethingNewerDid) {
    FrameSchedule schedule;
    const Time t{};
    schedule.request(1, wanted(), t);
    (void)schedule.next(t);
    const auto still = schedule.next(t + 1s);
    schedule.givenUp(*still);
    ASSERT_TRUE(schedule.next(t + 1s));
    schedule.request(1, wanted(1.0, false), t + 2s);
    schedule.givenUp(*still);
    EXPECT_EQ(schedule.next(t + 3s)->quality, ViewportQuality::moving);
    EXPECT_FALSE(schedule.next(t + 9s));
}

TEST(FrameSchedule, ViewportsTakeTurns) {
    FrameSchedule schedule;
    const Time t{};
    std::vector<int> order;
    for (int i = 0; i < 9; ++i) {
        // Number 2 asks without end; the others must not starve.
        for (const int viewport : {1, 2, 3}) schedule.request(viewport, wanted(), t);
        order.push_back(schedule.next(t)->viewport);
    }
    EXPECT_EQ(order, (std::vector{1, 2, 3, 1, 2, 3, 1, 2, 3}));
}

TEST(FrameSchedule, AForgottenViewportIsNotDrawn) {
    FrameSchedule schedule;
    schedule.request(4, wanted(), {});
    EXPECT_TRUE(schedule.pressing());
    schedule.forget(4);
    EXPECT_FALSE(schedule.pressing());
    EXPECT_FALSE(schedule.next(Time{} + 1s));
}

// Frames whose time is that of their pixels settle where they are in time, and stay there.
TEST(FrameSchedule, SlowFramesGetCoarserUntilTheyAreInTimeAndFinerAgain) {
    FrameSchedule schedule;
    Time t{};
    const auto run = [&](double fullMilliseconds, int frames) {
        double resolution = 0.0;
        for (int i = 0; i < frames; ++i) {
            t += 16ms;
            schedule.request(1, wanted(), t);
            const auto work = schedule.next(t);
            resolution = work->resolution;
            schedule.finished(*work, fullMilliseconds * resolution * resolution);
        }
        return resolution;
    };
    EXPECT_EQ(run(10.0, 60), 1.0);
    const double coarse = run(50.0, 60);
    EXPECT_LE(50.0 * coarse * coarse, FrameSchedule::kBudgetMilliseconds);
    EXPECT_EQ(run(50.0, 20), coarse);
    EXPECT_EQ(run(1000.0, 60), FrameSchedule::kLowestResolution);
    EXPECT_EQ(run(8.0, 100), 1.0);
    // One slow frame alone changes nothing.
    schedule.request(1, wanted(), t);
    const auto hiccup = schedule.next(t);
    schedule.finished(*hiccup, 300.0);
    EXPECT_EQ(run(8.0, 5), 1.0);
    // Full quality is full quality.
    (void)run(1000.0, 60);
    EXPECT_EQ(schedule.next(t + 1s)->resolution, 1.0);
}

} // namespace
} // namespace lumorph::studio
