// Guard and controller without threads, and a simulated board that hears their bytes: what its servos are told is what
// was promised.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "devices/controllers/servo_controller.h"
#include "devices/controllers/servo_guard.h"
#include "devices/simulator/simulated_bench.h"
#include "tests/devices/guard_key.h"
#include "tests/support/simulated_devices.h"

namespace lumorph {
namespace {

struct WireCase {
    const char* board;
    ControllerKind controller;
    int first;   ///< channel of the board's first servo
    double step; ///< microseconds between two pulses it can be told
};

class ServoGuardOnTheWire : public testing::TestWithParam<WireCase> {
protected:
    ServoGuardOnTheWire() {
        profile_.controller = GetParam().controller;
        profile_.address = "sim://" + std::string(GetParam().board);
        profile_.staggerSeconds = 0.05;
        profile_.servos = test::unevenServos(GetParam().first);
        board_ = bench_.board(GetParam().board);
        controller_ = makeController(profile_, parseDeviceAddress(profile_.address));
        guard_ = std::make_unique<ServoGuard>(testGuardKey(), profile_);
        pass(1'000'000);
        board_->plugged(clock_->now());
        controller_->opened(board_->product(), clock_->now());
        controller_->confirm();
        for (int i = 0; i < 400 && controller_->state().phase != ControllerPhase::ready; ++i) {
            exchange(10'000);
            controller_->confirm();
        }
    }

    void pass(long microseconds) { clock_->advance(Microseconds{microseconds}); }
    void exchange(long microseconds) {
        pass(microseconds);
        const Microseconds now = clock_->now();
        for (std::vector<std::uint8_t> said = board_->give(now); !said.empty(); said = board_->give(now))
            controller_->received(said, now);
        controller_->tick(now);
        const GuardedPulses pulses = guard_->step(now);
        attached_ += std::ranges::count_if(pulses.servos(), &GuardedPulse::attached);
        controller_->send(pulses, now);
        for (const std::vector<std::uint8_t>& message : controller_->takeOutput()) board_->take(message, now);
    }
    void knowTruth() {
        const std::vector<SimulatedServo> servos = board_->servos();
        for (std::size_t i = 0; i < profile_.servos.size(); ++i)
            guard_->setKnown(i, strokeOf(profile_.servos[i], servoOf(servos, i).position));
    }
    const SimulatedServo& servoOf(const std::vector<SimulatedServo>& servos, std::size_t i) const {
        return servos.at(static_cast<std::size_t>(profile_.servos[i].channel - GetParam().first));
    }
    void command() {
        std::vector<double> strokes(pick(50) == 0 ? pick(6) : 3);
        for (double& stroke : strokes) stroke = std::uniform_real_distribution(-0.3, 1.3)(random_);
        if (pick(40) == 0 && !strokes.empty()) strokes[pick(strokes.size())] = pick(2) ? NAN : 1e30;
        (void)guard_->want(strokes);
    }
    std::size_t pick(std::size_t count) { return random_() % count; }

    std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
    SimulatedBench bench_{clock_};
    DeviceProfile profile_;
    std::shared_ptr<SimulatedBoard> board_;
    std::unique_ptr<ServoController> controller_;
    std::unique_ptr<ServoGuard> guard_;
    std::mt19937 random_{7};
    std::ptrdiff_t attached_ = 0;
};

TEST_P(ServoGuardOnTheWire, KeepsEveryLimitOnTheBoard) {
    ASSERT_EQ(controller_->state().phase, ControllerPhase::ready);
    knowTruth();
    guard_->arm(false);
    std::vector<double> low(3, 1e9), high(3, 0.0);
    for (int i = 0; i < 100'000; ++i) {
        if (pick(4) == 0) command();
        if (pick(300) == 0) (void)guard_->wiggle(pick(3));
        if (pick(300) == 0) guard_->setSlow(pick(2) == 0);
        if (pick(2000) == 0) guard_->stop();
        if (pick(2000) == 0) guard_->disarm();
        if (pick(500) == 0) {
            // Long enough that what was moving has come to rest.
            for (int k = 0; k < 40; ++k) exchange(5'000);
            guard_->arm(false);
        }
        exchange(pick(200) == 0 ? 90'000 : 1'000 + static_cast<long>(pick(12'000)));
        const std::vector<SimulatedServo> servos = board_->servos();
        for (std::size_t k = 0; k < 3; ++k) {
            const double pulse = servoOf(servos, k).pulse;
            if (pulse == 0.0) continue;
            ASSERT_GE(pulse, profile_.servos[k].pulseMin) << "servo " << k << ", use " << i;
            ASSERT_LE(pulse, profile_.servos[k].pulseMax) << "servo " << k << ", use " << i;
            low[k] = std::min(low[k], pulse);
            high[k] = std::max(high[k], pulse);
        }
    }
    EXPECT_GT(attached_, 100'000);
    const double period = 1.0 / std::min(profile_.commandsPerSecond, controller_->state().traits.commandsPerSecond);
    const std::vector<SimulatedServo> servos = board_->servos();
    for (std::size_t k = 0; k < 3; ++k) {
        const ServoSetup& setup = profile_.servos[k];
        const double span = setup.pulseMax - setup.pulseMin;
        // Rounding to the board's steps: one, between two commands. The jump: what was on its way when it was stopped.
        EXPECT_LE(servoOf(servos, k).fastest, setup.maxVelocity * span + 1.01 * GetParam().step / period + 1e-6)
            << "servo " << k;
        EXPECT_LE(servoOf(servos, k).largestJump, setup.maxVelocity * span * (period + 0.1) + 2.0 * GetParam().step)
            << "servo " << k;
        EXPECT_GE(servoOf(servos, k).fastest, 0.5 * setup.maxVelocity * span) << "it was a test of servos that move";
        EXPECT_LE(low[k], setup.pulseMin + 0.2 * span);
        EXPECT_GE(high[k], setup.pulseMax - 0.2 * span);
    }
}

TEST_P(ServoGuardOnTheWire, LetsGoOfAllServosAtOnceWhenStopped) {
    knowTruth();
    guard_->arm(false);
    for (int i = 0; i < 200; ++i) exchange(5'000);
    const std::vector<double> strokes(3, 1.0);
    ASSERT_TRUE(guard_->want(strokes));
    for (int i = 0; i < 20; ++i) exchange(5'000);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(servoOf(board_->servos(), k).pulse, 0.0);
    guard_->stop();
    exchange(5'000);
    for (int i = 0; i < 400; ++i) {
        exchange(5'000);
        for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(servoOf(board_->servos(), k).pulse, 0.0) << "servo " << k;
        (void)guard_->want(strokes);
    }
}

INSTANTIATE_TEST_SUITE_P(Boards, ServoGuardOnTheWire,
                         testing::Values(WireCase{"tablet", ControllerKind::firmata, 2, 1.0},
                                         WireCase{"xarm", ControllerKind::lewansoul, 1, 2.0},
                                         WireCase{"maestro", ControllerKind::maestro, 0, 0.25}),
                         [](const auto& board) { return std::string(board.param.board); });

} // namespace
} // namespace lumorph
