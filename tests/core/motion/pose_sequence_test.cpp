#include "core/motion/pose_sequence.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PoseSequence wave(bool loop) {
    PoseSequence sequence;
    sequence.poses = {{"up", {1.0, 0.5}}, {"down", {0.0, 0.25}}};
    sequence.steps = {{"up", 2.0, 1.0, Easing::linear}, {"down", 1.0, 0.5, Easing::minimumJerk}};
    sequence.loop = loop;
    return sequence;
}

const std::vector<double> kFrom = {0.2, 0.5};

TEST(PoseSequence, IsWhereItsStepsSayAtEachTime) {
    const PoseSequence once = wave(false);
    EXPECT_EQ(durationOf(once), 4.5);
    EXPECT_THAT(strokesAt(once, kFrom, 0.0), ElementsAre(0.2, 0.5));
    EXPECT_THAT(strokesAt(once, kFrom, 1.0), ElementsAre(testing::DoubleEq(0.6), 0.5));
    EXPECT_THAT(strokesAt(once, kFrom, 2.0), ElementsAre(1.0, 0.5));
    EXPECT_THAT(strokesAt(once, kFrom, 2.99), ElementsAre(1.0, 0.5)) << "held";
    EXPECT_THAT(strokesAt(once, kFrom, 3.5), ElementsAre(0.5, 0.375)) << "an eased way is half done in half its time";
    EXPECT_THAT(strokesAt(once, kFrom, 100.0), ElementsAre(0.0, 0.25)) << "it stays at its end";
    const PoseSequence loop = wave(true);
    EXPECT_THAT(strokesAt(loop, kFrom, 1.0), ElementsAre(testing::DoubleEq(0.6), 0.5));
    EXPECT_THAT(strokesAt(loop, kFrom, 4.5), ElementsAre(0.0, 0.25));
    EXPECT_THAT(strokesAt(loop, kFrom, 5.5), ElementsAre(0.5, 0.375)) << "a later round comes from the last pose";
}

// Against the integral of what each easing is known for: the minimum-jerk speed is 30 u^2 (1 - u)^2, the smooth one
// 6 u (1 - u).
TEST(PoseSequence, EasesAsItsSpeedSays) {
    constexpr int kSteps = 20'000;
    const auto speedOf = [](Easing easing, double u) {
        return easing == Easing::linear   ? 1.0
               : easing == Easing::smooth ? 6.0 * u * (1.0 - u)
                                          : 30.0 * u * u * (1.0 - u) * (1.0 - u);
    };
    for (const Easing easing : {Easing::linear, Easing::smooth, Easing::minimumJerk}) {
        double way = 0.0;
        double fastest = 0.0;
        for (int k = 0; k < kSteps; ++k) {
            const double speed = speedOf(easing, (k + 0.5) / kSteps);
            fastest = std::max(fastest, speed);
            way += speed / kSteps;
            ASSERT_NEAR(eased(easing, (k + 1.0) / kSteps), way, 1e-7);
        }
        EXPECT_NEAR(peakSpeed(easing), fastest, 1e-6);
        EXPECT_EQ(eased(easing, -1.0), 0.0);
        EXPECT_EQ(eased(easing, 2.0), 1.0);
    }
}

// What is measured from one moment to the next keeps the limits, and a sequence that does already is left alone.
TEST(PoseSequence, IsMadeSlowEnoughForItsServosAndNoSlower) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    for (int trial = 0; trial < 30; ++trial) {
        PoseSequence sequence;
        sequence.loop = trial % 2 == 0;
        for (const char* name : {"a", "b", "c"}) {
            sequence.poses.push_back({name, {number(random), number(random), number(random)}});
            sequence.steps.push_back(
                {name, 0.01 + 0.3 * number(random), 0.1 * number(random), static_cast<Easing>(random() % 3)});
        }
        const std::vector<double> from = {number(random), number(random), number(random)};
        std::vector<PoseLimits> limits(3);
        for (PoseLimits& limit : limits) limit.maxVelocity = 0.5 + number(random);
        const PoseSequence slow = withinLimits(sequence, from, limits);
        constexpr double kTick = 1e-3;
        double fullest = 0.0;
        std::vector<double> before = from;
        for (double t = kTick; t < 2.0 * durationOf(slow); t += kTick) {
            const std::vector<double> now = strokesAt(slow, from, t);
            for (std::size_t a = 0; a < 3; ++a)
                fullest = std::max(fullest, std::abs(now[a] - before[a]) / kTick / limits[a].maxVelocity);
            before = now;
        }
        EXPECT_LE(fullest, 1.0 + 1e-6);
        EXPECT_GT(fullest, 0.97) << "at least one way needs all the speed there is";
        EXPECT_EQ(withinLimits(slow, from, limits), slow);
        for (std::size_t k = 0; k < slow.steps.size(); ++k) {
            EXPECT_GE(slow.steps[k].travelSeconds, sequence.steps[k].travelSeconds);
            EXPECT_EQ(slow.steps[k].holdSeconds, sequence.steps[k].holdSeconds);
        }
    }
}

// Differences of differences of what is sampled; the smooth easing has its largest acceleration at its ends.
TEST(PoseSequence, IsMadeSlowEnoughForAccelerationToo) {
    for (const Easing easing : {Easing::smooth, Easing::minimumJerk}) {
        PoseSequence sequence;
        sequence.poses = {{"up", {1.0, 0.3}}, {"down", {0.0, 0.9}}};
        sequence.steps = {{"up", 0.0, 0.2, easing}, {"down", 0.0, 0.1, easing}};
        sequence.loop = true;
        const std::vector<PoseLimits> limits = {{50.0, 4.0}, {50.0, 9.0}};
        const std::vector<double> from = {0.0, 0.9};
        const PoseSequence slow = withinLimits(sequence, from, limits);
        constexpr double kTick = 1e-3;
        double fullest = 0.0;
        for (double t = kTick; t < 2.0 * durationOf(slow); t += kTick) {
            const std::vector<double> a = strokesAt(slow, from, t - kTick);
            const std::vector<double> b = strokesAt(slow, from, t);
            const std::vector<double> c = strokesAt(slow, from, t + kTick);
            for (std::size_t k = 0; k < 2; ++k)
                fullest =
                    std::max(fullest, std::abs(a[k] - 2.0 * b[k] + c[k]) / (kTick * kTick) / limits[k].maxAcceleration);
        }
        EXPECT_LE(fullest, 1.01);
        EXPECT_GT(fullest, 0.98);
    }
}

TEST(PoseSequence, PlaysByAClockAndWaitsWhereItIsHeld) {
    PosePlay play{wave(false), kFrom, Microseconds{2'000'000}, std::nullopt};
    EXPECT_EQ(secondsOf(play, Microseconds{1'000'000}), 0.0);
    EXPECT_EQ(secondsOf(play, Microseconds{5'500'000}), 3.5);
    EXPECT_TRUE(movesOn(play, Microseconds{5'500'000}));
    EXPECT_FALSE(movesOn(play, Microseconds{6'500'000})) << "it has ended";
    play.sequence.loop = true;
    EXPECT_TRUE(movesOn(play, Microseconds{6'500'000}));
    play.heldAt = 0.75;
    EXPECT_EQ(secondsOf(play, Microseconds{6'500'000}), 0.75);
    EXPECT_FALSE(movesOn(play, Microseconds{6'500'000}));
}

TEST(PoseSequence, RefusesByName) {
    const auto refused = [](auto&& change) -> std::string {
        PoseSequence sequence = wave(false);
        change(sequence);
        try {
            requirePlayable(sequence, 2);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "played";
    };
    EXPECT_EQ(refused([](PoseSequence&) {}), "played");
    EXPECT_THAT(refused([](PoseSequence& s) { s.steps[1].pose = "gone"; }), HasSubstr("'gone'"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses[1].name = "up"; }), HasSubstr("same name"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses[0].name.clear(); }), HasSubstr("no name"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses[0].name.assign(200, 'a'); }), HasSubstr("too long"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses.resize(kMaxPoses + 1, s.poses[0]); }), HasSubstr("250"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses[1].strokes.pop_back(); }), HasSubstr("'down'"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.poses[1].strokes[0] = std::nan(""); }), HasSubstr("not from 0 to 1"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.steps[1].travelSeconds = std::nan(""); }), HasSubstr("step 2"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.steps[0].holdSeconds = -1.0; }), HasSubstr("step 1"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.steps.clear(); }), HasSubstr("no step"));
    EXPECT_THAT(refused([](PoseSequence& s) { s.steps.resize(kMaxPoseSteps + 1, s.steps[0]); }), HasSubstr("1000"));
}

} // namespace
} // namespace lumorph
