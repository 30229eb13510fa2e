#include <algorithm>
#include <limits>

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

TEST(FirmataPulses, OurFirmwareHasThePulseBeforeItIsEnabled) {
    ControllerTrial trial = readyTrial({9, 16});
    trial.send({{9, 1500.0, true}, {16, 1200.0, true}});
    const Bytes pulse = {0xE9, 0x5C, 0x0B};
    // Limits 1000 = 7 x 128 + 104 and 2000 = 15 x 128 + 80; 1 stroke a second are 20 us a frame.
    const Bytes limits = {0xF0, 0x70, 0x09, 0x68, 0x07, 0x50, 0x0F, 0xF7};
    const Bytes far = {0xF0, 0x6F, 0x10, 0x30, 0x09, 0xF7};
    const Bytes farLimits = {0xF0, 0x70, 0x10, 0x68, 0x07, 0x50, 0x0F, 0xF7};
    EXPECT_THAT(trial.writtenBut(kQuestions),
                ElementsAre(pulse, limits, Bytes{0xF0, 0x03, 0x09, 0x14, 0x00, 0xF7}, Bytes{0xF4, 0x09, 0x04}, pulse,
                            far, farLimits, Bytes{0xF0, 0x03, 0x10, 0x14, 0x00, 0xF7}, Bytes{0xF4, 0x10, 0x04}, far));
}

TEST(FirmataPulses, OurFirmwareKnowsHowFastAServoMayGo) {
    struct Row {
        double velocity; ///< strokes a second
        std::uint8_t minor;
        std::vector<int> told; ///< microseconds a frame
    };
    for (const Row& row : {Row{4.0, 2, {80}}, Row{0.013, 2, {1}}, Row{0.51, 2, {11}}, Row{4.0, 1, {}}}) {
        DeviceProfile profile = test::profileOn(ControllerKind::firmata, {9});
        profile.servos[0].maxVelocity = row.velocity;
        ControllerTrial trial(profile, "serial:///dev/ttyUSB0");
        trial.open();
        trial.receive(kVersion);
        trial.receive(firmwareNamed("LumorphTablet", row.minor));
        trial.receive(capabilities());
        const auto told = [&] {
            std::vector<int> steps;
            for (const Bytes& message : trial.written())
                if (message.size() == 6 && message[1] == 0x03) steps.push_back(message[3] | message[4] << 7);
            return steps;
        };
        trial.send({{9, 1500.0, true}});
        EXPECT_EQ(told(), row.told) << row.velocity;
        if (row.told.empty()) continue;
        trial.wait(20);
        trial.send({{9, 1510.0, true}});
        EXPECT_THAT(told(), IsEmpty()) << "nothing is new";
        profile.servos[0].maxVelocity = 2.0;
        trial.controller().setLimits(profile);
        trial.wait(20);
        trial.send({{9, 1520.0, true}});
        EXPECT_EQ(told(), std::vector{40});
    }
}

TEST(FirmataPulses, AValueThatTheLineSpoiledIsToldAgain) {
    for (const char* firmware : {"LumorphTablet", "StandardFirmata"}) {
        ControllerTrial trial = readyTrial({9, 10}, firmware);
        trial.send({{9, 1600.0, true}, {10, 1500.0, true}});
        trial.wait(20);
        const auto pulses = [&] {
            int count = 0;
            for (const Bytes& message : trial.written())
                count += std::ranges::search(message, Bytes{0xE9, 0x40, 0x0C}).size() > 0; // 1600 on pin 9
            return count;
        };
        (void)pulses();
        /// Answers all questions of a time with what the board has.
        const auto answersFor = [&](int milliseconds, int value) {
            int count = 0;
            for (int passed = 0; passed < milliseconds; passed += 5) {
                trial.wait(5);
                for (const Bytes& message : trial.written()) {
                    count += std::ranges::search(message, Bytes{0xE9, 0x40, 0x0C}).size() > 0;
                    if (message.size() == 4 && message[1] == 0x6D)
                        trial.receive(stateOf(message[2], 4, message[2] == 9 ? value : 1500));
                }
            }
            return count;
        };
        EXPECT_EQ(answersFor(3000, 1600), 0) << "it has what it was told";
        EXPECT_EQ(answersFor(3000, 1602), 0) << "it keeps off its limits";
        EXPECT_EQ(trial.state().errors, 0U);
        EXPECT_EQ(answersFor(600, 1728), 1) << firmware;
        EXPECT_EQ(answersFor(3000, 1600), 0);
        EXPECT_EQ(trial.state().errors, 1U) << "the line had spoiled it";
        EXPECT_FALSE(trial.state().trouble);
        EXPECT_EQ(answersFor(20'000, 1728), 3) << "a board that will not have it is not flooded";
        EXPECT_EQ(trial.state().errors, 1U) << "that is not the line";
        ASSERT_TRUE(trial.state().trouble);
        EXPECT_THAT(trial.state().trouble->why, HasSubstr("holds servo 1 at 1728 us, where it was told 1600 us"));
        trial.send({{9, 1700.0, true}, {10, 1500.0, true}});
        trial.wait(20);
        (void)trial.written();
        trial.send({{9, 1600.0, true}, {10, 1500.0, true}});
        trial.wait(20);
        EXPECT_EQ(pulses(), 1);
        EXPECT_EQ(answersFor(20'000, 1728), 3) << "but another value counts anew";
        EXPECT_EQ(answersFor(12'000, 1600), 0);
        EXPECT_FALSE(trial.state().trouble) << "it is over when the board has it";
        EXPECT_EQ(trial.state().reboots, 0U);
    }
}

TEST(FirmataPulses, StockFirmwareHasThePulseRightBehindTheAttach) {
    ControllerTrial trial = readyTrial({9}, "StandardFirmata");
    trial.send({{9, 1500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xF7, 0xF4, 0x09, 0x04}, Bytes{0xE9, 0x5C, 0x0B}));
    trial.wait(20);
    trial.send({{9, 1510.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xF7, 0xE9, 0x66, 0x0B}))
        << "it ends a message whose end was lost";
}

TEST(FirmataPulses, SendsOnlyChangesAndTheLatestWhenTheLinkHasRoom) {
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

TEST(FirmataPulses, TheLinksBaudRateCapsTheRate) {
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

TEST(FirmataPulses, DetachesAtOnceAndBeforeAllElse) {
    ControllerTrial trial = readyTrial({9, 10});
    trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
    (void)trial.written();
    trial.send({{9, 1600.0, true}, {10, 1600.0, true}}); // waits for its slot
    trial.send({{9, 1600.0, false}, {10, 1700.0, true}});
    EXPECT_THAT(trial.written(), ElementsAre(detachOf(9), Bytes{0xF0, 0x6D, 0x09, 0xF7}));
    trial.wait(20);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(Bytes{0xEA, 0x24, 0x0D})); // 1700; 9 is not written any more
    trial.wait(500);
    for (const Bytes& message : trial.writtenBut(kQuestions)) EXPECT_EQ(message, detachOf(9)) << "10 holds: no reset";
    trial.send({{9, 1600.0, true}, {10, 1700.0, true}});
    trial.send({{9, 1600.0, false}, {10, 1700.0, false}});
    trial.send({{9, 1600.0, true}, {10, 1700.0, false}});
    const Messages messages = trial.writtenBut(kQuestions);
    ASSERT_GE(messages.size(), 1U);
    EXPECT_EQ(messages[0], detachOf(10));
}

TEST(FirmataPulses, DetachesAgainUntilTheBoardIsKnownToHaveObeyed) {
    for (const bool answers : {false, true}) {
        ControllerTrial trial = readyTrial({9, 10});
        trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
        trial.wait(20);
        (void)trial.written();
        trial.send({{9, 1500.0, false}, {10, 1500.0, false}});
        EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(detachOf(9), detachOf(10), kReset));
        EXPECT_TRUE(trial.state().detaching);
        int told = 0;
        const auto passes = [&](int milliseconds) {
            told = 0;
            for (int passed = 0; passed < milliseconds; passed += 5) {
                trial.wait(5);
                for (const Bytes& message : trial.written()) {
                    told += message == kReset;
                    if (answers && message.size() == 4 && message[1] == 0x6D) trial.receive(stateOf(message[2], 1));
                }
            }
        };
        passes(1000);
        EXPECT_GE(told, answers ? 2 : 35);
        EXPECT_LE(told, answers ? 8 : 40) << "each of them was asked for twice";
        EXPECT_FALSE(trial.state().detaching);
        passes(10'000);
        EXPECT_EQ(told, answers ? 0 : 10) << "once a second: nobody knows";
        trial.send({{9, 1500.0, true}, {10, 1500.0, true}});
        passes(3'000);
        EXPECT_EQ(told, 0) << "they are wanted again";
    }
}

TEST(FirmataPulses, ASlowLineIsNotFlooded) {
    ControllerTrial trial =
        readyTrial({2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}, "StandardFirmata", "serial:///dev/rfcomm0?baud=9600");
    std::vector<GuardedPulse> limp;
    for (int pin = 2; pin <= 13; ++pin) limp.push_back({pin, 0.0, false});
    trial.send(limp);
    trial.wait(1000);
    std::size_t bytes = 0;
    for (const Bytes& message : trial.written()) bytes += message.size();
    EXPECT_LT(bytes, 960U) << "of a second";
}

TEST(FirmataPulses, DetachesInEveryPhase) {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, {9}), "serial:///dev/ttyUSB0");
    trial.open();
    trial.send({{9, 1500.0, true}});
    EXPECT_THAT(trial.written(), ElementsAre(Bytes{0xF9}, Bytes{0xF0, 0x79, 0xF7}));
    trial.send({{9, 1500.0, false}});
    EXPECT_THAT(trial.written(), ElementsAre(detachOf(9)));
    shakeHands(trial, "Blink");
    (void)trial.written();
    trial.wait(400);
    trial.send({{9, 1500.0, true}});
    trial.send({{9, 1500.0, false}});
    EXPECT_THAT(trial.state().phase, ControllerPhase::unidentified);
    for (const Bytes& message : trial.writtenBut(kQuestions)) EXPECT_EQ(message, detachOf(9));
    trial.wait(1000);
    (void)trial.written();
    trial.wait(5000);
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty()) << "it may be no servo controller: it is left in peace";
}

TEST(FirmataPulses, ValuesStayWithinTheLimitsWhenTheyAreRounded) {
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

TEST(FirmataPulses, TheShortestPulsesAreThoseOfTheFirmware) {
    struct Row {
        const char* firmware;
        std::uint8_t minor;
        int sent; ///< for 500 us
    };
    for (const Row& row :
         {Row{"LumorphTablet", 1, 500}, Row{"LumorphTablet", 0, 544}, Row{"StandardFirmata", 5, 544}}) {
        DeviceProfile profile = test::profileOn(ControllerKind::firmata, {9, 10});
        profile.servos[0].pulseMin = 500.0;
        ControllerTrial trial(profile, "serial:///dev/ttyUSB0");
        trial.open();
        trial.receive(kVersion);
        trial.receive(firmwareNamed(row.firmware, row.minor));
        trial.receive(capabilities());
        ASSERT_EQ(trial.state().phase, ControllerPhase::ready);
        (void)trial.written();
        trial.send({{9, 500.0, true}});
        const Bytes pulse = trial.writtenBut(kQuestions).back();
        EXPECT_EQ(pulse[1] | pulse[2] << 7, row.sent) << row.firmware << " 1." << int{row.minor};
        ASSERT_EQ(trial.state().trouble.has_value(), row.sent == 544);
        if (row.sent == 500) continue;
        EXPECT_EQ(trial.state().trouble->why, "this firmware makes no pulse shorter than 544 us (servo 1)");
        EXPECT_THAT(trial.state().trouble->remedy, HasSubstr("upload the firmware of the studio"));
    }
}

TEST(FirmataPulses, AServoWithNothingButShorterOnesIsRefused) {
    DeviceProfile profile = test::profileOn(ControllerKind::firmata, {9});
    profile.servos[0].pulseMin = 500.0;
    profile.servos[0].pulseMax = 540.0;
    for (const char* firmware : {"StandardFirmata", "LumorphTablet"}) {
        ControllerTrial trial(profile, "serial:///dev/ttyUSB0");
        trial.open();
        shakeHands(trial, firmware);
        const bool own = firmware == std::string("LumorphTablet");
        EXPECT_EQ(trial.state().phase, own ? ControllerPhase::ready : ControllerPhase::refused) << firmware;
        (void)trial.written();
        trial.controller().confirm();
        trial.send({{9, 520.0, true}});
        EXPECT_EQ(trial.writtenBut(kQuestions).empty(), !own) << firmware;
    }
}

TEST(FirmataPulses, IgnoresPulsesThatAreNone) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, std::numeric_limits<double>::quiet_NaN(), true}, {13, 1500.0, true}});
    EXPECT_THAT(trial.writtenBut(kQuestions), IsEmpty());
}

TEST(FirmataPulses, ADetachThatWasLostIsSaidAgain) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.send({{9, 1500.0, false}});
    trial.wait(1000);
    (void)trial.written();
    for (int i = 0; i < 8; ++i) trial.receive(stateOf(9, 4));
    trial.wait(5);
    EXPECT_THAT(trial.writtenBut(kQuestions), ElementsAre(kReset));
}

TEST(FirmataPulses, AClockThatIsSetBackStopsNothing) {
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

// A board that may not have heard it must be told to let go again, whatever the clock says.
TEST(FirmataPulses, AClockThatIsSetBackDoesNotEndTheLettingGo) {
    ControllerTrial trial = readyTrial({9});
    trial.send({{9, 1500.0, true}});
    trial.wait(300);
    trial.jump(Microseconds(3'600'000'000));
    trial.send({{9, 1500.0, false}});
    trial.wait(2000);
    (void)trial.written();
    trial.jump(Microseconds(1'000'000));
    trial.wait(3000);
    int told = 0;
    for (const Bytes& message : trial.written()) told += message == detachOf(9) ? 1 : 0;
    EXPECT_GE(told, 2) << "once a second";
}

} // namespace
} // namespace lumorph
