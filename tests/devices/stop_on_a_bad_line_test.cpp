// STOP over a line that loses or breaks bytes: controller and simulated board without threads, a faulty line between
// them both ways, many seeds.

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "devices/controllers/servo_controller.h"
#include "devices/controllers/servo_guard.h"
#include "devices/simulator/faulty_line.h"
#include "devices/simulator/simulated_bench.h"
#include "tests/devices/guard_key.h"

namespace lumorph {
namespace {

struct BadLineCase {
    const char* board;
    ControllerKind controller;
    int first;        ///< channel of the board's first servo
    const char* baud; ///< of the address
};

constexpr std::size_t kServos = 6;
constexpr std::uint64_t kSeeds = 250;

/// Six servos that move, on a line of a certain seed.
class BadLine {
public:
    BadLine(const BadLineCase& board, std::uint64_t seed)
        : toBoard_(2 * seed, board.controller == ControllerKind::lewansoul),
          toStudio_(2 * seed + 1, board.controller == ControllerKind::lewansoul), board_(bench_.board(board.board)) {
        profile_.controller = board.controller;
        profile_.address = "sim://" + std::string(board.board) + "?baud=" + board.baud;
        profile_.staggerSeconds = 0.0;
        for (std::size_t i = 0; i < kServos; ++i)
            profile_.servos.push_back({.channel = board.first + static_cast<int>(i)});
        controller_ = makeController(profile_, parseDeviceAddress(profile_.address));
        guard_ = std::make_unique<ServoGuard>(testGuardKey(), profile_);
        clock_->advance(Microseconds{1'000'000});
        board_->plugged(clock_->now());
        controller_->opened(board_->product(), clock_->now());
        guard_->arm(true);
        (void)guard_->want(std::vector<double>(kServos, 0.5));
        pass(2'000'000);
    }

    void pass(long microseconds) {
        for (const Microseconds end = clock_->now() + Microseconds{microseconds}; clock_->now() < end;) step();
    }
    void move() { (void)guard_->want(std::vector<double>(kServos, wave_ = 1.0 - wave_)); }
    void stop() {
        guard_->stop();
        letGo_.assign(kServos, false);
    }
    void setFaults(const BoardFaults& faults) { faults_ = faults; }
    /// Servos that have been limp since STOP.
    [[nodiscard]] std::size_t letGo() const { return static_cast<std::size_t>(std::ranges::count(letGo_, true)); }
    /// Of the profile's servos: a broken number may be that of another.
    [[nodiscard]] std::size_t attached() const {
        const std::vector<SimulatedServo> servos = board_->servos();
        return static_cast<std::size_t>(std::ranges::count_if(
            std::span(servos).first(kServos), [](const SimulatedServo& servo) { return servo.pulse > 0.0; }));
    }
    [[nodiscard]] std::size_t bytesSent() const { return sent_; }

private:
    /// What the link's thread does every 5 ms.
    void step() {
        clock_->advance(Microseconds{5'000});
        const Microseconds now = clock_->now();
        for (std::vector<std::uint8_t> said = board_->give(now); !said.empty(); said = board_->give(now))
            toStudio_.send(std::move(said), faults_, now);
        while (toStudio_.next()) controller_->received(toStudio_.take(), now);
        controller_->tick(now);
        controller_->send(guard_->step(now), now);
        for (std::vector<std::uint8_t>& message : controller_->takeOutput()) {
            sent_ += message.size();
            toBoard_.send(std::move(message), faults_, now);
        }
        while (toBoard_.next()) board_->take(toBoard_.take(), now);
        const std::vector<SimulatedServo> servos = board_->servos();
        for (std::size_t i = 0; i < letGo_.size(); ++i) letGo_[i] = letGo_[i] || servos[i].pulse == 0.0;
    }

    std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
    SimulatedBench bench_{clock_};
    BoardFaults faults_;
    FaultyLine toBoard_;
    FaultyLine toStudio_;
    DeviceProfile profile_;
    std::shared_ptr<SimulatedBoard> board_;
    std::unique_ptr<ServoController> controller_;
    std::unique_ptr<ServoGuard> guard_;
    double wave_ = 0.0;
    std::vector<bool> letGo_;
    std::size_t sent_ = 0;
};

class ServoControllerOnABadLine : public testing::TestWithParam<BadLineCase> {
protected:
    /// All are limp a second after STOP, and stay so. A Maestro without checksums takes for a target what a message
    /// that lost a byte and the next one make together: on such a line no word is the last, and each was let go once.
    void expectAllLimp(const BoardFaults& faults) {
        const bool makesUpTargets = GetParam().controller == ControllerKind::maestro;
        long slowest = 0;
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            BadLine line(GetParam(), seed);
            ASSERT_EQ(line.attached(), kServos);
            line.setFaults(faults);
            line.move();
            line.pass(300'000); // messages are cut wherever it may be
            line.stop();
            long passed = 0;
            for (; passed < 1'000'000 && line.letGo() < kServos; passed += 5'000) line.pass(5'000);
            slowest = std::max(slowest, passed);
            ASSERT_EQ(line.letGo(), kServos) << "seed " << seed;
            line.pass(1'000'000 - passed);
            if (!makesUpTargets) {
                ASSERT_EQ(line.attached(), 0U) << "seed " << seed;
            }
            line.setFaults({});
            if (makesUpTargets) line.pass(2'000'000); // each is asked for in turn
            for (int i = 0; i < 100; ++i) {
                line.pass(10'000);
                ASSERT_EQ(line.attached(), 0U) << "seed " << seed << ", on a sound line";
            }
        }
        std::printf("%s: the last of %zu servos let go after %ld ms at the latest, of %d lines\n", GetParam().board,
                    kServos, slowest / 1000, static_cast<int>(kSeeds));
    }
};

TEST_P(ServoControllerOnABadLine, ThatLosesEachFifthByte) { expectAllLimp({.drop = 0.2}); }

TEST_P(ServoControllerOnABadLine, ThatBreaksEachTwentiethByte) { expectAllLimp({.noise = 0.05}); }

TEST_P(ServoControllerOnABadLine, ThatIsDeadForHalfASecond) {
    BadLine line(GetParam(), 1);
    line.setFaults({.drop = 1.0});
    line.stop();
    line.pass(500'000);
    line.setFaults({});
    line.pass(50'000);
    EXPECT_EQ(line.attached(), 0U);
}

TEST_P(ServoControllerOnABadLine, ASoundLineIsSilentSoon) {
    BadLine line(GetParam(), 1);
    line.stop();
    line.pass(5'000);
    EXPECT_EQ(line.attached(), 0U);
    line.pass(1'000'000);
    const std::size_t before = line.bytesSent();
    line.pass(10'000'000);
    std::printf("%s: %zu bytes a second while stopped\n", GetParam().board, (line.bytesSent() - before) / 10);
    EXPECT_LT(line.bytesSent() - before, 10U * 140U);
}

INSTANTIATE_TEST_SUITE_P(Boards, ServoControllerOnABadLine,
                         testing::Values(BadLineCase{"tablet", ControllerKind::firmata, 2, "57600"},
                                         BadLineCase{"uno", ControllerKind::firmata, 2, "57600"},
                                         BadLineCase{"uno", ControllerKind::firmata, 2, "9600"},
                                         BadLineCase{"xarm", ControllerKind::lewansoul, 1, "57600"},
                                         BadLineCase{"maestro", ControllerKind::maestro, 0, "57600"}),
                         [](const auto& board) { return board.param.board + std::string("At") + board.param.baud; });

} // namespace
} // namespace lumorph
