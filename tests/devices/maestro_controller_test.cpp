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

const Bytes kErrorQuestion = {0xAA, 0x0C, 0x21};
const Bytes kPositionQuestion = {0xAA, 0x0C, 0x10};
const Messages kMaestroQuestions = {kErrorQuestion, kPositionQuestion};

/// A board that answers: its error register, and a position of every channel.
class AnsweringTrial {
public:
    explicit AnsweringTrial(const DeviceProfile& profile, const std::string& uri = "serial:///dev/ttyACM0")
        : trial(profile, uri) {
        trial.open("Pololu Micro Maestro 6-Servo Controller");
        wait(200);
        (void)take();
    }
    /// Answers every question within 5 ms; keeps the rest.
    void wait(int milliseconds) {
        for (int passed = 0; passed < milliseconds; passed += 5) {
            trial.wait(5);
            collect();
        }
    }
    Messages take() {
        collect();
        return std::exchange(rest_, {});
    }

    ControllerTrial trial;
    std::uint8_t errors = 0;
    int quarters = 6000;
    std::vector<int> asked;

private:
    void collect() {
        for (Bytes& message : trial.written()) {
            if (message == kErrorQuestion) {
                trial.receive({std::exchange(errors, std::uint8_t{0}), 0});
            } else if (message.size() == 4 && message[2] == 0x10) {
                asked.push_back(message[3]);
                trial.receive({static_cast<std::uint8_t>(quarters & 0xFF), static_cast<std::uint8_t>(quarters >> 8)});
            } else {
                rest_.push_back(std::move(message));
            }
        }
    }
    Messages rest_;
};

DeviceProfile sixServos() { return test::profileOn(ControllerKind::maestro, {0, 1, 2, 3, 4, 5}); }

TEST(MaestroController, IsKnownByNameAndByAnswer) {
    struct Row {
        const char* product;
        bool answers;
        ControllerPhase phase;
    };
    for (const Row& row : {Row{"Pololu Mini Maestro 12", true, ControllerPhase::ready},
                           Row{"USB Serial", true, ControllerPhase::unidentified},
                           Row{"Pololu Mini Maestro 12", false, ControllerPhase::handshake}}) {
        ControllerTrial trial(sixServos(), "serial:///dev/ttyACM0");
        trial.open(row.product);
        trial.receive({0xFF, 0xFF}); // still on its way from another time
        trial.wait(60);
        EXPECT_THAT(trial.written(), ElementsAre(kErrorQuestion));
        if (row.answers) trial.receive({0x10, 0x00}); // an error of before
        EXPECT_EQ(trial.state().phase, row.phase) << row.product;
        EXPECT_EQ(trial.state().errors, 0U);
        EXPECT_FALSE(trial.state().trouble);
        trial.send({{0, 1500.0, true}});
        EXPECT_EQ(trial.writtenBut(kMaestroQuestions).empty(), row.phase != ControllerPhase::ready);
    }
}

TEST(MaestroController, SendsQuartersInTheFormOfItsProfile) {
    AnsweringTrial board(sixServos());
    board.trial.send({{0, 1500.0, true}, {5, 1000.3, true}});
    // 1000.25 us are 4001 quarters: 31 x 128 + 33
    EXPECT_THAT(board.take(),
                ElementsAre(Bytes{0xAA, 0x0C, 0x04, 0x00, 0x70, 0x2E}, Bytes{0xAA, 0x0C, 0x04, 0x05, 0x21, 0x1F}));

    DeviceProfile checked = sixServos();
    checked.controllerNumber = 7;
    checked.maestroCrc = true;
    ControllerTrial trial(checked, "serial:///dev/ttyACM0");
    trial.open("Maestro");
    trial.wait(60);
    const Messages questions = trial.written();
    ASSERT_EQ(questions.size(), 1U);
    ASSERT_EQ(questions[0].size(), 4U);
    EXPECT_EQ(Bytes(questions[0].begin(), questions[0].begin() + 3), (Bytes{0xAA, 0x07, 0x21}));

    DeviceProfile compact = sixServos();
    compact.controllerNumber = -1;
    ControllerTrial alone(compact, "serial:///dev/ttyACM0");
    alone.open("Maestro");
    alone.wait(60);
    EXPECT_THAT(alone.written(), ElementsAre(Bytes{0xA1}));
    alone.receive({0, 0});
    alone.send({{0, 1500.0, true}});
    EXPECT_THAT(alone.written(), ElementsAre(Bytes{0x84, 0x00, 0x70, 0x2E}));
}

TEST(MaestroController, KeepsWithinLimitsWhenItRounds) {
    DeviceProfile profile = test::profileOn(ControllerKind::maestro, {0});
    profile.servos[0].pulseMin = 1000.1;
    profile.servos[0].pulseMax = 1999.9;
    for (const auto& [pulse, quarters] : {std::pair{1000.1, 4001}, std::pair{1999.9, 7999}}) {
        AnsweringTrial board(profile);
        board.trial.send({{0, pulse, true}});
        const Messages messages = board.take();
        ASSERT_EQ(messages.size(), 1U);
        EXPECT_EQ(messages[0][4] | messages[0][5] << 7, quarters);
    }
}

TEST(MaestroController, DetachesAtOnceByTargetZero) {
    AnsweringTrial board(sixServos());
    board.trial.send({{0, 1500.0, true}, {1, 1500.0, true}});
    (void)board.take();
    board.trial.send({{0, 1600.0, false}, {1, 1600.0, true}});
    EXPECT_THAT(board.take(), ElementsAre(Bytes{0xAA, 0x0C, 0x04, 0x00, 0x00, 0x00}));
    board.wait(20);
    EXPECT_THAT(board.take(), ElementsAre(Bytes{0xAA, 0x0C, 0x04, 0x01, 0x00, 0x32})); // 6400
}

TEST(MaestroController, TellsTargetZeroAgainUntilTheBoardSaysSo) {
    AnsweringTrial board(sixServos());
    board.trial.send({{0, 1500.0, true}});
    (void)board.take();
    const Bytes off = {0xAA, 0x0C, 0x04, 0x00, 0x00, 0x00};
    board.trial.send({{0, 1600.0, false}});
    board.wait(1000); // it says 1500 us
    EXPECT_GE(board.take().size(), 35U);
    EXPECT_TRUE(board.trial.state().detaching) << "it says the contrary";
    board.quarters = 0;
    board.wait(300);
    EXPECT_FALSE(board.trial.state().detaching);
    for (const Bytes& message : board.take()) EXPECT_EQ(message, off);
    board.wait(10'000);
    EXPECT_THAT(board.take(), IsEmpty());
}

TEST(MaestroController, SaysHonestlyWhatItDoesNotKnow) {
    AnsweringTrial board(sixServos());
    const ControllerTraits& traits = board.trial.state().traits;
    EXPECT_FALSE(traits.failsafe);
    EXPECT_THAT(traits.failsafeWord, HasSubstr("only where a serial timeout is set in the board itself"));
    EXPECT_FALSE(traits.readsPosition);
    EXPECT_FALSE(traits.readsVoltage);
    EXPECT_EQ(traits.pulseStep, 0.25);
    board.wait(2000);
    for (const auto& pulse : board.trial.state().readPulses) EXPECT_FALSE(pulse) << "what was sent is no feedback";
}

TEST(MaestroController, TellsErrorsInWordsAndForgetsThem) {
    AnsweringTrial board(sixServos());
    board.errors = 1 << 3 | 1 << 4;
    board.wait(300);
    EXPECT_EQ(board.trial.state().errors, 2U);
    ASSERT_TRUE(board.trial.state().trouble);
    EXPECT_EQ(board.trial.state().trouble->why, "the board reports: checksum error, protocol error");
    EXPECT_EQ(board.trial.state().phase, ControllerPhase::ready);
    board.wait(11'000);
    EXPECT_FALSE(board.trial.state().trouble);
}

TEST(MaestroController, ItsOwnTimeoutEndsTheSession) {
    AnsweringTrial board(sixServos());
    board.trial.send({{0, 1500.0, true}});
    board.wait(100);
    (void)board.take();
    board.errors = 1 << 5;
    board.wait(210);
    EXPECT_EQ(board.trial.state().reboots, 1U);
    EXPECT_TRUE(board.trial.state().traits.failsafe);
    EXPECT_THAT(board.trial.state().trouble->why, HasSubstr("serial timeout"));
    board.wait(500);
    EXPECT_EQ(board.trial.state().phase, ControllerPhase::ready);
    board.trial.send({{0, 1510.0, true}});
    board.wait(500);
    EXPECT_THAT(board.take(), IsEmpty()) << "the pose is not sent again";
    board.trial.send({{0, 1510.0, false}});
    (void)board.take();
    board.trial.send({{0, 1510.0, true}});
    EXPECT_FALSE(board.take().empty());
}

TEST(MaestroController, ATargetThatTheLineSpoiledIsToldAgain) {
    AnsweringTrial board(sixServos());
    board.trial.send({{3, 1500.0, true}});
    board.quarters = 6000;
    board.wait(1500);
    (void)board.take();
    board.quarters = 6512;
    board.wait(3000);
    const Messages again = board.take();
    // 6000 quarters on channel 3, as the board's manual writes it.
    EXPECT_THAT(again, testing::ElementsAreArray(Messages(3, Bytes{0xAA, 0x0C, 0x04, 0x03, 0x70, 0x2E})))
        << "a few times, not for ever";
    EXPECT_EQ(board.trial.state().errors, 0U);
    ASSERT_TRUE(board.trial.state().trouble);
    EXPECT_THAT(board.trial.state().trouble->why, HasSubstr("holds servo 4 at 1628 us, where it was told 1500 us"));
    EXPECT_THAT(board.trial.state().trouble->remedy, HasSubstr("Min and Max"));
    board.quarters = 6000;
    board.wait(1500);
    EXPECT_EQ(board.trial.state().errors, 1U) << "the line had spoiled it after all";
}

TEST(MaestroController, AChannelWithASpeedOfItsOwnIsOnItsWayNotSpoiled) {
    AnsweringTrial board(sixServos());
    board.trial.send({{3, 1500.0, true}});
    board.quarters = 4000;
    for (; board.quarters < 6000; board.quarters += 100) {
        board.wait(250);
        if (board.quarters == 4000) (void)board.take();
    }
    board.wait(1500);
    EXPECT_THAT(board.take(), IsEmpty());
    EXPECT_EQ(board.trial.state().errors, 0U);
    EXPECT_FALSE(board.trial.state().trouble);
}

TEST(MaestroController, ABoardThatLetGoIsNoticed) {
    AnsweringTrial board(sixServos());
    board.trial.send({{3, 1500.0, true}});
    board.wait(1500);
    EXPECT_THAT(board.asked, testing::Contains(3));
    EXPECT_EQ(board.trial.state().reboots, 0U);
    board.quarters = 0; // it started anew: nothing is sent
    board.wait(1500);
    EXPECT_EQ(board.trial.state().reboots, 1U);
    EXPECT_THAT(board.trial.state().trouble->why, HasSubstr("let go"));
}

TEST(MaestroController, OneOddAnswerIsNoReboot) {
    AnsweringTrial board(sixServos());
    board.trial.send({{3, 1500.0, true}});
    board.wait(1500);
    for (int round = 0; round < 5; ++round) {
        const std::size_t before = board.asked.size();
        board.quarters = 0; // a line that loses bytes also makes some up
        for (int i = 0; i < 200 && board.asked.size() == before; ++i) board.wait(5);
        ASSERT_EQ(board.asked.size(), before + 1);
        board.quarters = 6000;
        board.wait(1500);
    }
    EXPECT_EQ(board.trial.state().reboots, 0U);
    EXPECT_FALSE(board.trial.state().trouble);
}

TEST(MaestroController, SilenceNamesNumberAndMode) {
    ControllerTrial trial(sixServos(), "serial:///dev/ttyACM0");
    trial.open("Maestro");
    trial.wait(1100);
    EXPECT_FALSE(trial.state().answering);
    EXPECT_THAT(trial.state().trouble->why, HasSubstr("device number 12"));
    EXPECT_THAT(trial.state().trouble->remedy, HasSubstr("USB Dual Port"));
}

TEST(MaestroController, LostBytesDoNotShiftTheAnswers) {
    AnsweringTrial board(sixServos());
    for (int i = 0; i < 60; ++i) {
        board.trial.wait(5);
        if (!board.trial.written().empty()) break;
    }
    board.trial.receive({0x00}); // half an answer
    board.wait(1000);
    board.errors = 1 << 1;
    board.wait(300);
    EXPECT_EQ(board.trial.state().trouble->why, "the board reports: overrun");
    EXPECT_EQ(board.trial.state().errors, 1U);
}

TEST(MaestroController, RefusesChannelsAndLinksThatItHasNot) {
    EXPECT_THROW(
        (void)makeController(test::profileOn(ControllerKind::maestro, {24}), parseDeviceAddress("sim://maestro")),
        InvalidInput);
    EXPECT_THROW((void)makeController(sixServos(), parseDeviceAddress("hid://1FFB:0089")), InvalidInput);
}

} // namespace
} // namespace lumorph
