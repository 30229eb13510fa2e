#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/firmata_trial.h"

namespace lumorph {
namespace {

using test::Bytes;
using test::ControllerTrial;
using test::Messages;
using namespace test::firmata_board;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FirmataController, AsksWhoIsThereAndWhatItCan) {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0");
    trial.open();
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.wait(500); // the boot loader swallows what came first
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.receive(kVersion);
    trial.wait(500);
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF0, 0x79, 0xF7}));
    trial.receive(firmwareNamed("LumorphTablet.ino"));
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF0, 0x6B, 0xF7}));
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    trial.receive(capabilities());
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_EQ(trial.state().firmware, "LumorphTablet 1.2");
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

TEST(FirmataController, ANameThatNoiseHasHitIsAskedForAgain) {
    const Bytes question = {0xF0, 0x79, 0xF7};
    ControllerTrial trial = readyTrial({9}, "LumorphEablet");
    ASSERT_EQ(trial.state().phase, ControllerPhase::unidentified);
    trial.wait(600);
    EXPECT_THAT(trial.written(), testing::Contains(question));
    trial.receive(firmwareNamed("LumorphTablet"));
    trial.receive(capabilities());
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_EQ(trial.state().firmware, "LumorphTablet 1.2");
    EXPECT_TRUE(trial.state().traits.failsafe);
    EXPECT_EQ(trial.state().reboots, 0U);
}

TEST(FirmataController, TheAnswerToADoubtThatTheUserHasSettledIsNoReboot) {
    ControllerTrial trial = readyTrial({9}, "Blink");
    trial.wait(600); // asked again
    trial.controller().confirm();
    trial.receive(firmwareNamed("Blink"));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_EQ(trial.state().reboots, 0U);
    trial.wait(1000);
    trial.receive(firmwareNamed("Blink")); // nobody has asked
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    EXPECT_EQ(trial.state().reboots, 1U);
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
    old.receive({0xF9, 0x01, 0x04});
    EXPECT_EQ(old.state().phase, ControllerPhase::refused);
    EXPECT_THAT(old.state().trouble->why, HasSubstr("1.4"));
}

TEST(FirmataController, ARebootIsNoticedAndThePoseIsNotSentAgain) {
    for (const bool firmwareFirst : {false, true}) {
        ControllerTrial trial = readyTrial({9, 10});
        trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
        trial.send({{9, 1550.0, true}, {10, 1500.0, true}}); // waits
        (void)trial.written();
        trial.receive(firmwareFirst ? firmwareNamed("LumorphTablet") : kVersion);
        EXPECT_EQ(trial.state().reboots, 1U);
        EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
        trial.receive(firmwareFirst ? kVersion : firmwareNamed("LumorphTablet"));
        EXPECT_EQ(trial.state().reboots, 1U) << "both are of one start";
        trial.wait(50);
        trial.receive(capabilities());
        EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
        (void)trial.written();
        trial.send({{9, 1560.0, true}, {10, 1500.0, true}});
        trial.wait(1000);
        EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
        trial.send({{9, 1560.0, false}, {10, 1500.0, false}}); // let go, and started anew
        trial.send({{9, 1560.0, true}, {10, 1500.0, false}});
        const Messages messages = trial.writtenBut(kQuestions);
        ASSERT_EQ(messages.size(), 8U);
        EXPECT_EQ(messages[6], (Bytes{0xF4, 0x09, 0x04}));
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
    trial.receive({0x12, 0x34, 0x9F});
    trial.wait(5);
    EXPECT_FALSE(trial.state().answering) << "noise is no answer";
    EXPECT_GT(trial.state().errors, 0U);
    trial.receive(kVersion);
    EXPECT_TRUE(trial.state().answering);
    EXPECT_FALSE(trial.state().trouble);
}

TEST(FirmataController, FallingSilentIsTold) {
    ControllerTrial trial = readyTrial({9});
    trial.wait(600);
    trial.receive(stateOf(9, 1));
    trial.wait(900);
    EXPECT_TRUE(trial.state().answering);
    trial.wait(200);
    EXPECT_FALSE(trial.state().answering);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("silent"));
}

TEST(FirmataController, TellsTheBatteryAndWarnsWhenItIsEmpty) {
    ControllerTrial trial = readyTrial({9});
    EXPECT_FALSE(trial.state().volts);
    trial.receive(voltage(7412));
    EXPECT_NEAR(trial.state().volts.value_or(0), 7.412, 1e-9);
    EXPECT_FALSE(trial.state().trouble);
    (void)trial.written();
    trial.receive(voltage(5600));
    EXPECT_FALSE(trial.state().trouble) << "it may be noise";
    trial.wait(10);
    EXPECT_THAT(trial.written(), testing::Contains(Bytes{0xF0, 0x02, 0xF7})) << "so it is asked at once";
    trial.receive(voltage(5610));
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_EQ(trial.state().trouble->why, "battery at 5.6 V");
    trial.receive(voltage(15'600)); // a bit was flipped
    EXPECT_EQ(trial.state().trouble->why, "battery at 5.6 V") << "nothing is well again";
    trial.receive(voltage(5600));
    EXPECT_NEAR(trial.state().volts.value_or(0), 5.61, 1e-9) << "the one before was far away";
    trial.receive(voltage(5600));
    EXPECT_NEAR(trial.state().volts.value_or(0), 5.6, 1e-9);
    EXPECT_THAT(trial.state().trouble->remedy, HasSubstr("charge it"));
    for (const int millivolts : {6050, 6150, 6190}) trial.receive(voltage(millivolts));
    EXPECT_TRUE(trial.state().trouble) << "under load it sags again: no warning that comes and goes";
    trial.receive(voltage(6500));
    EXPECT_FALSE(trial.state().trouble);
    trial.receive(voltage(200'000));
    EXPECT_NEAR(trial.state().volts.value_or(0), 6.5, 1e-9) << "no battery has 200 V";
    trial.receive(voltage(0));
    trial.receive(voltage(0));
    EXPECT_FALSE(trial.state().volts) << "nothing is wired to it";
}

TEST(FirmataController, AWatchdogThatLetGoIsNoticed) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.wait(1000);
    trial.receive(stateOf(9, 4));
    trial.wait(400);
    trial.receive(stateOf(9, 4));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    trial.wait(400);
    trial.receive(stateOf(9, 1));
    trial.wait(400);
    trial.receive(stateOf(9, 1));
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
    for (int i = 0; i < 2; ++i) trial.receive(stateOf(9, 1));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
}

TEST(FirmataController, NorDoManyThatASlowLinkHeldBack) {
    ControllerTrial trial = readyTrial({9, 10});
    const auto statesAsked = [&] {
        int count = 0;
        for (const Bytes& message : trial.written())
            count += message.size() > 2 && message[0] == 0xF0 && message[1] == 0x6D ? 1 : 0;
        return count;
    };
    (void)statesAsked();
    trial.send({{9, 0.0, false}, {10, 0.0, false}});
    trial.wait(500);
    const int before = statesAsked();
    ASSERT_GT(before, 8);
    trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
    trial.wait(450);
    for (int i = 0; i < before; ++i) trial.receive(stateOf(i % 2 == 0 ? 9 : 10, 1));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_EQ(trial.state().reboots, 0U);
}

TEST(FirmataController, ALostAnswerDoesNotMakeTheOthersWait) {
    ControllerTrial trial = readyTrial({9, 10});
    trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
    trial.wait(500); // questions that are never answered
    trial.receive(stateOf(9, 4));
    trial.receive(stateOf(10, 4));
    for (int i = 0; i < 2; ++i) {
        trial.wait(400);
        trial.receive(stateOf(i == 0 ? 9 : 10, 1));
        trial.receive(stateOf(i == 0 ? 10 : 9, 1));
    }
    EXPECT_EQ(trial.state().reboots, 1U);
}

/// A string message, and a byte at its end that no text has.
Bytes saying(const std::string& words) {
    Bytes text = {0xF0, 0x71};
    for (const char letter : words) {
        text.push_back(static_cast<std::uint8_t>(letter));
        text.push_back(0);
    }
    text.insert(text.end(), {0x1B, 0x00, 0xF7});
    return text;
}

TEST(FirmataController, WhatOurFirmwareSaysHasARemedyOfItsOwn) {
    for (const auto& [words, remedy] : {std::pair{"Silence: servos let go", "link is not interrupted"},
                                        std::pair{"Bytes were lost", "plugs and ground"},
                                        std::pair{"Started anew: it hung", "start the servos again"},
                                        std::pair{"Unknown pin mode", "channels of the profile"}}) {
        ControllerTrial trial = readyTrial({9});
        trial.receive(saying(words));
        ASSERT_TRUE(trial.state().trouble);
        EXPECT_THAT(trial.state().trouble->remedy, HasSubstr(remedy)) << words;
        EXPECT_FALSE(trial.state().batteryTrouble);
    }
}

TEST(FirmataController, WhatTheBoardSaysIsTold) {
    ControllerTrial trial = readyTrial({9});
    trial.receive(saying("Unknown pin mode"));
    ASSERT_TRUE(trial.state().trouble);
    EXPECT_EQ(trial.state().trouble->why, "the board says 'Unknown pin mode?'");
    EXPECT_EQ(trial.state().errors, 1U);
    for (int i = 0; i < 22; ++i) {
        trial.wait(500);
        trial.receive(stateOf(9, 1));
    }
    EXPECT_FALSE(trial.state().trouble) << "it passes";
}

TEST(FirmataController, OpeningAnewBeginsAnew) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.receive(voltage(5600));
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

TEST(FirmataController, IsNotReachedOverHid) {
    EXPECT_THROW(
        (void)makeController(test::profileOn(ControllerKind::firmata, {9}), parseDeviceAddress("hid://0483:5750")),
        InvalidInput);
    EXPECT_THROW((void)makeController(test::profileOn(ControllerKind::firmata, {128}), parseDeviceAddress("sim://uno")),
                 InvalidInput);
}

} // namespace
} // namespace lumorph
