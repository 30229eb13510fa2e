#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/devices/simulated_wire.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = SimulatedWire::Bytes;

/// The remainder of a long division, least significant bit first, done on a row of bits: another way than the board's.
std::uint8_t divided(const Bytes& message) {
    std::vector<int> bits;
    for (const std::uint8_t byte : message)
        for (int i = 0; i < 8; ++i) bits.push_back(byte >> i & 1);
    const std::size_t length = bits.size();
    bits.resize(length + 7);
    for (std::size_t i = 0; i < length; ++i) {
        if (bits[i] == 0) continue;
        for (int j = 0; j < 8; ++j) bits[i + static_cast<std::size_t>(j)] ^= 0x91 >> j & 1;
    }
    int rest = 0;
    for (int i = 0; i < 7; ++i) rest |= bits[length + static_cast<std::size_t>(i)] << i;
    return static_cast<std::uint8_t>(rest);
}

Bytes checked(Bytes message) {
    message.push_back(divided(message));
    return message;
}

const Bytes kErrors{0xA1};
const Bytes kNoError{0x00, 0x00};
const Bytes kChecksumError{0x08, 0x00};
const Bytes kProtocolError{0x10, 0x00};

TEST(SimulatedMaestro, TheTestsChecksumIsTheDocuments) { EXPECT_EQ(divided({0x83, 0x01}), 0x17); }

TEST(SimulatedMaestro, TakesTargetsInEveryForm) {
    SimulatedWire wire("maestro");
    wire.send({0xAA, 0x0C, 0x04, 0x00, 0x70, 0x2E}); // device 12, channel 0, 1500 us
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
    wire.send({0x84, 0x0B, 0x70, 0x2E});
    EXPECT_EQ(wire.servo(11).pulse, 1500.0);
    wire.send(checked({0x84, 0x01, 0x71, 0x2E}));
    EXPECT_EQ(wire.servo(1).pulse, 1500.25);
    wire.send(checked({0xAA, 0x0C, 0x04, 0x02, 0x70, 0x2E}));
    EXPECT_EQ(wire.servo(2).pulse, 1500.0);
    wire.send({0x84, 0x02, 0x00, 0x00});
    EXPECT_EQ(wire.servo(2).pulse, 0.0) << "0 is off";
    EXPECT_EQ(wire.ask(kErrors), kNoError);
}

TEST(SimulatedMaestro, LeavesTheOrdersOfOthersAlone) {
    SimulatedWire wire("maestro");
    wire.send({0xAA, 0x0D, 0x04, 0x00, 0x70, 0x2E});
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    EXPECT_EQ(wire.ask({0xAA, 0x0C, 0x21}), kNoError);
}

TEST(SimulatedMaestro, AnswersQuestions) {
    SimulatedWire wire("maestro");
    EXPECT_EQ(wire.ask({0x90, 0x03}), (Bytes{0x00, 0x00}));
    wire.send({0x84, 0x03, 0x70, 0x2E});
    EXPECT_EQ(wire.ask({0x90, 0x03}), (Bytes{0x70, 0x17})); // 6000
    EXPECT_EQ(wire.ask({0x93}), Bytes{0x00});
    EXPECT_EQ(wire.ask({0xAA, 0x0C, 0x10, 0x03}), (Bytes{0x70, 0x17}));
    EXPECT_EQ(wire.ask({0xA2}), Bytes{});
    EXPECT_EQ(wire.servo(3).pulse, 0.0);
    EXPECT_EQ(wire.ask({0x90, 0x03}), (Bytes{0x00, 0x00}));
}

TEST(SimulatedMaestro, TellsAnErrorOnce) {
    SimulatedWire wire("maestro");
    wire.send({0x84, 0x00, 0x70, 0x2E, static_cast<std::uint8_t>(divided({0x84, 0x00, 0x70, 0x2E}) ^ 0x01)});
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    EXPECT_EQ(wire.ask(kErrors), kChecksumError);
    EXPECT_EQ(wire.ask(kErrors), kNoError);
    for (const Bytes& wrong :
         {Bytes{0xC5}, Bytes{0x84, 0x0C, 0x70, 0x2E}, Bytes{0x84, 0x00}, Bytes{0xA2, 0x7F, 0x01}}) {
        wire.send(wrong);
        EXPECT_NE(wire.ask(kErrors), kNoError);
    }
    wire.send({0x84, 0x0C, 0x70, 0x2E});
    EXPECT_EQ(wire.ask(kErrors), kProtocolError);
}

TEST(SimulatedMaestro, MessagesMayComeInAnyCut) {
    SimulatedWire wire("maestro");
    for (const std::uint8_t byte : checked({0xAA, 0x0C, 0x04, 0x05, 0x70, 0x2E})) wire.send({byte});
    EXPECT_EQ(wire.servo(5).pulse, 1500.0);
    EXPECT_EQ(wire.ask(kErrors), kNoError);
}

TEST(SimulatedMaestro, KeepsToASpeed) {
    SimulatedWire wire("maestro");
    wire.send({0x84, 0x00, 0x70, 0x2E, 0x87, 0x00, 0x28, 0x00}); // 40: 10 us in 10 ms
    wire.send({0x84, 0x00, 0x40, 0x3E});                         // 2000 us
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
    EXPECT_EQ(wire.ask({0x93}), Bytes{0x01});
    wire.wait(250ms);
    EXPECT_EQ(wire.servo(0).pulse, 1750.0);
    EXPECT_EQ(wire.ask({0x90, 0x00}), (Bytes{0x58, 0x1B})); // 7000
    wire.wait(249ms);
    EXPECT_EQ(wire.ask({0x93}), Bytes{0x01});
    wire.wait(1ms);
    EXPECT_EQ(wire.servo(0).pulse, 2000.0);
    EXPECT_EQ(wire.ask({0x93}), Bytes{0x00});
    EXPECT_NEAR(wire.servo(0).fastest, 1000.0, 1e-6);
}

TEST(SimulatedMaestro, KeepsToAnAcceleration) {
    SimulatedWire wire("maestro");
    wire.send({0x84, 0x00, 0x70, 0x2E, 0x89, 0x00, 0x08, 0x00}); // 8: 0.25 us in 10 ms faster each 10 ms, 2500 us/s/s
    wire.send({0x84, 0x00, 0x40, 0x3E});
    double before = 1500.0;
    double speed = 0.0;
    int steps = 0;
    for (; wire.ask({0x93}) == Bytes{0x01}; ++steps) {
        ASSERT_LT(steps, 200);
        wire.wait(10ms);
        const double pulse = wire.servo(0).pulse;
        EXPECT_LE(std::abs(pulse - before - speed), 1.125 * 0.25 + 1e-9) << steps; // the last step is what is left
        EXPECT_LE(pulse, 2000.0);
        speed = pulse - before;
        before = pulse;
    }
    EXPECT_EQ(wire.servo(0).pulse, 2000.0);
    EXPECT_NEAR(0.01 * steps, 2.0 * std::sqrt(500.0 / 2500.0), 0.05) << "half the way faster, half of it slower";
}

} // namespace
} // namespace lumorph
