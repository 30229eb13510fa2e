#include "core/motion/stroke_lead.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr MotionLimits kLed{.maxVelocity = 1.3, .dampingRatio = 1.0, .settleSeconds = 0.15};

struct Followed {
    double error = 0.0;     ///< mean distance from what is wanted
    double overshoot = 0.0; ///< beyond what is ever wanted
};

/// Follows `wanted(seconds)`, in whole levels, for three seconds.
template <typename Wanted> Followed followLed(Wanted&& wanted, double framesPerSecond, bool led) {
    const double dt = 1.0 / framesPerSecond;
    StrokeLead lead(std::vector{kLed});
    MotionModel motion({kLed});
    Followed followed;
    double highest = 0.0, lowest = 1.0;
    const int frames = static_cast<int>(3.0 * framesPerSecond);
    for (int k = 0; k <= frames; ++k) {
        const double now = std::round(32.0 * wanted(k * dt)) / 32.0;
        if (k == 0) motion.reset(std::vector{now});
        highest = std::max(highest, now);
        lowest = std::min(lowest, now);
        const std::vector<double> strokes{now};
        const double reached = motion.step(led ? lead.step(strokes, dt) : std::span<const double>(strokes), dt)[0];
        followed.error += std::abs(reached - now) / (frames + 1);
        followed.overshoot = std::max({followed.overshoot, reached - highest, lowest - reached});
    }
    return followed;
}

TEST(StrokeLead, FollowsASteadyChangeCloser) {
    for (const double rate : {30.0, 60.0, 47.0}) {
        const auto wave = [](double t) { return 0.5 - 0.4 * std::cos(2.2 * t); };
        const auto ramp = [](double t) { return std::min(0.1 + 0.4 * t, 0.7); };
        EXPECT_LT(followLed(wave, rate, true).error, 0.5 * followLed(wave, rate, false).error) << rate;
        EXPECT_LT(followLed(ramp, rate, true).error, 0.5 * followLed(ramp, rate, false).error) << rate;
        EXPECT_LT(followLed(wave, rate, true).overshoot, 2.0 / 32.0) << rate;
        EXPECT_LT(followLed(ramp, rate, true).overshoot, 2.0 / 32.0) << rate;
    }
}

TEST(StrokeLead, DoesNotPassAJump) {
    for (const double rate : {30.0, 60.0, 47.0})
        for (const double height : {0.1, 0.4, 0.8}) {
            const auto jump = [&](double t) { return t < 0.5 ? 0.1 : 0.1 + height; };
            EXPECT_LT(followLed(jump, rate, true).overshoot, 0.5 / 32.0) << rate << ' ' << height;
            EXPECT_LT(followLed(jump, rate, true).error, followLed(jump, rate, false).error + 1e-9);
        }
}

TEST(StrokeLead, CommandsWhatStaysAsItIs) {
    StrokeLead lead(std::vector{kLed, kLed});
    const std::vector<double> wanted{0.3, 1.0};
    for (int k = 0; k < 20; ++k) {
        const auto commands = lead.step(wanted, 1.0 / 30.0);
        EXPECT_EQ(std::vector<double>(commands.begin(), commands.end()), wanted);
    }
    (void)lead.step(std::vector{0.35, 0.9}, 1.0 / 30.0);
    lead.restart();
    const auto commands = lead.step(std::vector{0.4, 0.8}, 1.0 / 30.0);
    EXPECT_EQ(commands[0], 0.4);
    EXPECT_EQ(commands[1], 0.8);
    EXPECT_THROW((void)lead.step(std::vector{0.4}, 0.1), InvalidInput);
    EXPECT_THROW((void)lead.step(wanted, -0.1), InvalidInput);
}

} // namespace
} // namespace lumorph
