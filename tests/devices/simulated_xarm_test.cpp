#include <chrono>

#include <gtest/gtest.h>

#include "tests/devices/simulated_wire.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = SimulatedWire::Bytes;

/// As it comes over HID.
Bytes hidReport(Bytes message) {
    message.resize(64);
    return message;
}

TEST(SimulatedXarm, IsAHidDeviceThatSaysWhatItIs) {
    SimulatedWire wire("xarm");
    EXPECT_TRUE(wire.board->isHid());
    EXPECT_EQ(wire.board->product(), "LOBOT xArm");
}

TEST(SimulatedXarm, TakesTheVendorsVectors) {
    SimulatedWire wire("xarm");
    // Servo 1 to 2000 in 1000 ms: a bus servo ends at 1000, which is 2500 us.
    wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0xE8, 0x03, 0x01, 0xD0, 0x07}));
    wire.wait(500ms);
    EXPECT_NEAR(wire.servo(0).pulse, 2000.0, 1e-9);
    EXPECT_NEAR(wire.servo(0).position, 2000.0, 20.0) << "it follows";
    wire.wait(500ms);
    EXPECT_EQ(wire.servo(0).pulse, 2500.0);
    // Servo 2 to 1200 and servo 9, which is not there, to 2300 in 800 ms.
    wire.send(hidReport({0x55, 0x55, 0x0B, 0x03, 0x02, 0x20, 0x03, 0x02, 0xB0, 0x04, 0x09, 0xFC, 0x08}));
    wire.wait(799ms);
    EXPECT_LT(wire.servo(1).pulse, 2500.0);
    wire.wait(1ms);
    EXPECT_EQ(wire.servo(1).pulse, 2500.0);
    EXPECT_EQ(wire.receive(), Bytes{}) << "moves have no reply";
}

TEST(SimulatedXarm, MovesAtTheSpeedItWasTold) {
    SimulatedWire wire("xarm");
    wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0xE8, 0x03, 0x01, 0xE8, 0x03})); // 1500 to 2500 us in a second
    for (int i = 0; i < 200; ++i) { // other messages on the way change nothing
        wire.wait(5ms);
        (void)wire.ask(hidReport({0x55, 0x55, 0x02, 0x0F}));
    }
    EXPECT_NEAR(wire.servo(0).fastest, 1000.0, 1e-6);
    EXPECT_EQ(wire.servo(0).largestJump, 0.0);
    EXPECT_EQ(wire.servo(0).pulse, 2500.0);
}

TEST(SimulatedXarm, AServoThatIsHeldStaysAndIsReadThere) {
    SimulatedWire wire("xarm");
    wire.fault([](BoardFaults& faults) { faults.held = 0; });
    const Bytes both = hidReport({0x55, 0x55, 0x0B, 0x03, 0x02, 0xE8, 0x03, 0x01, 0xE8, 0x03, 0x02, 0xE8, 0x03});
    wire.send(both);
    wire.wait(2s);
    EXPECT_EQ(wire.servo(0).pulse, 2500.0) << "it is told all the same";
    EXPECT_EQ(wire.servo(0).position, 1500.0);
    EXPECT_EQ(wire.servo(1).position, 2500.0);
    // 500 of 1000, and 1000.
    EXPECT_EQ(wire.ask(hidReport({0x55, 0x55, 0x05, 0x15, 0x02, 0x01, 0x02})),
              hidReport({0x55, 0x55, 0x09, 0x15, 0x02, 0x01, 0xF4, 0x01, 0x02, 0xE8, 0x03}));
    wire.fault([](BoardFaults& faults) { faults.held.reset(); });
    wire.wait(2s);
    EXPECT_EQ(wire.servo(0).position, 2500.0);
}

TEST(SimulatedXarm, ItsUsbIsAwayWhileItStartsAnew) {
    SimulatedWire wire("xarm");
    EXPECT_TRUE(wire.board->present());
    wire.board->reboot();
    EXPECT_FALSE(wire.board->present());
    wire.wait(1s);
    EXPECT_TRUE(wire.board->present());
    SimulatedWire behindAnAdapter("tablet");
    behindAnAdapter.board->reboot();
    EXPECT_TRUE(behindAnAdapter.board->present());
}

TEST(SimulatedXarm, ANamelessOneCallsItselfAsAnyAdapterDoes) {
    SimulatedWire wire("xarm");
    wire.fault([](BoardFaults& faults) { faults.nameless = true; });
    EXPECT_EQ(wire.board->product(), "USB Serial");
}

TEST(SimulatedXarm, AMoveWithoutTimeIsAJump) {
    SimulatedWire wire("xarm");
    wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0x01, 0x64, 0x00})); // 100: 700 us
    EXPECT_EQ(wire.servo(0).pulse, 700.0);
    EXPECT_EQ(wire.servo(0).largestJump, 800.0);
}

TEST(SimulatedXarm, ReadsWhereTheHornsAre) {
    SimulatedWire wire("xarm");
    wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00})); // servo 2 towards 500 us
    wire.wait(170ms); // 60 degrees: a quarter of its 240, so 500 us
    EXPECT_EQ(wire.ask(hidReport({0x55, 0x55, 0x05, 0x15, 0x02, 0x02, 0x06})),
              hidReport({0x55, 0x55, 0x09, 0x15, 0x02, 0x02, 0xFA, 0x00, 0x06, 0xF4, 0x01}))
        << "250 for the one that moves, 500 for the other";
}

TEST(SimulatedXarm, TellsItsVoltageInReportsOfItsOwn) {
    SimulatedWire wire("xarm");
    wire.fault([](BoardFaults& faults) { faults.volts = 7.5; }); // 7500 = 1D4C
    wire.send(hidReport({0x55, 0x55, 0x02, 0x0F}));
    Bytes withNumber = hidReport({0x55, 0x55, 0x04, 0x15, 0x01, 0x01});
    withNumber.insert(withNumber.begin(), 0x00);
    wire.send(withNumber);
    EXPECT_EQ(wire.receive(), hidReport({0x55, 0x55, 0x04, 0x0F, 0x4C, 0x1D}));
    EXPECT_EQ(wire.receive(), hidReport({0x55, 0x55, 0x06, 0x15, 0x01, 0x01, 0xF4, 0x01}));
    EXPECT_EQ(wire.receive(), Bytes{});
}

TEST(SimulatedXarm, EveryFifthUnloadFailsSilently) {
    SimulatedWire wire("xarm");
    for (int i = 1; i <= 10; ++i) {
        wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0x03, 0xF4, 0x01}));
        EXPECT_EQ(wire.ask(hidReport({0x55, 0x55, 0x04, 0x14, 0x01, 0x03})), Bytes{});
        EXPECT_EQ(wire.servo(2).pulse, i % 5 == 0 ? 1500.0 : 0.0) << i;
    }
}

TEST(SimulatedXarm, IgnoresAFrameThatLacksItsEnd) {
    SimulatedWire wire("xarm");
    wire.send(hidReport({0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0x03, 0xF4, 0x01}));
    wire.send({0x55, 0x55, 0x05, 0x14, 0x02, 0x03});
    EXPECT_EQ(wire.servo(2).pulse, 1500.0);
}

TEST(SimulatedXarm, IgnoresWhatIsNoFrame) {
    SimulatedWire wire("xarm");
    const Bytes broken[] = {
        {},
        {0x55},
        {0x55, 0x55, 0x02},
        {0x55, 0x54, 0x02, 0x0F},
        {0x55, 0x55, 0x00, 0x0F},
        {0x55, 0x55, 0xFF, 0x15, 0x03, 0x01, 0x02, 0x03},             // longer than the report
        {0x55, 0x55, 0x04, 0x15, 0x02, 0x01},                         // two are told, one is there
        {0x55, 0x55, 0x08, 0x03, 0x02, 0x00, 0x00, 0x01, 0x00, 0x00}, // likewise
        {0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00}, // no servo 0
        {0x55, 0x55, 0x08, 0x03, 0x01, 0x00, 0x00, 0xFF, 0x00, 0x00}, // nor 255
    };
    for (const Bytes& message : broken) {
        EXPECT_EQ(wire.ask(message), Bytes{});
        EXPECT_EQ(wire.ask(hidReport(message)), Bytes{});
    }
    for (const SimulatedServo& servo : wire.board->servos()) EXPECT_EQ(servo.pulse, 0.0);
}

} // namespace
} // namespace lumorph
