#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "tests/devices/simulated_wire.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = SimulatedWire::Bytes;

/// Pin 2 and the ones after it of a Firmata board, at 1500 us.
void attach(SimulatedWire& wire, int servos) {
    for (int i = 0; i < servos; ++i) {
        const auto pin = static_cast<std::uint8_t>(2 + i);
        wire.send({0xF4, pin, 0x04, static_cast<std::uint8_t>(0xE0 + pin), 0x5C, 0x0B});
    }
}

Bytes write(int pin, int microseconds) {
    return {static_cast<std::uint8_t>(0xE0 + pin), static_cast<std::uint8_t>(microseconds & 0x7F),
            static_cast<std::uint8_t>(microseconds >> 7)};
}

TEST(SimulatedBench, HasFourBoardsAndNoOther) {
    const SimulatedBench bench(std::make_shared<ManualClock>());
    EXPECT_EQ(bench.names(), (std::vector<std::string>{"tablet", "uno", "xarm", "maestro"}));
    for (const std::string& name : bench.names()) {
        const auto board = bench.board(name);
        ASSERT_TRUE(board);
        EXPECT_EQ(board->name(), name);
        EXPECT_EQ(board->faults(), BoardFaults{});
        EXPECT_GE(board->servos().size(), 6U);
        EXPECT_EQ(board->isHid(), name == "xarm");
    }
    EXPECT_FALSE(bench.board("no such"));
}

TEST(SimulatedServos, TakeTheirTime) {
    SimulatedWire wire("tablet");
    attach(wire, 1);
    wire.send(write(2, 2000));
    wire.wait(100ms); // 60 degrees, 666.7 us, take 0.17 s
    EXPECT_NEAR(wire.servo(0).position, 1500.0 + 2000.0 / 3.0 * 100.0 / 170.0, 1e-6);
    EXPECT_EQ(wire.servo(0).pulse, 2000.0);
    wire.wait(100ms);
    EXPECT_EQ(wire.servo(0).position, 2000.0);
}

TEST(SimulatedServos, LimpOnesStay) {
    SimulatedWire wire("tablet");
    attach(wire, 1);
    wire.send(write(2, 2000));
    wire.wait(50ms);
    wire.send({0xF4, 0x02, 0x01});
    const double where = wire.servo(0).position;
    EXPECT_GT(where, 1600.0);
    EXPECT_LT(where, 1800.0);
    wire.wait(1h);
    EXPECT_EQ(wire.servo(0).position, where);
}

TEST(SimulatedServos, TellTheFastestChangeOfTheirPulse) {
    SimulatedWire wire("tablet");
    attach(wire, 1);
    wire.wait(100ms);
    wire.send(write(2, 1510)); // 100 us/s
    EXPECT_NEAR(wire.servo(0).fastest, 100.0, 1e-6);
    wire.wait(20ms);
    wire.send(write(2, 1480)); // 1500 us/s
    EXPECT_NEAR(wire.servo(0).fastest, 1500.0, 1e-6);
    wire.wait(20ms);
    wire.send(write(2, 1490));
    EXPECT_NEAR(wire.servo(0).fastest, 1500.0, 1e-6) << "the greatest";
    // What comes out of a buffer all at once is one change: from 1490 to 1450 in 40 ms.
    wire.wait(40ms);
    for (const int pulse : {1480, 1470, 1450}) wire.send(write(2, pulse));
    EXPECT_NEAR(wire.servo(0).fastest, 1500.0, 1e-6);
    wire.wait(10ms);
    wire.send(write(2, 1500)); // 5000 us/s
    EXPECT_NEAR(wire.servo(0).fastest, 5000.0, 1e-6);
    EXPECT_EQ(wire.servo(0).largestJump, 0.0);
}

TEST(SimulatedServos, AnAttachIsAJumpAndNoSpeed) {
    SimulatedWire wire("tablet");
    attach(wire, 1);
    wire.send({0xF4, 0x02, 0x01});
    wire.wait(1ms);
    wire.send(write(2, 1900));
    wire.send({0xF4, 0x02, 0x04});
    EXPECT_EQ(wire.servo(0).largestJump, 400.0);
    EXPECT_EQ(wire.servo(0).fastest, 0.0);
}

TEST(SimulatedBoard, AWeakBatteryBreaksDownWhenThreeServosMove) {
    for (const auto& [volts, servos, breaks] : {std::tuple{5.1, 3, true}, {5.1, 2, false}, {5.3, 12, false}}) {
        SimulatedWire wire("uno");
        attach(wire, servos);
        wire.wait(1s);
        wire.fault([volts = volts](BoardFaults& faults) { faults.volts = volts; });
        EXPECT_GT(wire.servo(0).pulse, 0.0) << "holding costs little";
        for (int i = 0; i < servos; ++i) wire.send(write(2 + i, 1800));
        EXPECT_EQ(wire.servo(0).pulse == 0.0, breaks) << volts << " V, " << servos;
        wire.wait(3s);
        const Bytes said = wire.receive();
        EXPECT_EQ(said.size() > 3 && said[0] == 0xF9, breaks) << volts << " V, " << servos;
    }
}

TEST(SimulatedBoard, ABatteryMayFailInTheMiddleOfAMove) {
    SimulatedWire wire("maestro");
    for (std::uint8_t channel = 0; channel < 3; ++channel) wire.send({0x84, channel, 0x40, 0x3E}); // 2000 us
    wire.wait(20ms);
    EXPECT_EQ(wire.servo(0).pulse, 2000.0);
    wire.fault([](BoardFaults& faults) { faults.volts = 5.0; });
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    EXPECT_EQ(wire.ask({0xA1}), Bytes{}) << "it is starting";
    wire.wait(1s);
    EXPECT_EQ(wire.ask({0xA1}), (Bytes{0x00, 0x00}));
}

TEST(SimulatedBoard, ASilentOneObeysAndSaysNothing) {
    SimulatedWire wire("tablet");
    wire.fault([](BoardFaults& faults) { faults.silent = true; });
    attach(wire, 1);
    EXPECT_EQ(wire.ask({0xF9}), Bytes{});
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
    wire.fault([](BoardFaults& faults) { faults.silent = false; });
    EXPECT_EQ(wire.receive(), Bytes{}) << "what was not said is not said later";
    EXPECT_EQ(wire.ask({0xF9}), (Bytes{0xF9, 0x02, 0x05}));
}

TEST(SimulatedBoard, AStalledLinkPassesNothingOnUntilItGoesOn) {
    SimulatedWire wire("tablet");
    attach(wire, 1);
    wire.send({0xF9});
    wire.fault([](BoardFaults& faults) { faults.stalled = true; });
    EXPECT_EQ(wire.ask(write(2, 1600)), Bytes{}) << "neither there nor back";
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
    wire.wait(500ms);
    EXPECT_EQ(wire.servo(0).pulse, 0.0) << "the firmware hears nothing";
    wire.send({0xF4, 0x02, 0x04});
    wire.fault([](BoardFaults& faults) { faults.stalled = false; });
    EXPECT_EQ(wire.receive(), (Bytes{0xF9, 0x02, 0x05}));
    EXPECT_EQ(wire.servo(0).pulse, 1600.0) << "what was on its way arrives in order";
}

TEST(SimulatedBoard, ANewLinkKnowsNothingOfTheOldOnesBytes) {
    SimulatedWire wire("tablet");
    wire.send({0xF9});
    wire.board->plugged(wire.now());
    EXPECT_EQ(wire.receive(), Bytes{});
}

/// What a board says to many questions.
Bytes answersWith(const char* name, const BoardFaults& faults, const Bytes& question, int times = 2000) {
    SimulatedWire wire(name);
    wire.board->setFaults(faults);
    Bytes answers;
    for (int i = 0; i < times; ++i) {
        const Bytes answer = wire.ask(question);
        answers.insert(answers.end(), answer.begin(), answer.end());
        wire.wait(1ms);
    }
    return answers;
}

TEST(SimulatedBoard, FaultsAreTheSameEveryTime) {
    const BoardFaults faults{.noise = 0.02, .drop = 0.02, .jitterMilliseconds = 3.0};
    for (const char* name : {"tablet", "uno", "xarm", "maestro"}) {
        const Bytes question = name == std::string("xarm") ? Bytes{0x55, 0x55, 0x02, 0x0F} : Bytes{0xF9, 0xA1};
        const Bytes first = answersWith(name, faults, question);
        EXPECT_GT(first.size(), 1000U) << name;
        EXPECT_EQ(first, answersWith(name, faults, question)) << name;
        EXPECT_NE(first, answersWith(name, {}, question)) << name;
    }
}

TEST(SimulatedBoard, DropLosesItsShareBothWays) {
    // Of F9 a share d is lost on the way there; of each byte of its answer, on the way back.
    const Bytes answers = answersWith("uno", {.drop = 0.1}, {0xF9}, 20000);
    EXPECT_NEAR(static_cast<double>(answers.size()) / 60000.0, 0.9 * 0.9, 0.01);
    EXPECT_EQ(answersWith("uno", {.drop = 1.0}, {0xF9}), Bytes{});
    // A report is lost as a whole.
    const Bytes reports = answersWith("xarm", {.drop = 0.1}, {0x55, 0x55, 0x02, 0x0F}, 20000);
    EXPECT_EQ(reports.size() % 64, 0U);
    EXPECT_NEAR(static_cast<double>(reports.size()) / 64.0 / 20000.0, 0.9 * 0.9, 0.01);
}

TEST(SimulatedBoard, NoiseBreaksItsShareOfBytes) {
    SimulatedWire wire("xarm");
    const Bytes whole = wire.ask({0x55, 0x55, 0x02, 0x0F});
    wire.fault([](BoardFaults& faults) { faults.noise = 0.05; });
    int broken = 0;
    int bytes = 0;
    int answers = 0;
    for (int i = 0; i < 5000; ++i) {
        const Bytes answer = wire.ask({0x55, 0x55, 0x02, 0x0F});
        if (answer.empty()) continue;
        ++answers;
        ASSERT_EQ(answer.size(), whole.size());
        for (std::size_t j = 0; j < answer.size(); ++j) broken += answer[j] != whole[j];
        bytes += 64;
    }
    EXPECT_NEAR(broken / static_cast<double>(bytes), 0.05, 0.003);
    EXPECT_NEAR(answers / 5000.0, std::pow(0.95, 4), 0.02) << "a broken question has no answer";
}

TEST(SimulatedBoard, JitterDelaysButKeepsTheOrder) {
    SimulatedWire wire("uno");
    wire.fault([](BoardFaults& faults) { faults.jitterMilliseconds = 40.0; });
    Bytes asked;
    Bytes heard;
    int late = 0;
    for (int i = 0; i < 100; ++i) {
        const auto pin = static_cast<std::uint8_t>(i);
        const Bytes question{0xF0, 0x6D, static_cast<std::uint8_t>(20 + pin), 0xF7}; // no such pin: it names it
        asked.push_back(question[2]);
        const Bytes at_once = wire.ask(question);
        late += at_once.empty() ? 1 : 0;
        heard.insert(heard.end(), at_once.begin(), at_once.end());
        wire.wait(5ms);
    }
    wire.wait(80ms); // the longest there and back
    const Bytes rest = wire.receive();
    heard.insert(heard.end(), rest.begin(), rest.end());
    Bytes named;
    for (std::size_t i = 2; i < heard.size(); i += 4) named.push_back(heard[i]);
    EXPECT_EQ(named, asked);
    EXPECT_GT(late, 50);
}

TEST(SimulatedBoard, FaultsThatCannotBeAreNone) {
    SimulatedWire wire("uno");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    wire.board->setFaults({.noise = nan, .drop = -1.0, .jitterMilliseconds = nan, .volts = nan});
    EXPECT_EQ(wire.board->faults(), BoardFaults{.volts = 0.0});
    EXPECT_EQ(wire.ask({0xF9}), (Bytes{0xF9, 0x02, 0x05}));
}

TEST(SimulatedBoard, SurvivesAnyBytes) {
    std::uint32_t state = 1;
    for (const char* name : {"tablet", "uno", "xarm", "maestro"}) {
        SimulatedWire wire(name);
        for (int i = 0; i < 20000; ++i) {
            Bytes bytes(1 + i % 64);
            for (std::uint8_t& byte : bytes) {
                state = state * 1664525U + 1013904223U;
                byte = static_cast<std::uint8_t>(state >> 24U);
            }
            if (wire.board->isHid() && bytes.size() > 4) {
                bytes[0] = bytes[1] = 0x55;
                bytes[2] = static_cast<std::uint8_t>(bytes.size() - 2);
                bytes[3] = Bytes{0x03, 0x0F, 0x14, 0x15}[bytes[3] % 4];
            }
            (void)wire.ask(bytes);
            wire.wait(3ms);
        }
        for (const SimulatedServo& servo : wire.board->servos()) {
            EXPECT_TRUE(servo.position >= 500.0 && servo.position <= 2500.0) << name;
            EXPECT_TRUE(std::isfinite(servo.fastest) && std::isfinite(servo.largestJump)) << name;
        }
    }
}

TEST(SimulatedBoard, AClockThatGoesBackDoesNotMatter) {
    SimulatedWire wire("tablet");
    wire.wait(1s);
    attach(wire, 1);
    wire.board->take(Bytes{0xE2, 0x50, 0x0F}, 10ms); // 2000 us, from a time long gone
    EXPECT_EQ(wire.servo(0).pulse, 2000.0);
    EXPECT_EQ(wire.servo(0).position, 1500.0);
}

TEST(SimulatedBoard, LinkAndPanelMayUseItAtOnce) {
    const SimulatedBench bench; // the machine's clock, which two threads may read
    const auto board = bench.board("tablet");
    board->plugged(bench.now());
    std::thread panel([&board] {
        for (int i = 0; i < 2000; ++i) {
            board->setFaults({.noise = 0.01 * (i % 2)});
            if (i == 1000) board->reboot();
            EXPECT_EQ(board->servos().size(), 12U);
        }
    });
    for (int i = 0; i < 2000; ++i) {
        board->take(Bytes{0xF0, 0x6D, 0x02, 0xF7}, bench.now());
        (void)board->give(bench.now());
    }
    panel.join();
    EXPECT_EQ(board->servos().at(0).pulse, 0.0) << "only questions were asked";
}

} // namespace
} // namespace lumorph
