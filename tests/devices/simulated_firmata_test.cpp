#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "tests/devices/simulated_wire.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = SimulatedWire::Bytes;

Bytes textMessage(Bytes head, const std::string& text) {
    for (const char letter : text) {
        head.push_back(static_cast<std::uint8_t>(letter));
        head.push_back(0);
    }
    head.push_back(0xF7);
    return head;
}

const Bytes kVersion{0xF9, 0x02, 0x05};
const Bytes kTabletFirmware = textMessage({0xF0, 0x79, 0x01, 0x02}, "LumorphTablet");

Bytes operator+(Bytes first, const Bytes& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

TEST(SimulatedFirmata, SaysNothingUnaskedWhenItIsPluggedIn) {
    for (const char* name : {"tablet", "uno"}) {
        SimulatedWire wire(name);
        wire.wait(5s);
        EXPECT_EQ(wire.receive(), Bytes{}) << name;
    }
}

TEST(SimulatedFirmata, AnswersTheHandshake) {
    SimulatedWire tablet("tablet");
    EXPECT_EQ(tablet.ask({0xF9}), kVersion);
    EXPECT_EQ(tablet.ask({0xF0, 0x79, 0xF7}), kTabletFirmware);
    EXPECT_EQ(tablet.ask({0xF9, 0xF0, 0x79, 0xF7}), kVersion + kTabletFirmware) << "two questions in one message";
    EXPECT_EQ(tablet.ask({0xF0, 0x7C, 0xF7}), Bytes{}) << "2.5 never answers this one";

    SimulatedWire uno("uno");
    EXPECT_EQ(uno.ask({0xF9}), kVersion);
    EXPECT_EQ(uno.ask({0xF0, 0x79, 0xF7}), textMessage({0xF0, 0x79, 0x02, 0x05}, "StandardFirmata"));
    EXPECT_EQ(uno.ask({0xF0, 0x02, 0xF7}), Bytes{}) << "knows no voltage";
}

TEST(SimulatedFirmata, TabletTellsItsPins) {
    SimulatedWire wire("tablet");
    Bytes capabilities{0xF0, 0x6C, 0x7F, 0x7F};
    for (int pin = 2; pin <= 13; ++pin) capabilities = capabilities + Bytes{0x04, 0x0E, 0x7F};
    capabilities = capabilities + Bytes(6, 0x7F) + Bytes{0xF7};
    EXPECT_EQ(wire.ask({0xF0, 0x6B, 0xF7}), capabilities);
    EXPECT_EQ(wire.ask({0xF0, 0x69, 0xF7}), (Bytes{0xF0, 0x6A} + Bytes(20, 0x7F) + Bytes{0xF7}));
}

TEST(SimulatedFirmata, UnoTellsServosAmongWhatElseItsPinsCan) {
    SimulatedWire wire("uno");
    const Bytes answer = wire.ask({0xF0, 0x6B, 0xF7});
    ASSERT_GT(answer.size(), 3U);
    int pin = 0;
    int servos = 0;
    for (std::size_t i = 2; i + 1 < answer.size(); ++i) {
        if (answer[i] == 0x7F) {
            ++pin;
            continue;
        }
        if (answer[i] == 0x04) {
            EXPECT_EQ(answer[i + 1], 14);
            EXPECT_TRUE(pin >= 2 && pin <= 13) << pin;
            ++servos;
        }
        ++i;
    }
    EXPECT_EQ(pin, 20);
    EXPECT_EQ(servos, 12);
    EXPECT_EQ(wire.ask({0xF0, 0x69, 0xF7}), (Bytes{0xF0, 0x6A} + Bytes(14, 0x7F) + Bytes{0, 1, 2, 3, 4, 5, 0xF7}));
}

TEST(SimulatedFirmata, TabletTakesThePulseThatWasSetBeforeTheAttach) {
    SimulatedWire wire("tablet");
    wire.send({0xF0, 0x6F, 0x09, 0x5C, 0x0B, 0xF7}); // 1500 us on pin 9
    EXPECT_EQ(wire.servo(7).pulse, 0.0);
    wire.send({0xF4, 0x09, 0x04});
    EXPECT_EQ(wire.servo(7).pulse, 1500.0);
    EXPECT_EQ(wire.servo(7).largestJump, 0.0);
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x09, 0xF7}), (Bytes{0xF0, 0x6E, 0x09, 0x04, 0x5C, 0x0B, 0xF7}));
    wire.send({0xF4, 0x09, 0x01});
    EXPECT_EQ(wire.servo(7).pulse, 0.0);
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x09, 0xF7}), (Bytes{0xF0, 0x6E, 0x09, 0x01, 0x5C, 0x0B, 0xF7}));
}

TEST(SimulatedFirmata, TabletGivesNoPulseBeforeItKnowsOne) {
    SimulatedWire wire("tablet");
    wire.send({0xF4, 0x02, 0x04});
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    wire.send({0xE2, 0x68, 0x07}); // 1000 us
    EXPECT_EQ(wire.servo(0).pulse, 1000.0);
    EXPECT_EQ(wire.servo(0).largestJump, 500.0) << "its horn stood in the middle";
}

TEST(SimulatedFirmata, UnoIgnoresEarlyWritesAndJumpsToTheMiddle) {
    SimulatedWire wire("uno");
    wire.send({0xF4, 0x09, 0x04, 0xE9, 0x68, 0x07}); // away from the middle first: 1000 us
    wire.wait(1s);
    wire.send({0xF4, 0x09, 0x01});
    EXPECT_NEAR(wire.servo(7).position, 1000.0, 1e-9);
    wire.send({0xE9, 0x68, 0x07});
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x09, 0xF7}), (Bytes{0xF0, 0x6E, 0x09, 0x01, 0x00, 0xF7}));
    wire.send({0xF4, 0x09, 0x04});
    EXPECT_EQ(wire.servo(7).pulse, 1502.0);
    EXPECT_NEAR(wire.servo(7).largestJump, 502.0, 1e-9);
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x09, 0xF7}), (Bytes{0xF0, 0x6E, 0x09, 0x04, 0x00, 0xF7}));
}

TEST(SimulatedFirmata, ServoConfigurationAttachesAndLimits) {
    for (const char* name : {"tablet", "uno"}) {
        SimulatedWire wire(name);
        // 1000 to 2000 us on pin 3
        wire.send({0xF0, 0x70, 0x03, 0x68, 0x07, 0x50, 0x0F, 0xF7, 0xE3, 0x00, 0x12}); // 2304 us
        EXPECT_EQ(wire.servo(1).pulse, 2000.0) << name;
        wire.send({0xE3, 0x2D, 0x00}); // 45 degrees
        EXPECT_EQ(wire.servo(1).pulse, 1250.0) << name;
        wire.send({0xE3, 0x20, 0x04}); // 544: the least that is no angle
        EXPECT_EQ(wire.servo(1).pulse, 1000.0) << name;
        EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x03, 0xF7}), (Bytes{0xF0, 0x6E, 0x03, 0x04, 0x20, 0x04, 0xF7})) << name;
    }
}

TEST(SimulatedFirmata, ResetDetaches) {
    for (const char* name : {"tablet", "uno"}) {
        SimulatedWire wire(name);
        wire.send({0xF4, 0x04, 0x04, 0xE4, 0x68, 0x07});
        ASSERT_EQ(wire.servo(2).pulse, 1000.0) << name;
        EXPECT_EQ(wire.ask({0xFF}), Bytes{}) << name;
        EXPECT_EQ(wire.servo(2).pulse, 0.0) << name;
        EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x04, 0xF7}), (Bytes{0xF0, 0x6E, 0x04, 0x01, 0x00, 0xF7})) << name;
        wire.send({0xF4, 0x04, 0x04});
        EXPECT_EQ(wire.servo(2).pulse, name == std::string("uno") ? 1502.0 : 0.0) << "the pulse is forgotten";
    }
}

TEST(SimulatedFirmata, SaysWhatItCannotDo) {
    SimulatedWire wire("uno");
    EXPECT_EQ(wire.ask({0xF4, 0x09, 0x55}), textMessage({0xF0, 0x71}, "Unknown pin mode"));
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x40, 0xF7}), (Bytes{0xF0, 0x6E, 0x40, 0xF7})) << "no such pin";
}

TEST(SimulatedFirmata, TabletTellsItsVoltage) {
    SimulatedWire wire("tablet");
    wire.fault([](BoardFaults& faults) { faults.volts = 6.123; });
    EXPECT_EQ(wire.ask({0xF0, 0x02, 0xF7}), (Bytes{0xF0, 0x02, 6123 & 0x7F, 6123 >> 7, 0x00, 0xF7}));
}

TEST(SimulatedFirmata, MessagesMayComeInAnyCutAndWithRubbishBetween) {
    for (const char* name : {"tablet", "uno"}) {
        SimulatedWire wire(name);
        Bytes answer;
        for (const std::uint8_t byte : Bytes{0x13, 0x55, 0xF4, 0x09, 0xF4, 0x09, 0x04, 0x22, 0xE9, 0x68, 0xE9, 0x68,
                                             0x07, 0xC0, 0x01, 0xF0, 0xF7, 0xF0, 0x6D, 0xF7, 0xF0, 0x6D, 0x09, 0xF7})
            answer = answer + wire.ask({byte});
        EXPECT_EQ(answer, (Bytes{0xF0, 0x6E, 0x09, 0x04, 0x68, 0x07, 0xF7})) << name;
        EXPECT_EQ(wire.servo(7).pulse, 1000.0) << name;
    }
}

TEST(SimulatedFirmata, OnlyTheTabletFindsOutOfAMessageWithoutItsEnd) {
    for (const auto& [name, pulse] : {std::pair{"tablet", 0.0}, std::pair{"uno", 1502.0}}) {
        SimulatedWire wire(name);
        wire.send({0xF4, 0x02, 0x04, 0xF0, 0x6F, 0x09, 0x5C}); // its end was lost
        wire.send({0xF4, 0x02, 0x01});                         // STOP
        EXPECT_EQ(wire.servo(0).pulse, pulse) << name;
        wire.send(Bytes(1000, 0x11) + Bytes{0xF7});
        wire.send({0xF4, 0x02, 0x01});
        EXPECT_EQ(wire.servo(0).pulse, 0.0) << name;
    }
}

TEST(SimulatedFirmata, TabletDetachesAfterHalfASecondOfSilence) {
    SimulatedWire wire("tablet");
    wire.send({0xE2, 0x5C, 0x0B, 0xF4, 0x02, 0x04});
    wire.wait(499'999us);
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
    wire.wait(1us);
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    EXPECT_EQ(wire.receive(), Bytes{});
    EXPECT_EQ(wire.ask({0xF0, 0x6D, 0x02, 0xF7}), (Bytes{0xF0, 0x6E, 0x02, 0x01, 0x5C, 0x0B, 0xF7}));
    wire.send({0xE2, 0x68, 0x07});
    EXPECT_EQ(wire.servo(0).pulse, 0.0) << "a write does not attach it again";
}

TEST(SimulatedFirmata, AnyQuestionKeepsTheTabletsServosUp) {
    SimulatedWire wire("tablet");
    wire.send({0xE2, 0x5C, 0x0B, 0xF4, 0x02, 0x04});
    for (int i = 0; i < 10; ++i) {
        wire.wait(400ms);
        wire.send({0xF0, 0x6D, 0x02, 0xF7});
    }
    EXPECT_EQ(wire.servo(0).pulse, 1500.0);
}

TEST(SimulatedFirmata, UnoHoldsForEver) {
    SimulatedWire wire("uno");
    wire.send({0xF4, 0x02, 0x04});
    wire.wait(1h);
    EXPECT_EQ(wire.servo(0).pulse, 1502.0);
}

TEST(SimulatedFirmata, RebootLosesAllAndSaysSoAfterTheBootloader) {
    SimulatedWire wire("tablet");
    wire.send({0xE2, 0x68, 0x07, 0xF4, 0x02, 0x04});
    wire.wait(100ms);
    const double where = wire.servo(0).position;
    wire.board->reboot();
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    wire.send({0xF9, 0xE2, 0x5C, 0x0B, 0xF4, 0x02, 0x04}); // nobody is there to hear it
    wire.wait(2'499'999us);
    EXPECT_EQ(wire.receive(), Bytes{});
    EXPECT_EQ(wire.servo(0).pulse, 0.0);
    wire.wait(1us);
    EXPECT_EQ(wire.receive(), kVersion + kTabletFirmware);
    EXPECT_EQ(wire.servo(0).position, where) << "a limp servo stays";
    wire.send({0xF4, 0x02, 0x04});
    EXPECT_EQ(wire.servo(0).pulse, 0.0) << "the pulse of before is forgotten";
}

} // namespace
} // namespace lumorph
