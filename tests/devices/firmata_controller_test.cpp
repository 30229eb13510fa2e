#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/controller_harness.h"

namespace lumorph {
namespace {

using test::Bytes;
using test::ControllerTrial;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Messages = std::vector<Bytes>;

const Bytes kVersion = {0xF9, 0x02, 0x05};
const Bytes kStateQuestion = {0xF0, 0x6D};
const Bytes kVoltageQuestion = {0xF0, 0x02};
const Messages kQuestions = {kStateQuestion, kVoltageQuestion};

Bytes firmwareNamed(const std::string& name) {
    Bytes bytes = {0xF0, 0x79, 0x01, 0x00};
    for (const char letter : name) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(letter), 0x00});
    bytes.push_back(0xF7);
    return bytes;
}

/// Pins 0 and 1 are the serial port's, all others drive servos.
Bytes capabilities(int pins = 20) {
    Bytes bytes = {0xF0, 0x6C, 0x7F, 0x7F};
    for (int pin = 2; pin < pins; ++pin) bytes.insert(bytes.end(), {0x00, 0x01, 0x01, 0x01, 0x04, 0x0E, 0x7F});
    bytes.push_back(0xF7);
    return bytes;
}

Bytes stateOf(std::uint8_t pin, std::uint8_t mode) { return {0xF0, 0x6E, pin, mode, 0x5C, 0x0B, 0xF7}; }
Bytes voltage(int millivolts) {
    return {0xF0,
            0x02,
            static_cast<std::uint8_t>(millivolts & 0x7F),
            static_cast<std::uint8_t>(millivolts >> 7 & 0x7F),
            static_cast<std::uint8_t>(millivolts >> 14 & 0x7F),
            0xF7};
}

void shakeHands(ControllerTrial& trial, const std::string& firmware = "LumorphTablet") {
    trial.hear(kVersion);
    trial.hear(firmwareNamed(firmware));
    trial.hear(capabilities());
}

ControllerTrial readyTrial(const std::vector<int>& channels, const std::string& firmware = "LumorphTablet",
                           const std::string& uri = "serial:///dev/ttyUSB0") {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, channels), uri);
    trial.open();
    shakeHands(trial, firmware);
    (void)trial.written();
    return trial;
}

TEST(FirmataController, AsksWhoIsThereAndWhatItCan) {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0");
    trial.open();
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.wait(500); // the boot loader swallows what came first
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.hear(kVersion);
    trial.wait(500);
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF0, 0x79, 0xF7}));
    trial.hear(firmwareNamed("LumorphTablet.ino"));
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF0, 0x6B, 0xF7}));
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    trial.hear(capabilities());
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_EQ(trial.state().firmware, "LumorphTablet 1.0");
    EXPECT_TRUE(trial.state().traits.failsafe);
    EXPECT_FALSE(trial.state().traits.jumpsOnAttach);
    EXPECT_THAT(trial.state().traits.failsafeWord, HasSubstr("half a second"));
    EXPECT_EQ(trial.state().reboots, 0U);
    EXPECT_FALSE(trial.state().trouble);
}

TEST(FirmataController, KnowsFirmwaresAndAsksTheUserAboutOthers) {
    struct Row {
        const char* name;
        ControllerPhase phase;
        bool jumps;
    };
    for (const Row& row :
         {Row{"LumorphTablet", ControllerPhase::ready, false}, Row{"StandardFirmata.ino", ControllerPhase::ready, true},
          Row{"StandardFirmata", ControllerPhase::ready, true},
          Row{"ConfigurableFirmata.ino", ControllerPhase::ready, true},
          Row{"ServoFirmata.ino", ControllerPhase::ready, true},
          Row{"NotLumorphTablet", ControllerPhase::unidentified, true},
          Row{"Blink.ino", ControllerPhase::unidentified, true}, Row{"", ControllerPhase::unidentified, true}}) {
        ControllerTrial trial = readyTrial({9}, row.name);
        EXPECT_EQ(trial.state().phase, row.phase) << row.name;
        EXPECT_EQ(trial.state().traits.jumpsOnAttach, row.jumps) << row.name;
        EXPECT_EQ(trial.state().traits.failsafe, !row.jumps) << row.name;
        trial.send({{9, 1500.0, true}});
        EXPECT_EQ(trial.writtenBut(kQuestions).empty(), row.phase != ControllerPhase::ready) << row.name;
        trial.controller().confirm();
        trial.wait(100);
        EXPECT_EQ(trial.state().phase, ControllerPhase::ready) << row.name;
    }
}

TEST(FirmataController, RefusesBoardsThatCannotDriveTheServos) {
    for (const int channel : {1, 25}) {
        ControllerTrial trial = readyTrial({9, channel});
        EXPECT_EQ(trial.state().phase, ControllerPhase::refused);
        ASSERT_TRUE(trial.state().trouble);
        EXPECT_THAT(trial.state().trouble->why, HasSubstr("pin " + std::to_string(channel)));
        trial.controller().confirm();
        EXPECT_EQ(trial.state().phase, ControllerPhase::refused);
    }
    ControllerTrial old(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0");
    old.open();
    old.hear({0xF9, 0x01, 0x04});
    EXPECT_EQ(old.state().phase, ControllerPhase::refused);
    EXPECT_THAT(old.state().trouble->why, HasSubstr("1.4"));
}

TEST(FirmataController, OurFirmwareHasThePulseBeforeItIsEnabled) {
    ControllerTrial trial = readyTrial({9, 16});
    trial.send({{9, 1500.0, true}, {16, 1200.0, true}});
    const Bytes pulse = {0xE9, 0x5C, 0x0B};
    // Limits 1000 = 7 x 128 + 104 and 2000 = 15 x 128 + 80.
    const Bytes limits = {0xF0, 0x70, 0x09, 0x68, 0x07, 0x50, 0x0F, 0xF7};
    const Bytes far = {0xF0, 0x6F, 0x10, 0x30, 0x09, 0xF7};
    const Bytes farLimits = {0xF0, 0x70, 0x10, 0x68, 0x07, 0x50, 0x0F, 0xF7};
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(pulse, limits, Bytes{0xF4, 0x09, 0x04}, pulse, far, farLimits,
                                                          Bytes{0xF4, 0x10, 0x04}, far));
}

TEST(FirmataController, StockFirmwareHasThePulseRightBehindTheAttach) {
    ControllerTrial trial = readyTrial({9}, "StandardFirmata");
    trial.send({{9, 1500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xF4, 0x09, 0x04}, Bytes{0xE9, 0x5C, 0x0B}));
}

TEST(FirmataController, SendsOnlyChangesAndTheLatestWhenTheLinkHasRoom) {
    ControllerTrial trial = readyTrial({9, 10});
    trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
    (void)trial.written();
    trial.wait(20);
    (void)trial.written();
    trial.send({{9, 1500.2, true}, {10, 1500.0, true}}); // the same microsecond
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
    trial.send({{9, 1500.0, true}, {10, 1501.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xEA, 0x5D, 0x0B}));
    for (int pulse = 1502; pulse <= 1600; ++pulse) // a flood
        trial.send({{9, 1500.0, true}, {10, static_cast<double>(pulse), true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
    trial.wait(15);
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty()) << "50 a second at most";
    trial.wait(5);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xEA, 0x40, 0x0C})); // 1600
    trial.wait(100);
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
}

TEST(FirmataController, TheLinksBaudRateCapsTheRate) {
    struct Row {
        const char* uri;
        double least, most;
    };
    for (const Row& row :
         {Row{"serial:///dev/rfcomm0?baud=9600", 23.0, 26.0}, Row{"bt://98:D3:31:F4:12:AB", 23.0, 26.0},
          Row{"serial:///dev/ttyUSB0?baud=57600", 45.0, 50.0}}) {
        const std::vector<int> channels = {4, 5, 6, 7, 8, 9};
        ControllerTrial trial = readyTrial(channels, "LumorphTablet", row.uri);
        int count = 0;
        for (int step = 0; step < 2000; ++step) { // 10 s
            std::vector<GuardedPulse> pulses;
            for (const int channel : channels) pulses.push_back({channel, 1000.0 + step % 1000, true});
            trial.send(pulses);
            trial.wait(5);
            for (const Bytes& message : trial.written()) count += message[0] == 0xE4;
        }
        EXPECT_GE(count, 10 * row.least) << row.uri;
        EXPECT_LE(count, 10 * row.most + 2) << row.uri;
    }
}

TEST(FirmataController, DetachesAtOnceBeforeAllElseAndSaysItThrice) {
    ControllerTrial trial = readyTrial({9, 10});
    trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
    (void)trial.written();
    trial.send({{9, 1600.0, true}, {10, 1600.0, true}}); // waits for its slot
    trial.send({{9, 1600.0, false}, {10, 1700.0, true}});
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF4, 0x09, 0x01}));
    trial.wait(20);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xEA, 0x24, 0x0D})); // 1700; 9 is not written any more
    trial.wait(500);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xF4, 0x09, 0x01}, Bytes{0xF4, 0x09, 0x01}));
    trial.send({{9, 1600.0, true}, {10, 1700.0, true}});
    trial.send({{9, 1600.0, false}, {10, 1700.0, false}});
    trial.send({{9, 1600.0, true}, {10, 1700.0, false}});
    const Messages messages = trial.writtenBut(kQuestions);
    ASSERT_GE(messages.size(), 1U);
    EXPECT_EQ(messages[0], (Bytes{0xF4, 0x0A, 0x01}));
}

TEST(FirmataController, DetachesInEveryPhase) {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0");
    trial.open();
    trial.send({{9, 1500.0, true}});
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.send({{9, 1500.0, false}});
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF4, 0x09, 0x01}));
    shakeHands(trial, "Blink");
    (void)trial.written();
    trial.wait(400);
    trial.send({{9, 1500.0, true}});
    trial.send({{9, 1500.0, false}});
    EXPECT_THAT(trial.state().phase, ControllerPhase::unidentified);
    for (const Bytes& message : trial.writtenBut(kQuestions)) EXPECT_EQ(message, (Bytes{0xF4, 0x09, 0x01}));
}

TEST(FirmataController, ValuesStayWithinTheLimitsWhenTheyAreRounded) {
    struct Row {
        double pulseMin, pulseMax, pulse;
        int sent;
    };
    for (const Row& row :
         {Row{1000.0, 1000.4, 1000.4, 1000}, Row{999.6, 1000.4, 999.6, 1000}, Row{1000.6, 1500.0, 1000.6, 1001},
          Row{1000.0, 1999.7, 1999.7, 1999}, Row{500.0, 2000.0, 500.0, 544}, // less would be degrees
          Row{1000.0, 2000.0, 2100.0, 2000}}) {
        DeviceProfile profile = test::profileOn(ControllerKind::firmata, {9});
        profile.servos[0].pulseMin = row.pulseMin;
        profile.servos[0].pulseMax = row.pulseMax;
        ControllerTrial trial(profile, "serial:///dev/ttyUSB0");
        trial.open();
        shakeHands(trial, "StandardFirmata");
        (void)trial.written();
        trial.send({{9, row.pulse, true}});
        const Messages messages = trial.writtenBut(kQuestions);
        ASSERT_EQ(messages.size(), 2U);
        EXPECT_EQ(messages[1][1] | messages[1][2] << 7, row.sent) << row.pulse;
    }
    DeviceProfile none = test::profileOn(ControllerKind::firmata, {9});
    none.servos[0].pulseMin = 1000.2;
    none.servos[0].pulseMax = 1000.8;
    EXPECT_THROW((void)makeController(none, parseDeviceAddress("sim://tablet")), InvalidInput);
}

TEST(FirmataController, IgnoresPulsesThatAreNone) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, std::numeric_limits<double>::quiet_NaN(), true}, {13, 1500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
}

TEST(FirmataController, ARebootIsNoticedAndThePoseIsNotSentAgain) {
    for (const bool firmwareFirst : {false, true}) {
        ControllerTrial trial = readyTrial({9, 10});
        trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
        trial.send({{9, 1550.0, true}, {10, 1500.0, true}}); // waits
        (void)trial.written();
        trial.hear(firmwareFirst ? firmwareNamed("LumorphTablet") : kVersion);
        EXPECT_EQ(trial.state().reboots, 1U);
        EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
        trial.hear(firmwareFirst ? kVersion : firmwareNamed("LumorphTablet"));
        EXPECT_EQ(trial.state().reboots, 1U) << "both are of one start";
        trial.wait(50);
        trial.hear(capabilities());
        EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
        (void)trial.written();
        trial.send({{9, 1560.0, true}, {10, 1500.0, true}});
        trial.wait(1000);
        EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
        trial.send({{9, 1560.0, false}, {10, 1500.0, false}}); // let go, and started anew
        trial.send({{9, 1560.0, true}, {10, 1500.0, false}});
        const Messages messages = trial.writtenBut(kQuestions);
        ASSERT_EQ(messages.size(), 6U);
        EXPECT_EQ(messages[4], (Bytes{0xF4, 0x09, 0x04}));
    }
}

TEST(FirmataController, BeatsEvery200MillisecondsWhenNothingElseIsSent) {
    ControllerTrial trial = readyTrial({9, 10});
    trial.wait(5000);
    int voltages = 0;
    int states = 0;
    for (const Bytes& message : trial.written()) {
        voltages += message == Bytes{0xF0, 0x02, 0xF7};
        states += message == Bytes{0xF0, 0x6D, 0x09, 0xF7};
    }
    EXPECT_GE(states, 20);
    EXPECT_LE(states, 26);
    EXPECT_GE(voltages, 2);
}

TEST(FirmataController, NeverLetsOurWatchdogWait) {
    ControllerTrial trial = readyTrial({9});
    Microseconds last = trial.now();
    for (int step = 0; step < 2000; ++step) {
        if (step % 40 < 20) trial.send({{9, 1000.0 + step % 500, true}});
        trial.wait(5);
        if (!trial.written().empty()) last = trial.now();
        ASSERT_LE((trial.now() - last).count(), 250'000);
    }
}

TEST(FirmataController, SilenceNamesTheBaudRateAndOffersOthers) {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0?baud=38400");
    trial.open();
    trial.wait(950);
    EXPECT_TRUE(trial.state().answering);
    EXPECT_FALSE(trial.state().trouble);
    trial.wait(100);
    EXPECT_FALSE(trial.state().answering);
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("38400 baud"));
    for (const char* rate : {"57600", "115200", "9600"}) EXPECT_THAT(trial.state().trouble->remedy, HasSubstr(rate));
    trial.hear({0x12, 0x34, 0x9F});
    trial.wait(5);
    EXPECT_FALSE(trial.state().answering) << "noise is no answer";
    EXPECT_GT(trial.state().errors, 0U);
    trial.hear(kVersion);
    EXPECT_TRUE(trial.state().answering);
    EXPECT_FALSE(trial.state().trouble);
}

TEST(FirmataController, FallingSilentIsTold) {
    ControllerTrial trial = readyTrial({9});
    trial.wait(600);
    trial.hear(stateOf(9, 1));
    trial.wait(900);
    EXPECT_TRUE(trial.state().answering);
    trial.wait(200);
    EXPECT_FALSE(trial.state().answering);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("silent"));
}

TEST(FirmataController, TellsTheBatteryAndWarnsWhenItIsEmpty) {
    ControllerTrial trial = readyTrial({9});
    EXPECT_FALSE(trial.state().volts);
    trial.hear(voltage(7412));
    EXPECT_NEAR(trial.state().volts.value_or(0), 7.412, 1e-9);
    EXPECT_FALSE(trial.state().trouble);
    trial.hear(voltage(5600));
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_EQ(trial.state().trouble->why, "battery at 5.6 V");
    EXPECT_THAT(trial.state().trouble->remedy, HasSubstr("charge it"));
    trial.hear(voltage(6500));
    EXPECT_FALSE(trial.state().trouble);
    trial.hear(voltage(200'000));
    EXPECT_NEAR(trial.state().volts.value_or(0), 6.5, 1e-9) << "no battery has 200 V";
    trial.hear(voltage(0));
    EXPECT_FALSE(trial.state().volts) << "nothing is wired to it";
}

TEST(FirmataController, AWatchdogThatLetGoIsNoticed) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.wait(1000);
    trial.hear(stateOf(9, 4));
    trial.wait(400);
    trial.hear(stateOf(9, 4));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    trial.wait(400);
    trial.hear(stateOf(9, 1));
    trial.wait(400);
    trial.hear(stateOf(9, 1));
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    EXPECT_EQ(trial.state().reboots, 1U);
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("let go"));
}

TEST(FirmataController, AnAnswerOfBeforeTheAttachMeansNothing) {
    ControllerTrial trial = readyTrial({9});
    trial.wait(5);
    for (int i = 0; i < 2; ++i) trial.wait(200);
    trial.send({{9, 1500.0, true}});
    for (int i = 0; i < 2; ++i) trial.hear(stateOf(9, 1));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
}

TEST(FirmataController, ADetachThatWasLostIsSaidAgain) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.send({{9, 1500.0, false}});
    trial.wait(1000);
    (void)trial.written();
    for (int i = 0; i < 8; ++i) trial.hear(stateOf(9, 4));
    trial.wait(5);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xF4, 0x09, 0x01}));
}

TEST(FirmataController, WhatTheBoardSaysIsTold) {
    ControllerTrial trial = readyTrial({9});
    Bytes text = {0xF0, 0x71};
    for (const char letter : std::string("Unknown pin mode")) {
        text.push_back(static_cast<std::uint8_t>(letter));
        text.push_back(0);
    }
    text.insert(text.end(), {0x1B, 0x00, 0xF7});
    trial.hear(text);
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_EQ(trial.state().trouble->why, "the board says 'Unknown pin mode?'");
    EXPECT_EQ(trial.state().errors, 1U);
    for (int i = 0; i < 22; ++i) {
        trial.wait(500);
        trial.hear(stateOf(9, 1));
    }
    EXPECT_FALSE(trial.state().trouble) << "it passes";
}

TEST(FirmataController, OpeningAnewBeginsAnew) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.hear(voltage(5600));
    (void)trial.written();
    trial.open();
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    EXPECT_TRUE(trial.state().firmware.empty());
    EXPECT_FALSE(trial.state().volts);
    EXPECT_FALSE(trial.state().trouble);
    EXPECT_EQ(trial.state().reboots, 0U);
    EXPECT_FALSE(trial.state().traits.failsafe);
    shakeHands(trial);
    (void)trial.written();
    trial.send({{9, 1500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty()) << "not before it was let go";
}

TEST(FirmataController, NobodyTakesItsOutputAndItDoesNotGrow) {
    const DeviceProfile profile = test::profileOn(ControllerKind::firmata, {9});
    const std::unique_ptr<ServoController> controller = makeController(profile, parseDeviceAddress("sim://tablet"));
    controller->opened({}, Microseconds(0));
    for (int i = 0; i < 100'000; ++i) controller->tick(Microseconds(i * 50'000LL));
    EXPECT_LE(controller->takeOutput().size(), 100U);
}

TEST(FirmataController, AClockThatIsSetBackStopsNothing) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.wait(300);
    trial.jump(Microseconds(0));
    trial.send({{9, 1600.0, true}});
    trial.wait(50);
    trial.send({{9, 1700.0, true}});
    trial.wait(50);
    Messages pulses;
    for (const Bytes& message : trial.written())
        if (message[0] == 0xE9) pulses.push_back(message);
    ASSERT_FALSE(pulses.empty());
    EXPECT_EQ(pulses.back(), (Bytes{0xE9, 0x24, 0x0D}));
}

TEST(FirmataController, IsNotReachedOverHid) {
    EXPECT_THROW(
        (void)makeController(test::profileOn(ControllerKind::firmata, {9}), parseDeviceAddress("hid://0483:5750")),
        InvalidInput);
    EXPECT_THROW((void)makeController(test::profileOn(ControllerKind::firmata, {128}), parseDeviceAddress("sim://uno")),
                 InvalidInput);
}

} // namespace
} // namespace lumorph
