#include "app/studio/rendering/light_delay.h"

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

TEST(LightDelay, AStopChangesNothing) {
    LightDelay delay;
    EXPECT_EQ(delay.usual(), 0.0);
    delay.add(3'000.0); // the first picture of all
    EXPECT_EQ(delay.usual(), 0.0);
    delay.add(42.0);
    EXPECT_EQ(delay.usual(), 42.0);
    for (int k = 0; k < 20; ++k) {
        delay.add(3'000.0);
        EXPECT_NEAR(delay.usual(), 42.0, 1e-9);
        for (int frame = 0; frame < 30; ++frame) delay.add(42.0);
    }
}

TEST(LightDelay, FollowsADelayThatStays) {
    LightDelay delay;
    delay.add(40.0);
    for (int k = 0; k < 100; ++k) delay.add(90.0);
    EXPECT_NEAR(delay.usual(), 90.0, 1.0);
    for (int k = 0; k < 200; ++k) delay.add(500.0);
    EXPECT_NEAR(delay.usual(), LightDelay::kLongest, 1.0) << "a machine that is so slow";
}

} // namespace
} // namespace lumorph::studio
