#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/motion_stage.h"
#include "core/motion/rig_motion.h"
#include "core/scene/measured_servos.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr double kPlay = 0.04;

/// Bent upwards by a parabola, with play; at its ends it reaches kPlay / 2 and 1 - kPlay / 2.
double middleAt(double u) { return u + 0.2 * u * (1.0 - u); }

MeasuredServo bentServo(const std::string& name) {
    MeasuredServo servo{.actuator = name, .points = {}};
    for (int k = 0; k <= 64; ++k) {
        const double u = k / 64.0;
        servo.points.push_back({u, middleAt(u) - 0.5 * kPlay, middleAt(u) + 0.5 * kPlay});
    }
    return servo;
}

TEST(MeasuredServosTest, PlayIsTakenUpWhereTheDirectionTurns) {
    const MeasuredServo servo = bentServo("a");
    double real = 0.0;
    for (const double u : {0.1, 0.3, 0.5}) {
        real = realStroke(servo, u, real);
        EXPECT_NEAR(real, middleAt(u) - 0.5 * kPlay, 1e-4);
    }
    const double top = real;
    real = realStroke(servo, 0.49, real); // within the play: it stands still
    EXPECT_EQ(real, top);
    real = realStroke(servo, 0.3, real);
    EXPECT_NEAR(real, middleAt(0.3) + 0.5 * kPlay, 1e-4);
    EXPECT_EQ(realStroke(servo, 0.3, real), real);
}

TEST(MeasuredServosTest, RealStrokeDoesNotDependOnTheStepsOfAWay) {
    const MeasuredServo servo = bentServo("a");
    double atOnce = realStroke(servo, 0.8, 0.0);
    atOnce = realStroke(servo, 0.2, atOnce);
    double bySteps = 0.0;
    for (int k = 0; k <= 80; ++k) bySteps = realStroke(servo, 0.01 * k, bySteps);
    for (int k = 80; k >= 20; --k) bySteps = realStroke(servo, 0.01 * k, bySteps);
    EXPECT_NEAR(atOnce, bySteps, 1e-12);
}

TEST(MeasuredServosTest, ServoWithoutPointsDoesWhatItIsTold) {
    EXPECT_EQ(realStroke({}, 0.37, 0.9), 0.37);
    const auto rig = test::lifterRig();
    EXPECT_TRUE(ServoCurves(rig.actuators(), {}).empty());
    EXPECT_TRUE(ServoCurves(rig.actuators(), std::vector{bentServo("another")}).empty());
}

TEST(MeasuredServosTest, CommandsBringServosWhereTheyAreWanted) {
    const auto rig = test::lifterRig();
    const ServoCurves curves(rig.actuators(), std::vector{bentServo(rig.actuators()[0].name)});
    std::vector<double> real(rig.actuatorCount(), 0.0), commands = real;
    double worst = 0.0;
    for (int k = 0; k < 200; ++k) {
        const double wanted = 0.5 + 0.45 * std::sin(0.7 * k);
        commands = curves.commandsFor(std::vector(rig.actuatorCount(), wanted), real, commands);
        curves.follow(commands, real);
        worst = std::max(worst, std::abs(real[0] - wanted));
        EXPECT_EQ(real[1], wanted); // it was not measured
    }
    std::printf("worst miss %.2e strokes\n", worst);
    EXPECT_LT(worst, ServoCurves::kTurn + 1e-9);
}

TEST(MeasuredServosTest, StrokesBeyondItsRangeAreLimited) {
    const auto rig = test::lifterRig();
    const ServoCurves curves(rig.actuators(), std::vector{bentServo(rig.actuators()[0].name)});
    std::vector<double> wanted{1.0, 1.0, 1.0};
    curves.limit(wanted);
    EXPECT_NEAR(wanted[0], 1.0 - 0.5 * kPlay, 1e-9);
    EXPECT_EQ(wanted[1], 1.0);
    wanted = {0.0, 0.0, 0.0};
    curves.limit(wanted);
    EXPECT_NEAR(wanted[0], 0.5 * kPlay, 1e-9);
    EXPECT_EQ(wanted[1], 0.0);
}

TEST(MeasuredServosTest, CurveThatSinksIsTakenAsLevel) {
    const auto rig = test::lifterRig();
    MeasuredServo servo{.actuator = rig.actuators()[0].name,
                        .points = {{0.0, 0.0, 0.0}, {0.4, 0.6, 0.6}, {0.6, 0.5, 0.5}, {1.0, 0.9, 0.9}}};
    const ServoCurves curves(rig.actuators(), std::vector{servo});
    std::vector<double> real{0.0, 0.0, 0.0};
    for (int k = 0; k <= 100; ++k) {
        const std::vector<double> before = real;
        curves.follow(std::vector{0.01 * k, 0.0, 0.0}, real);
        EXPECT_GE(real[0], before[0]);
    }
    EXPECT_NEAR(real[0], 0.9, 1e-12);
}

class MeasuredMotionTest : public testing::Test {
protected:
    std::shared_ptr<const Rig> rig = std::make_shared<const Rig>(test::lifterRig());
    [[nodiscard]] std::shared_ptr<const Installation> roomWith(std::vector<MeasuredServo> servos) const {
        auto room = std::make_shared<Installation>(defaultInstallation());
        room->servos = std::move(servos);
        return room;
    }
};

TEST_F(MeasuredMotionTest, WithoutMeasuredServosNothingChanges) {
    MotionStage with, without;
    with.follow(rig, nullptr);
    without.follow(rig, nullptr);
    with.use(roomWith({}));
    for (int k = 0; k < 100; ++k) {
        const std::vector<double> wanted{0.5 + 0.5 * std::sin(0.1 * k), 0.5 + 0.5 * std::cos(0.23 * k), 0.0};
        with.move(wanted, 0.016, false);
        without.move(wanted, 0.016, false);
        ASSERT_TRUE(std::ranges::equal(with.strokes(), without.strokes()));
        ASSERT_TRUE(std::ranges::equal(with.commands(), with.strokes()));
    }
}

TEST_F(MeasuredMotionTest, CommandsNeverJumpAndTheDeviceIsWhereItIsEstimated) {
    const MeasuredServo servo = bentServo(rig->actuators()[0].name);
    MotionStage motion;
    motion.use(roomWith({servo}));
    motion.follow(rig, nullptr);
    const double limit = motionLimits(*rig)[0].maxVelocity;
    double truth = 0.0, fastest = 0.0, apart = 0.0;
    double before = motion.commands()[0];
    for (int k = 0; k < 1600; ++k) {
        const double wanted = (k / 400) % 2 == 0 ? 0.8 : 0.3;
        motion.move(std::vector{wanted, 0.0, 0.0}, 0.01, false);
        truth = realStroke(servo, motion.commands()[0], truth);
        fastest = std::max(fastest, std::abs(motion.commands()[0] - before) / 0.01);
        before = motion.commands()[0];
        apart = std::max(apart, std::abs(truth - motion.strokes()[0]));
        if (k % 400 == 399) {
            EXPECT_NEAR(truth, wanted, 1e-4) << k;
            EXPECT_TRUE(motion.arrived(std::vector{wanted, 0.0, 0.0}));
        }
    }
    std::printf("fastest %.3f of %.3f strokes a second, estimate off by %.1e\n", fastest, limit, apart);
    EXPECT_LE(fastest, limit * (1.0 + 1e-9));
    EXPECT_LT(apart, 1e-12);
}

/// A horn that starts `lag` after each command and moves at `velocity`, and its part: the lab's servo, in steps of a
/// tenth of a millisecond.
class LateServo {
public:
    LateServo(MeasuredServo servo, double velocity) : servo_(std::move(servo)), velocity_(velocity) {}
    void command(double seconds, double stroke) { commands_.push_back({seconds, stroke}); }
    double at(double seconds) {
        constexpr double kStep = 1e-4;
        for (; now_ < seconds; now_ += kStep) {
            while (next_ < commands_.size() && commands_[next_].first + servo_.lagSeconds <= now_)
                target_ = commands_[next_++].second;
            horn_ += std::clamp(target_ - horn_, -velocity_ * kStep, velocity_ * kStep);
            part_ = realStroke(servo_, horn_, part_);
        }
        return part_;
    }

private:
    MeasuredServo servo_;
    double velocity_;
    std::vector<std::pair<double, double>> commands_;
    std::size_t next_ = 0;
    double now_ = 0.0, target_ = 0.0, horn_ = 0.0, part_ = 0.0;
};

TEST_F(MeasuredMotionTest, StrokesAreThoseThatServosHaveWhenTheLightComes) {
    const double kFrame = 1.0 / 60.0;
    const double velocity = motionLimits(*rig)[0].maxVelocity;
    // Servos that move before the light of the frame comes, at the same time, and after it.
    for (const double lag : {0.03, 0.06, 0.07, 0.13}) {
        MeasuredServo servo = bentServo(rig->actuators()[0].name), unknown = servo;
        servo.lagSeconds = lag;
        const auto roomOf = [this](const MeasuredServo& known) {
            auto room = std::make_shared<Installation>(*roomWith({known}));
            room->predictionSeconds = 0.06;
            return room;
        };
        MotionStage knowing, ignorant;
        knowing.follow(rig, nullptr);
        ignorant.follow(rig, nullptr);
        knowing.use(roomOf(servo));
        ignorant.use(roomOf(unknown));
        LateServo truth(servo, velocity);
        std::vector<double> seen, seenWithout, wishes;
        double before = 0.0;
        for (int k = 0; k < 480; ++k) {
            wishes.push_back((k / 120) % 2 == 0 ? 0.9 : 0.2);
            const std::vector<double> wanted{wishes.back(), 0.5, 0.0};
            knowing.move(wanted, kFrame, false);
            ignorant.move(wanted, kFrame, false);
            ASSERT_TRUE(std::ranges::equal(knowing.commands(), ignorant.commands())) << "what is told is the same";
            ASSERT_EQ(knowing.strokes()[1], ignorant.strokes()[1]) << "nothing is known of it";
            before = realStroke(unknown, ignorant.commands()[0], before);
            ASSERT_EQ(ignorant.strokes()[0], before) << "without a lag it is at once where it is told";
            truth.command(k * kFrame, knowing.commands()[0]);
            seen.push_back(knowing.strokes()[0]);
            seenWithout.push_back(ignorant.strokes()[0]);
        }
        double off = 0.0, offWithout = 0.0;
        int moving = 0;
        for (int k = 0; k < 470; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const double stands = truth.at(k * kFrame + 0.06);
            // Nobody foresees that the wish turns.
            if (k % 120 > 110 || k % 120 < 2 || std::abs(stands - wishes[at]) < 1e-3) continue;
            ++moving;
            off += std::abs(seen[at] - stands);
            offWithout += std::abs(seenWithout[at] - stands);
        }
        std::printf("lag %3.0f ms: off by %.4f strokes while it moves, without its lag %.4f (%d frames)\n", 1e3 * lag,
                    off / moving, offWithout / moving, moving);
        EXPECT_GT(moving, 100);
        EXPECT_LT(off / moving, 0.003);
        EXPECT_LT(off, 0.5 * offWithout);
        for (int k = 0; k < 60; ++k)
            for (MotionStage* motion : {&knowing, &ignorant}) motion->move(std::vector{0.2, 0.5, 0.0}, kFrame, false);
        EXPECT_TRUE(knowing.stands());
        EXPECT_EQ(knowing.strokes()[0], ignorant.strokes()[0]) << "at rest it changes nothing";
    }
}

TEST_F(MeasuredMotionTest, WhatWasToldIsOnItsWayWhenAllIsStopped) {
    MeasuredServo servo{.actuator = rig->actuators()[0].name, .points = {}, .lagSeconds = 0.1};
    MotionStage motion;
    auto room = std::make_shared<Installation>(*roomWith({servo}));
    room->predictionSeconds = 0.0;
    motion.use(room);
    motion.follow(rig, nullptr);
    const std::vector<double> wanted{1.0, 0.0, 0.0};
    for (int k = 0; k < 30; ++k) motion.move(wanted, 0.01, false);
    const double told = motion.commands()[0], stood = motion.strokes()[0];
    EXPECT_LT(stood, told - 0.02);
    for (int k = 0; k < 5; ++k) motion.move(wanted, 0.01, true);
    EXPECT_FALSE(motion.stands());
    EXPECT_GT(motion.strokes()[0], stood);
    for (int k = 0; k < 7; ++k) motion.move(wanted, 0.01, true);
    EXPECT_TRUE(motion.stands());
    EXPECT_EQ(motion.strokes()[0], told);
    motion.standAt(std::vector{0.25, 0.0, 0.0});
    EXPECT_EQ(motion.strokes()[0], 0.25);
    EXPECT_TRUE(motion.stands());
}

TEST_F(MeasuredMotionTest, StandsWhereARecordingLeftIt) {
    MotionStage motion;
    motion.use(roomWith({bentServo(rig->actuators()[0].name)}));
    motion.follow(rig, nullptr);
    motion.standAt(std::vector{0.5, 0.25, 0.0});
    EXPECT_EQ(motion.strokes()[0], 0.5);
    motion.move(std::vector{0.5, 0.25, 0.0}, 0.01, false);
    EXPECT_NEAR(motion.strokes()[0], 0.5, 1e-12);
    EXPECT_NEAR(middleAt(motion.commands()[0]), 0.5, 1e-3);
}

} // namespace
} // namespace lumorph
