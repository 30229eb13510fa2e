#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/controller_harness.h"

namespace lumorph {
namespace {

using test::Bytes;
using test::ControllerTrial;
using test::Messages;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Bytes kVoltageQuestion = {0x55, 0x55, 0x02, 0x0F};
const Messages kQuestions = {kVoltageQuestion, {0x55, 0x55, 0x05, 0x15}, {0x55, 0x55, 0x04, 0x15}};
constexpr const char* kHid = "hid://0483:5750?product=LOBOT";

Bytes report(Bytes frame) {
    frame.resize(64, 0);
    return frame;
}
Bytes voltage(int millivolts) {
    return {0x55,
            0x55,
            0x04,
            0x0F,
            static_cast<std::uint8_t>(millivolts & 0xFF),
            static_cast<std::uint8_t>(millivolts >> 8)};
}
Bytes position(std::uint8_t servo, int place) {
    return {0x55,
            0x55,
            0x06,
            0x15,
            0x01,
            servo,
            static_cast<std::uint8_t>(place & 0xFF),
            static_cast<std::uint8_t>(place >> 8 & 0xFF)};
}

DeviceProfile armProfile(const std::vector<int>& channels) {
    DeviceProfile profile = test::profileOn(ControllerKind::lewansoul, channels);
    for (ServoSetup& servo : profile.servos) {
        servo.pulseMin = 500.0;
        servo.pulseMax = 2500.0;
    }
    return profile;
}

ControllerTrial readyTrial(const std::vector<int>& channels) {
    ControllerTrial trial(armProfile(channels), kHid);
    trial.open("LOBOT");
    trial.wait(60);
    trial.receive(report(voltage(7400)));
    (void)trial.written();
    return trial;
}

TEST(LewansoulController, AsksForTheVoltageOnceStaleReportsAreGone) {
    ControllerTrial trial(armProfile({1}), kHid);
    trial.open("LOBOT");
    trial.receive(report(voltage(7400))); // of another time
    trial.wait(45);
    EXPECT_THAT(trial.written(), IsEmpty());
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    EXPECT_FALSE(trial.state().volts);
    trial.wait(5);
    EXPECT_THAT(trial.written(), ElementsAre(kVoltageQuestion));
    trial.receive(report(position(1, 500))); // nobody asked
    EXPECT_EQ(trial.state().phase, ControllerPhase::handshake);
    trial.receive(report(voltage(7400)));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_NEAR(trial.state().volts.value_or(0), 7.4, 1e-9);
    EXPECT_TRUE(trial.state().traits.readsPosition);
    EXPECT_FALSE(trial.state().traits.failsafe);
    EXPECT_THAT(trial.state().traits.failsafeWord, HasSubstr("none"));
}

TEST(LewansoulController, NeverMovesOnUsbNumbersAlone) {
    struct Row {
        const char* product;
        bool answers;
        ControllerPhase phase;
    };
    for (const Row& row :
         {Row{"LOBOT", true, ControllerPhase::ready}, Row{"My LOBOT arm", true, ControllerPhase::ready},
          Row{"LOBOT", false, ControllerPhase::handshake}, Row{"Keyboard", true, ControllerPhase::unidentified},
          Row{"", true, ControllerPhase::unidentified}, Row{"Keyboard", false, ControllerPhase::refused}}) {
        ControllerTrial trial(armProfile({1}), kHid);
        trial.open(row.product);
        trial.wait(1100);
        if (row.answers) trial.receive(report(voltage(7400)));
        EXPECT_EQ(trial.state().phase, row.phase) << row.product;
        trial.send({{1, 1500.0, true}});
        trial.wait(100);
        if (row.phase != ControllerPhase::ready) {
            for (const Bytes& message : trial.written()) EXPECT_EQ(message, kVoltageQuestion) << row.product;
        }
        trial.controller().confirm();
        EXPECT_EQ(trial.state().phase == ControllerPhase::ready, row.answers) << row.product;
        EXPECT_EQ(trial.state().trouble.has_value(), !row.answers) << row.product;
    }
}

TEST(LewansoulController, MapsPulsesToPositionsAndBack) {
    ControllerTrial trial = readyTrial({1, 2});
    trial.send({{1, 500.0, true}, {2, 2500.0, true}});
    // A start takes 100 ms: the servo may stand a little beside where it was left.
    EXPECT_THAT(trial.writtenBut(kQuestions),
                ElementsAre(Bytes{0x55, 0x55, 0x0B, 0x03, 0x02, 100, 0x00, 0x01, 0x00, 0x00, 0x02, 0xE8, 0x03}));
    trial.wait(120);
    // Half a stroke at one stroke a second: it must not be told to go faster than it may.
    trial.send({{1, 1500.9, true}, {2, 2500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions),
                ElementsAre(Bytes{0x55, 0x55, 0x08, 0x03, 0x01, 0xF4, 0x01, 0x01, 0xF4, 0x01}));
    trial.wait(520);
    // A short way in 33 ms, the time of one command at 30 Hz.
    trial.send({{1, 1510.0, true}, {2, 2500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions),
                ElementsAre(Bytes{0x55, 0x55, 0x08, 0x03, 0x01, 33, 0x00, 0x01, 0xF9, 0x01}));
    trial.receive(report({0x55, 0x55, 0x09, 0x15, 0x02, 0x01, 0xF4, 0x01, 0x02, 0xFB, 0xFF}));
    EXPECT_EQ(trial.state().readPulses[0], 1500.0);
    EXPECT_EQ(trial.state().readPulses[1], 490.0) << "turned by hand beyond its end";
}

TEST(LewansoulController, KeepsWithinLimitsWhenItRounds) {
    DeviceProfile profile = armProfile({1});
    profile.servos[0].pulseMin = 1001.0;
    profile.servos[0].pulseMax = 1999.0;
    for (const auto& [pulse, place] : {std::pair{1001.0, 251}, std::pair{1999.0, 749}, std::pair{1500.0, 500}}) {
        ControllerTrial trial(profile, kHid);
        trial.open("LOBOT");
        trial.wait(60);
        trial.receive(report(voltage(7400)));
        (void)trial.written();
        trial.send({{1, pulse, true}});
        const Messages messages = trial.writtenBut(kQuestions);
        ASSERT_EQ(messages.size(), 1U);
        EXPECT_EQ(messages[0][8] | messages[0][9] << 8, place);
    }
}

TEST(LewansoulController, ReadsPositionsAFewTimesASecondAndForgetsOldOnes) {
    ControllerTrial trial = readyTrial({1, 2});
    trial.wait(2000);
    int questions = 0;
    for (const Bytes& message : trial.written())
        questions += message == Bytes{0x55, 0x55, 0x05, 0x15, 0x02, 0x01, 0x02};
    EXPECT_GE(questions, 7);
    EXPECT_LE(questions, 9);
    trial.receive(report(position(1, 300)));
    EXPECT_EQ(trial.state().readPulses[0], 1100.0);
    EXPECT_FALSE(trial.state().readPulses[1]);
    trial.wait(900);
    EXPECT_TRUE(trial.state().readPulses[0]);
    trial.wait(200);
    EXPECT_FALSE(trial.state().readPulses[0]) << "nobody knows where it is now";
}

TEST(LewansoulController, DoubtsPositionsThatCannotBe) {
    ControllerTrial trial = readyTrial({1});
    trial.wait(300);
    trial.receive(report(position(1, 0x5555)));
    EXPECT_FALSE(trial.state().readPulses[0]);
    EXPECT_EQ(trial.state().errors, 1U);
    trial.wait(300);
    trial.receive(report(position(7, 500)));
    EXPECT_EQ(trial.state().errors, 2U);
    trial.receive(Bytes{0x55, 0x55, 0x04});
    EXPECT_EQ(trial.state().errors, 3U);
}

TEST(LewansoulController, UnloadsThirtyTimesInASecondAndThenOnceASecond) {
    ControllerTrial trial = readyTrial({1, 2});
    trial.send({{1, 1500.0, true}, {2, 1500.0, true}});
    (void)trial.written();
    trial.send({{1, 1500.0, false}, {2, 1500.0, false}});
    const Bytes unload = {0x55, 0x55, 0x05, 0x14, 0x02, 0x01, 0x02};
    EXPECT_THAT(trial.written(), ElementsAre(unload));
    // Where it stands tells nothing of whether it is under power.
    trial.wait(300);
    for (const int place : {500, 480, 460}) trial.receive(report(position(1, place)));
    trial.wait(700);
    const Messages quick = trial.writtenBut(kQuestions);
    EXPECT_GE(quick.size(), 25U);
    EXPECT_LE(quick.size(), 30U);
    trial.wait(10'000);
    EXPECT_THAT(trial.writtenBut(kQuestions), Messages(10, unload));
    trial.send({{1, 1500.0, true}, {2, 1500.0, false}});
    trial.wait(3'000);
    const Bytes unloadSecond = {0x55, 0x55, 0x04, 0x14, 0x01, 0x02};
    EXPECT_THAT(trial.writtenBut(kQuestions), testing::Contains(unloadSecond));
    trial.wait(3'000);
    EXPECT_THAT(trial.writtenBut(kQuestions), Messages(3, unloadSecond));
}

TEST(LewansoulController, AtMostThirtyMovesASecond) {
    ControllerTrial trial = readyTrial({1});
    int moves = 0;
    for (int step = 0; step < 1000; ++step) { // 5 s
        trial.send({{1, 1000.0 + step, true}});
        trial.wait(5);
        for (const Bytes& message : trial.written()) moves += message[3] == 0x03;
    }
    EXPECT_LE(moves, 151);
    EXPECT_GE(moves, 120);
}

TEST(LewansoulController, MessagesOfManyServosFitReports) {
    std::vector<int> channels;
    std::vector<GuardedPulse> pulses;
    for (int i = 1; i <= 30; ++i) {
        channels.push_back(i);
        pulses.push_back({i, 1500.0, true});
    }
    ControllerTrial trial = readyTrial(channels);
    trial.send(pulses);
    trial.wait(500);
    for (GuardedPulse& pulse : pulses) pulse.attached = false;
    trial.send(pulses);
    std::size_t moved = 0;
    std::size_t unloaded = 0;
    for (const Bytes& message : trial.written()) {
        EXPECT_LE(message.size(), 64U);
        if (message[3] == 0x03) moved += message[4];
        if (message[3] == 0x14) unloaded += message[4];
    }
    EXPECT_EQ(moved, 30U);
    EXPECT_EQ(unloaded, 30U);
}

TEST(LewansoulController, SerialBoardsSpeakMicrosecondsAndReadNothing) {
    ControllerTrial trial(armProfile({1, 2, 3, 4, 5, 6}), "serial:///dev/ttyUSB0?baud=9600");
    trial.open("CP2102 USB to UART");
    trial.wait(60);
    EXPECT_THAT(trial.written(), ElementsAre(kVoltageQuestion));
    for (const std::uint8_t byte : voltage(7400)) trial.receive({byte});
    EXPECT_EQ(trial.state().phase, ControllerPhase::unidentified);
    EXPECT_FALSE(trial.state().traits.readsPosition);
    EXPECT_LT(trial.state().traits.commandsPerSecond, 20.0) << "25 bytes a set";
    trial.controller().confirm();
    trial.send({{1, 2000.0, true}});
    const Messages messages = trial.writtenBut(kQuestions);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages[0][8] | messages[0][9] << 8, 2000);
    EXPECT_GE(messages[0][5] | messages[0][6] << 8, 50);
    trial.wait(1000);
    EXPECT_THAT(trial.writtenBut({kVoltageQuestion}), IsEmpty());
}

TEST(LewansoulController, TheRestOfAFrameThatNeverCameDoesNotSpoilTheNext) {
    ControllerTrial trial(armProfile({1}), "serial:///dev/ttyUSB0?baud=9600");
    trial.open("LOBOT");
    trial.wait(60);
    trial.receive({0x55, 0x55, 0x04, 0x0F, 0xE8});
    trial.wait(400);
    trial.receive(voltage(7400));
    EXPECT_EQ(trial.state().phase, ControllerPhase::ready);
    EXPECT_NEAR(trial.state().volts.value_or(0), 7.4, 1e-9);
    EXPECT_EQ(trial.state().errors, 1U);
}

TEST(LewansoulController, TellsSilenceAndAnEmptyBattery) {
    ControllerTrial trial = readyTrial({1});
    trial.wait(900);
    trial.receive(report(voltage(5600)));
    trial.wait(20);
    trial.receive(report(voltage(5600)));
    EXPECT_EQ(trial.state().trouble->why, "battery at 5.6 V");
    trial.wait(1100);
    EXPECT_FALSE(trial.state().answering);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("silent"));
}

TEST(LewansoulController, RefusesServosThatItCannotName) {
    EXPECT_THROW((void)makeController(armProfile({254}), parseDeviceAddress(kHid)), InvalidInput);
}

} // namespace
} // namespace lumorph
