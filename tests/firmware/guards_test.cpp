#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/firmware/board.h"
#include "tests/firmware/firmata_bytes.h"
#include "tests/firmware/twelve.h"

namespace lumorph::firmware_test {
namespace {

class FirmwareGuards : public testing::TestWithParam<int> {
protected:
    FirmwareGuards() : board_("six", GetParam()) {
        board_.run(60.0);
        board_.send(write(9, 1700));
        board_.send(attach(9));
        board_.send(write(10, 1300));
        board_.send(attach(10));
        board_.runUntilSent();
    }
    bool says(const Bytes& said, const std::string& text) {
        std::string plain;
        for (const std::uint8_t byte : said)
            if (byte != 0) plain += static_cast<char>(byte);
        return plain.find(text) != std::string::npos;
    }
    Board board_;
};

TEST_P(FirmwareGuards, SilenceHoldsForHalfASecondAndThenLetsGo) {
    for (int i = 0; i < 12; ++i) {
        // Bytes end at another place in the frame each time.
        board_.run(100.0 + 1.7 * i);
        board_.send(attach(9));
        board_.send(attach(10));
        while (board_.isSending()) board_.run(0.1);
        const double last = board_.now();
        (void)board_.takePulses();
        (void)board_.takeSaid();
        board_.run(900.0);
        const std::vector<Pulse> pulses = board_.takePulses();
        ASSERT_GT(pulses.size(), 40U);
        const double off = pulses.back().start + 20.0; // when the next pulse should have come
        EXPECT_GE(off - last, 500.0);
        EXPECT_LE(off - last, 600.0);
        for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, pulse.pin == 9 ? 1700.0 : 1300.0, 4.0);
        EXPECT_TRUE(says(board_.takeSaid(), "Silence: servos let go"));
    }
    // Only an attach brings them back, not a write.
    board_.send(write(9, 1600));
    board_.runUntilSent();
    (void)board_.takePulses();
    board_.run(100.0);
    EXPECT_TRUE(board_.takePulses().empty());
}

TEST_P(FirmwareGuards, AnyByteKeepsItAwake) {
    for (int i = 0; i < 8; ++i) {
        board_.send({0xF9});
        board_.run(480.0);
    }
    (void)board_.takePulses();
    board_.send({0xF9});
    board_.run(100.0);
    EXPECT_GE(board_.takePulses().size(), 2U * 4U);
}

TEST_P(FirmwareGuards, AHangLetsServosGoAndStartsAnew) {
    board_.run(33.3);
    (void)board_.takePulses();
    (void)board_.takeSaid();
    const double hung = board_.now();
    board_.hang(true);
    board_.run(400.0);
    for (const Pulse& pulse : board_.takePulses()) {
        EXPECT_LE(pulse.start, hung + 300.0);
        EXPECT_NEAR(pulse.width, pulse.pin == 9 ? 1700.0 : 1300.0, 4.0);
    }
    const Bytes said = board_.takeSaid();
    ASSERT_GE(said.size(), 3U);
    EXPECT_EQ(said[0], 0xF9);
    EXPECT_TRUE(says(said, "LumorphTablet"));
    EXPECT_TRUE(says(said, "Started anew: it hung"));
    EXPECT_FALSE(board_.isHigh(9));
    board_.send(write(9, 1500));
    board_.send(attach(9));
    board_.runUntilSent();
    board_.run(60.0);
    const std::vector<Pulse> pulses = board_.takePulses();
    ASSERT_FALSE(pulses.empty());
    for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, 1500.0, 4.0);
}

TEST_P(FirmwareGuards, AHangWithAStandingTimerEndsInAReset) {
    board_.run(33.3);
    while (board_.isHigh(9) || board_.isHigh(10)) board_.run(0.1);
    (void)board_.takePulses();
    (void)board_.takeSaid();
    board_.hang(false);
    board_.run(700.0);
    EXPECT_TRUE(board_.takePulses().empty());
    EXPECT_TRUE(says(board_.takeSaid(), "Started anew: it hung"));
    board_.send(write(9, 1500));
    board_.send(attach(9));
    board_.runUntilSent();
    board_.run(60.0);
    EXPECT_FALSE(board_.takePulses().empty());
}

INSTANTIATE_TEST_SUITE_P(Clocks, FirmwareGuards, testing::Values(8, 16),
                         [](const auto& clock) { return std::to_string(clock.param) + "MHz"; });

/// Two minutes of what a bad line, a wrong program or an enemy may send.
class FirmwareGarbage : public testing::TestWithParam<int> {
protected:
    Bytes some() {
        const int pin = pins_[random_() % pins_.size()];
        const auto value = static_cast<int>(random_() % 4096);
        switch (random_() % 10) {
        case 0:
            return attach(pin);
        case 1:
            return limits(pin, value, static_cast<int>(random_() % 4096));
        case 2:
            return random_() % 8 == 0 ? Bytes{0xFF} : detach(pin);
        case 3:
        case 4:
            return noise(1 + random_() % 40);
        case 5:
            return {0xF0, 0x6F, static_cast<std::uint8_t>(pin), low(value), high(value), low(value), 0xF7};
        case 6: {
            Bytes cut = write(16, value);
            cut.resize(random_() % cut.size());
            return cut;
        }
        default:
            return write(pin, value);
        }
    }
    Bytes noise(std::size_t count) {
        Bytes bytes(count);
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random_());
        return bytes;
    }

    std::mt19937 random_{11};
    std::vector<int> pins_;
};

TEST_P(FirmwareGarbage, NeverLeavesTheLimits) {
    const bool isTwelve = GetParam() == 8;
    Board board(isTwelve ? "twelve" : "six", GetParam());
    const std::vector<ServoSetup> servos = (isTwelve ? twelveServos() : sixServos()).servos;
    for (const ServoSetup& servo : servos) pins_.push_back(servo.channel);
    board.run(60.0);
    std::size_t count = 0;
    double widest = 0.0;
    double narrowest = 1e9;
    while (board.now() < 120'000.0) {
        if (random_() % 400 == 0) board.run(700.0); // silence
        for (int i = 0; i < 20; ++i) board.send(some());
        while (board.isSending()) board.run(5.0);
        for (const Pulse& pulse : board.takePulses()) {
            const auto servo =
                std::find_if(servos.begin(), servos.end(), [&](const ServoSetup& s) { return s.channel == pulse.pin; });
            ASSERT_NE(servo, servos.end()) << "pin " << pulse.pin;
            ASSERT_GE(pulse.width, servo->pulseMin) << "pin " << pulse.pin;
            ASSERT_LE(pulse.width, servo->pulseMax) << "pin " << pulse.pin;
            widest = std::max(widest, pulse.width);
            narrowest = std::min(narrowest, pulse.width);
            ++count;
        }
    }
    std::printf("%zu pulses from %.2f to %.2f us\n", count, narrowest, widest);
    EXPECT_GT(count, 5'000U) << "it moved at all";
    board.run(20.0);
    (void)board.takeSaid();
    board.send({0xF7, 0xF9});
    board.run(100.0);
    const Bytes said = board.takeSaid();
    const Bytes version = {0xF9, 2, 5};
    EXPECT_NE(std::search(said.begin(), said.end(), version.begin(), version.end()), said.end()) << "it still answers";
}

INSTANTIATE_TEST_SUITE_P(Boards, FirmwareGarbage, testing::Values(8, 16),
                         [](const auto& clock) { return std::to_string(clock.param) + "MHz"; });

} // namespace
} // namespace lumorph::firmware_test
