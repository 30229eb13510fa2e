#include "core/mdf/clip_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <stop_token>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "core/motion/rig_motion.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

Field coarseField(const Rig& rig, int levels) {
    BuildOptions options;
    options.resolution = 12;
    options.levels = levels;
    options.samples = 20;
    return buildField(rig, options);
}

/// A target that the device could show if its actuators had no limits.
struct Moving {
    std::vector<State> wanted;
    std::vector<BitColumns> targets;
};

Moving shownBy(const Coverage& coverage, std::vector<State> states) {
    Moving moving{std::move(states), {}};
    CoverageScratch scratch;
    for (const State& state : moving.wanted) coverage.covered(state, moving.targets.emplace_back(), scratch);
    return moving;
}

/// Mean IoU of the volumes that commands reach from rest.
double reachedBy(const Coverage& coverage, const Moving& moving, const FrameCommands& commands, double seconds) {
    MotionModel motion(motionLimits(coverage.rig()));
    CoverageScratch scratch;
    BitColumns covered;
    double sum = 0.0;
    for (std::size_t k = 0; k < commands.size(); ++k) {
        coverage.coveredAt(motion.step(commands[k], seconds), covered, scratch);
        sum += intersectionOverUnion(covered, moving.targets[k]);
    }
    return sum / static_cast<double>(commands.size());
}

FrameCommands frameByFrame(const Coverage& coverage, const Moving& moving) {
    FrameCommands commands;
    for (const State& state : moving.wanted) commands.push_back(strokesOf(coverage.rig(), state, coverage.levels()));
    return commands;
}

// Against every sequence of commands at rest, at half and at full stroke.
TEST(ClipPlan, ReachesWhatTheBestOfAllCommandsReaches) {
    constexpr int kLevels = 5, kFrames = 3, kCommands = 3;
    constexpr double kSeconds = 0.35;
    const Rig rig = test::lifterRig();
    const Field field = coarseField(rig, kLevels);
    const Coverage coverage(rig, field.frame, kLevels);
    const std::vector<MotionLimits> limits = motionLimits(rig);
    ClipPlanner planner(coverage, kSeconds);
    double all = 0.0, planned = 0.0, alone = 0.0;
    for (unsigned seed = 31; seed < 35; ++seed) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> level(0, kLevels - 1);
        std::vector<State> states(kFrames, State(3));
        for (State& state : states)
            for (Level& of : state) of.index = level(random);
        const Moving moving = shownBy(coverage, states);

        CoverageScratch scratch;
        BitColumns covered;
        const std::function<double(std::size_t, const std::vector<MotionState>&)> best =
            [&](std::size_t frame, const std::vector<MotionState>& now) {
                if (frame == kFrames) return 0.0;
                double most = 0.0;
                for (int code = 0; code < kCommands * kCommands * kCommands; ++code) {
                    std::vector<MotionState> next;
                    std::vector<double> strokes;
                    for (int i = 0, rest = code; i < 3; ++i, rest /= kCommands) {
                        const double command = static_cast<double>(rest % kCommands) / (kCommands - 1);
                        const auto at = static_cast<std::size_t>(i);
                        next.push_back(advance(now[at], command, kSeconds, limits[at]));
                        strokes.push_back(next.back().position);
                    }
                    coverage.coveredAt(strokes, covered, scratch);
                    most =
                        std::max(most, intersectionOverUnion(covered, moving.targets[frame]) + best(frame + 1, next));
                }
                return most;
            };
        all += best(0, std::vector<MotionState>(3)) / kFrames;
        const FrameCommands commands = planner.plan(std::vector<MotionState>(3), moving.targets, moving.wanted);
        ASSERT_EQ(commands.size(), static_cast<std::size_t>(kFrames));
        planned += reachedBy(coverage, moving, commands, kSeconds);
        alone += reachedBy(coverage, moving, frameByFrame(coverage, moving), kSeconds);
    }
    std::printf("planned %.4f, best of all %.4f, frame by frame %.4f\n", planned / 4, all / 4, alone / 4);
    EXPECT_GE(planned, 0.97 * all);
    EXPECT_GT(planned, alone);
}

// R19: nothing moves faster than it may, and what is reached is better than after frame-by-frame matching.
TEST(ClipPlan, ReachesMoreThanFrameByFrameUnderTheSameLimits) {
    constexpr int kLevels = 17, kFrames = 40;
    constexpr double kSeconds = 1.0 / 20.0;
    const Rig rig = test::cushionRig();
    const Field field = coarseField(rig, kLevels);
    const Coverage coverage(rig, field.frame, kLevels);
    ClipPlanner planner(coverage, kSeconds);
    double planned = 0.0, alone = 0.0;
    for (unsigned seed = 51; seed < 54; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi), rate(2.0, 5.0);
        std::vector<State> states(kFrames, State(3));
        for (std::size_t i = 0; i < 3; ++i) {
            const double from = phase(random), speed = rate(random);
            for (std::size_t k = 0; k < kFrames; ++k) {
                const double stroke = 0.5 + 0.5 * std::sin(from + speed * kSeconds * static_cast<double>(k));
                states[k][i].index = static_cast<int>(std::lround(stroke * (kLevels - 1)));
            }
        }
        const Moving moving = shownBy(coverage, states);
        const FrameCommands commands = planner.plan(std::vector<MotionState>(3), moving.targets, moving.wanted);
        const double with = reachedBy(coverage, moving, commands, kSeconds);
        const double without = reachedBy(coverage, moving, frameByFrame(coverage, moving), kSeconds);
        EXPECT_GT(with, without) << seed;
        planned += with / 3;
        alone += without / 3;
        MotionModel motion(motionLimits(rig));
        std::vector<double> before(3, 0.0);
        for (const std::vector<double>& frame : commands) {
            const auto strokes = motion.step(frame, kSeconds);
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_LE(std::abs(strokes[i] - before[i]), rig.actuators()[i].maxVelocity * kSeconds + 1e-12);
                before[i] = strokes[i];
            }
        }
    }
    std::printf("planned %.4f, frame by frame %.4f\n", planned, alone);
    EXPECT_GE(planned, alone + 0.03);
}

TEST(ClipPlan, RefusesOtherNumbersAndCanBeStopped) {
    const Rig rig = test::lifterRig();
    const Field field = coarseField(rig, 4);
    const Coverage coverage(rig, field.frame, 4);
    ClipPlanner planner(coverage, 0.1);
    const Moving moving = shownBy(coverage, {State(3), State(3)});
    const std::vector<MotionState> rest(3);
    EXPECT_THROW((void)planner.plan(std::vector<MotionState>(2), moving.targets, moving.wanted), InvalidInput);
    EXPECT_THROW((void)planner.plan(rest, moving.targets, std::vector<State>(1, State(3))), InvalidInput);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)planner.plan(rest, moving.targets, moving.wanted, Progress({}, stop.get_token())), Cancelled);
    EXPECT_TRUE(planner.plan(rest, {}, {}).empty());
}

} // namespace
} // namespace lumorph
