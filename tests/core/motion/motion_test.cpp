#include "core/motion/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An independent solution: the same equation by tiny explicit steps (semi-implicit Euler), O(step).
double integrated(double position, double velocity, double target, double seconds, const MotionLimits& limits) {
    const double frequency = 1.0 / limits.settleSeconds;
    const int steps = 400'000;
    const double h = seconds / steps;
    for (int i = 0; i < steps; ++i) {
        const double acceleration =
            frequency * frequency * (target - position) - 2.0 * limits.dampingRatio * frequency * velocity;
        velocity = std::clamp(velocity + h * acceleration, -limits.maxVelocity, limits.maxVelocity);
        position += h * velocity;
    }
    return position;
}

struct StepCase {
    double start, velocity, target;
    MotionLimits limits;
    double frameRate;
};

class MotionStep : public testing::TestWithParam<StepCase> {};

// R19: no startling (speed), no oscillation (no overshoot, no turning back), whatever the frame rate.
TEST_P(MotionStep, ApproachesFromOneSideUnderTheSpeedLimit) {
    const StepCase& c = GetParam();
    MotionState state{c.start, c.velocity};
    const double side = c.target >= c.start ? 1.0 : -1.0;
    const double seconds = 1.0 / c.frameRate;
    // Full stroke at the limit, then enough time constants of the slow mode.
    const double total = 1.0 / c.limits.maxVelocity + 40.0 * c.limits.dampingRatio * c.limits.settleSeconds;
    for (int i = 0; i * seconds < total; ++i) {
        const MotionState next = advance(state, c.target, seconds, c.limits);
        const double moved = side * (next.position - state.position);
        EXPECT_GE(moved, 0.0);
        EXPECT_LE(moved, c.limits.maxVelocity * seconds + kRounding);
        EXPECT_LE(std::abs(next.velocity), c.limits.maxVelocity);
        EXPECT_LE(side * (next.position - c.target), 0.0);
        state = next;
    }
    EXPECT_NEAR(state.position, c.target, 1e-6);
    EXPECT_NEAR(state.velocity, 0.0, 1e-4);
}

// R19: one step of a time and many steps of it end at the same place.
TEST_P(MotionStep, DoesNotDependOnTheFrameRate) {
    const StepCase& c = GetParam();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.0, 2.0 / c.frameRate);
    for (const double total : {0.03, 0.2, 0.7, 2.0}) {
        const MotionState once = advance({c.start, c.velocity}, c.target, total, c.limits);
        MotionState often{c.start, c.velocity};
        double left = total;
        while (left > 0.0) {
            const double seconds = std::min(left, share(random));
            often = advance(often, c.target, seconds, c.limits);
            left -= seconds;
        }
        EXPECT_NEAR(once.position, often.position, 1e-9);
        EXPECT_NEAR(once.velocity, often.velocity, 1e-7);
    }
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Table, MotionStep, testing::Values(
    //       start  velocity  target   max velocity, damping, settle     frames a second
    StepCase{0.0,    0.0,     1.0,    {1.0,          1.0,     0.15},     60.0},
    StepCase{0.0,    0.0,     1.0,    {1.0,          1.0,     0.15},     1.0},
    StepCase{0.0,    0.0,     1.0,    {1.0,          1.0,     0.15},     10'000.0},
    StepCase{1.0,    0.0,     0.0,    {0.3,          1.0,     0.05},     25.0},
    StepCase{0.2,    0.0,     0.201,  {5.0,          1.0,     0.2},      60.0},
    StepCase{0.0,    0.0,     1.0,    {100.0,        1.0,     0.15},     60.0},
    StepCase{0.0,    0.0,     1.0,    {1.0,          1.5,     0.15},     30.0},
    StepCase{0.9,    0.0,     0.1,    {2.0,          4.0,     0.1},      1000.0},
    StepCase{0.5,    1.0,     0.51,   {1.0,          1.0,     0.15},     60.0},
    StepCase{0.5,    1.0,     0.8,    {1.0,          1.0,     0.05},     7.0},
    StepCase{0.5,   -1.0,     0.8,    {1.0,          1.0,     0.15},     60.0},
    StepCase{1.0,    1.0,     0.99,   {1.0,          1.2,     0.15},     90.0},
    StepCase{0.5,    0.4,     0.5,    {1.0,          1.0,     0.15},     60.0},
    StepCase{0.0,    0.7,     1.0,    {0.7,          1.000001, 0.1},     60.0}));
// clang-format on

TEST(Motion, IsTheDampedSecondOrderResponse) { // R19
    const MotionLimits critical{1.0, 1.0, 0.15};
    const MotionLimits damped{0.8, 2.5, 0.1};
    for (const double seconds : {0.05, 0.3, 0.9, 1.6}) {
        EXPECT_NEAR(advance({0.0, 0.0}, 1.0, seconds, critical).position, integrated(0.0, 0.0, 1.0, seconds, critical),
                    2e-5);
        EXPECT_NEAR(advance({0.9, -0.5}, 0.1, seconds, damped).position, integrated(0.9, -0.5, 0.1, seconds, damped),
                    2e-5);
    }
}

TEST(Motion, CruisesAtTheLimitOnALongWay) {
    const MotionLimits limits{0.25, 1.0, 0.1};
    const MotionState middle = advance({0.0, 0.0}, 1.0, 2.0, limits);
    EXPECT_DOUBLE_EQ(middle.velocity, 0.25);
    EXPECT_NEAR(advance(middle, 1.0, 1.0, limits).position - middle.position, 0.25, kRounding);
}

// R19: targets that jump at random, steps from 0.1 ms to 1 s and now and then a clock that jumps by
// an hour, damping and limits drawn anew every 1,000 steps.
TEST(Motion, HoldsItsPromisesOver100000RandomSteps) {
    std::mt19937 random(19);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    MotionState state;
    MotionLimits limits;
    double target = 0.0;
    int faults = 0;
    for (int i = 0; i < 100'000; ++i) {
        if (i % 1000 == 0)
            limits = {std::pow(10.0, between(-2, 2)), random() % 2 ? 1.0 : between(1, 20),
                      std::pow(10.0, between(-3, 1))};
        if (random() % 5 == 0) target = random() % 4 == 0 ? static_cast<double>(random() % 2) : between(0, 1);
        const double seconds = random() % 500 == 0 ? 3600.0 : std::pow(10.0, between(-4, 0));
        const MotionState next = advance(state, target, seconds, limits);
        const double low = std::min(state.position, target);
        const double high = std::max(state.position, target);
        const bool good = next.position >= low && next.position <= high && next.position >= 0.0 &&
                          next.position <= 1.0 && std::abs(next.velocity) <= limits.maxVelocity &&
                          std::abs(next.position - state.position) <= limits.maxVelocity * seconds + kRounding &&
                          next.velocity * (target - next.position) >= 0.0;
        if (!good) ++faults;
        state = next;
    }
    EXPECT_EQ(faults, 0);
}

TEST(Motion, RefusesWhatIsNotANumber) {
    const MotionLimits good;
    for (const double bad : {kNan, kInfinity, -kInfinity, -0.1}) {
        EXPECT_THROW((void)advance({bad, 0.0}, 0.5, 0.01, good), InvalidInput) << bad;
        EXPECT_THROW((void)advance({0.5, 0.0}, bad, 0.01, good), InvalidInput) << bad;
        EXPECT_THROW((void)advance({0.5, 0.0}, 0.5, bad, good), InvalidInput) << bad;
        EXPECT_THROW((void)advance({0.5, 0.0}, 0.5, 0.01, {bad, 1.0, 0.1}), InvalidInput) << bad;
        EXPECT_THROW((void)advance({0.5, 0.0}, 0.5, 0.01, {1.0, bad, 0.1}), InvalidInput) << bad;
        EXPECT_THROW((void)advance({0.5, 0.0}, 0.5, 0.01, {1.0, 1.0, bad}), InvalidInput) << bad;
    }
    EXPECT_THROW((void)advance({0.5, kNan}, 0.5, 0.01, good), InvalidInput);
    EXPECT_THROW((void)advance({0.5, 0.0}, 1.1, 0.01, good), InvalidInput);
    EXPECT_THROW((void)advance({0.5, 0.0}, 0.5, 0.01, {1.0, 0.9, 0.1}), InvalidInput);
    EXPECT_THROW(MotionModel({good, {0.0, 1.0, 0.1}}), InvalidInput);
}

TEST(Motion, ARefusedStepMovesNothing) {
    MotionModel model({{}, {}, {}});
    const std::vector<double> targets{0.5, 1.0, 0.2};
    model.step(targets, 0.1);
    const std::vector<double> positions(model.positions().begin(), model.positions().end());
    const std::vector<double> velocities(model.velocities().begin(), model.velocities().end());
    EXPECT_GT(positions[0], 0.0);

    EXPECT_THROW(model.step(std::vector<double>{1.0, 1.0, kNan}, 0.1), InvalidInput);
    EXPECT_THROW(model.step(std::vector<double>{1.0, 1.0}, 0.1), InvalidInput);
    EXPECT_THROW(model.step(targets, -0.1), InvalidInput);
    EXPECT_THROW(model.reset(std::vector<double>{0.1, 0.1, 2.0}), InvalidInput);
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(), model.positions().begin()));
    EXPECT_TRUE(std::equal(velocities.begin(), velocities.end(), model.velocities().begin()));
}

TEST(Motion, TheModelMovesEachActuatorByItsOwnLimits) {
    const MotionLimits slow{0.1, 1.0, 0.15};
    const MotionLimits fast{2.0, 1.0, 0.05};
    MotionModel model({slow, fast});
    model.reset(std::vector<double>{0.4, 0.4});
    model.step(std::vector<double>{0.9, 0.1}, 0.3);
    EXPECT_EQ(model.positions()[0], advance({0.4, 0.0}, 0.9, 0.3, slow).position);
    EXPECT_EQ(model.positions()[1], advance({0.4, 0.0}, 0.1, 0.3, fast).position);
}

TEST(Motion, ResumedUnderOtherLimitsItGoesOnAsFastAsItWas) {
    const MotionLimits before{2.0, 1.0, 0.15}, after{2.0, 1.5, 0.15};
    MotionModel model({before});
    model.step(std::vector<double>{1.0}, 0.1);
    const MotionState there{model.positions()[0], model.velocities()[0]};
    ASSERT_GT(there.velocity, 0.5);
    MotionModel next({after});
    next.resume(model.positions(), model.velocities());
    next.step(std::vector<double>{1.0}, 0.01);
    EXPECT_EQ(next.positions()[0], advance(there, 1.0, 0.01, after).position);
    EXPECT_THROW(next.resume(model.positions(), std::vector<double>{kNan}), InvalidInput);
    EXPECT_THROW(next.resume(model.positions(), {}), InvalidInput);
}

} // namespace
} // namespace lumorph
