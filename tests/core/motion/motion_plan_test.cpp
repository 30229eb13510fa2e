#include "core/motion/motion_plan.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr MotionLimits kPlanned{.maxVelocity = 1.3, .dampingRatio = 1.0, .settleSeconds = 0.15};

double gainAt(const std::vector<float>& gains, std::size_t count, std::size_t frame, double position) {
    const double place = position * static_cast<double>(count - 1);
    const auto low = std::min(static_cast<std::size_t>(place), count - 2);
    const double share = place - static_cast<double>(low);
    const float* const row = &gains[frame * count];
    return (1.0 - share) * static_cast<double>(row[low]) + share * static_cast<double>(row[low + 1]);
}

std::vector<float> randomGains(std::size_t frames, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> gain(0.0F, 1.0F);
    std::vector<float> gains(frames * count);
    for (float& of : gains) of = gain(random);
    return gains;
}

/// The most that any sequence of so many evenly spaced commands gains.
double bestOfAll(MotionState now, const std::vector<float>& gains, std::size_t count, double seconds, int commands,
                 std::size_t frame = 0) {
    if (frame * count == gains.size()) return 0.0;
    double best = -1.0;
    for (int c = 0; c < commands; ++c) {
        const MotionState next = advance(now, static_cast<double>(c) / (commands - 1), seconds, kPlanned);
        best = std::max(best, gainAt(gains, count, frame, next.position) +
                                  bestOfAll(next, gains, count, seconds, commands, frame + 1));
    }
    return best;
}

TEST(MotionPlan, GainsAsMuchAsTheBestOfAllCommands) {
    constexpr double kSeconds = 0.2;
    constexpr std::size_t kFrames = 5, kCount = 6;
    const MotionPlanner planner(kPlanned, kSeconds);
    for (unsigned seed = 100; seed < 106; ++seed) {
        const std::vector<float> gains = randomGains(kFrames, kCount, seed);
        const MotionState start{0.15 * (seed - 100), seed % 2 == 0 ? 0.0 : 0.8};
        const MotionPlan plan = planner.plan(start, gains, kCount);
        double gained = 0.0;
        for (std::size_t k = 0; k < kFrames; ++k) gained += gainAt(gains, kCount, k, plan.states[k].position);
        const double best = bestOfAll(start, gains, kCount, kSeconds, 9);
        // It may leave out ways of which each frame gains next to nothing, and reach what lies between the commands.
        EXPECT_GE(gained, 0.97 * best) << seed;
    }
}

// R19
TEST(MotionPlan, KeepsTheLimitsAndIsTheMotionOfItsCommands) {
    constexpr double kSeconds = 1.0 / 30.0;
    const MotionPlanner planner(kPlanned, kSeconds);
    const std::vector<float> gains = randomGains(60, 33, 7);
    const MotionPlan plan = planner.plan({0.4, 0.5}, gains, 33);
    ASSERT_EQ(plan.commands.size(), 60U);
    MotionModel model({kPlanned});
    model.resume(std::vector{0.4}, std::vector{0.5});
    double before = 0.4;
    for (std::size_t k = 0; k < 60; ++k) {
        const double reached = model.step(std::vector{plan.commands[k]}, kSeconds)[0];
        EXPECT_EQ(reached, plan.states[k].position) << k;
        EXPECT_LE(std::abs(reached - before), kPlanned.maxVelocity * kSeconds + 1e-12) << k;
        before = reached;
    }
}

// R19: no oscillation.
TEST(MotionPlan, GoesStraightToAPlaceThatStaysTheBest) {
    constexpr double kSeconds = 1.0 / 30.0;
    const MotionPlanner planner(kPlanned, kSeconds);
    for (const double best : {0.31, 0.7, 1.0}) {
        std::vector<float> gains;
        for (int k = 0; k < 45; ++k)
            for (int j = 0; j < 33; ++j) gains.push_back(static_cast<float>(1.0 - std::abs(j / 32.0 - best)));
        const MotionPlan plan = planner.plan({}, gains, 33);
        double before = 0.0, gained = 0.0;
        for (const MotionState& state : plan.states) {
            gained += 1.0 - std::abs(state.position - best);
            EXPECT_GE(state.position, before - 1e-3) << best;
            before = state.position;
        }
        EXPECT_NEAR(before, best, 0.5 / 32.0);
        // No later than by commanding the place itself; to the end of the range there is no faster way.
        double told = 0.0;
        MotionState follower;
        for (int k = 0; k < 45; ++k) {
            follower = advance(follower, best, kSeconds, kPlanned);
            told += 1.0 - std::abs(follower.position - best);
        }
        EXPECT_GE(gained, told + (best < 1.0 ? 0.1 : -1e-3)) << best;
    }
}

TEST(MotionPlan, StaysWhereNothingIsGained) {
    const MotionPlanner planner(kPlanned, 0.04);
    const std::vector<float> gains(10 * 5, 0.25F);
    for (const MotionState& state : planner.plan({0.37, 0.0}, gains, 5).states) EXPECT_NEAR(state.position, 0.37, 1e-9);
}

TEST(MotionPlan, RefusesWhatIsNoPlan) {
    const MotionPlanner planner(kPlanned, 0.04);
    const std::vector<float> gains(10, 0.0F);
    EXPECT_THROW((void)planner.plan({}, gains, 3), InvalidInput);
    EXPECT_THROW((void)planner.plan({}, gains, 1), InvalidInput);
    EXPECT_THROW((void)planner.follow({}, std::vector{0.5}, gains, 5), InvalidInput);
    EXPECT_THROW(MotionPlanner({.maxVelocity = -1.0}, 0.04), InvalidInput);
    EXPECT_THROW(MotionPlanner(kPlanned, -1.0), InvalidInput);
    EXPECT_TRUE(planner.plan({}, std::vector<float>{}, 5).commands.empty());
}

} // namespace
} // namespace lumorph
