#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware/board.h"
#include "tests/firmware/firmata_bytes.h"

namespace lumorph::firmware_test {
namespace {

using testing::ElementsAreArray;
using testing::IsEmpty;

Bytes plus(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Bytes inPairs(const std::string& text) {
    Bytes bytes;
    for (const char c : text) {
        bytes.push_back(low(c));
        bytes.push_back(high(c));
    }
    return bytes;
}

Bytes textMessage(const std::string& text) { return plus(plus({0xF0, 0x71}, inPairs(text)), {0xF7}); }

const Bytes kVersion = {0xF9, 0x02, 0x05};
const Bytes kFirmware = plus(plus({0xF0, 0x79, 1, 2}, inPairs("LumorphTablet")), {0xF7});

class FirmwareFirmata : public testing::Test {
protected:
    FirmwareFirmata() {
        board_.run(60.0);
        greeting_ = board_.takeSaid();
    }
    Bytes answerTo(const Bytes& question) {
        (void)board_.takeSaid();
        board_.send(question);
        board_.runUntilSent();
        board_.run(25.0);
        return board_.takeSaid();
    }
    /// Widths on a pin in the next three frames, microseconds, whole.
    std::vector<int> widthsOf(int pin) {
        (void)board_.takePulses();
        board_.run(60.0);
        std::vector<int> widths;
        for (const Pulse& pulse : board_.takePulses())
            if (pulse.pin == pin) widths.push_back(static_cast<int>(pulse.width + 0.5));
        return widths;
    }
    void does(const Bytes& message) {
        board_.send(message);
        board_.runUntilSent();
        board_.run(42.0); // a frame for it to be taken over, one to be over
    }
    int widthNow(int pin) {
        const std::vector<int> widths = widthsOf(pin);
        return widths.empty() ? 0 : widths.back();
    }

    Board board_{"six", 16};
    Bytes greeting_;
};

testing::Matcher<int> about(int width) { return testing::AllOf(testing::Ge(width - 4), testing::Le(width + 4)); }

TEST_F(FirmwareFirmata, TellsItsNameUnaskedAndWhenAsked) {
    EXPECT_THAT(greeting_, ElementsAreArray(plus(kVersion, kFirmware)));
    EXPECT_THAT(answerTo({0xF9}), ElementsAreArray(kVersion));
    EXPECT_THAT(answerTo({0xF0, 0x79, 0xF7}), ElementsAreArray(kFirmware));
}

TEST_F(FirmwareFirmata, TellsWhatItsPinsCanDo) {
    Bytes capability = {0xF0, 0x6C};
    Bytes mapping = {0xF0, 0x6A};
    for (const int pin : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}) {
        const bool servo = pin == 3 || pin == 5 || pin == 6 || (pin >= 9 && pin <= 11);
        capability = plus(capability, servo ? Bytes{4, 14, 0x7F} : Bytes{0x7F});
        mapping.push_back(0x7F);
    }
    EXPECT_THAT(answerTo({0xF0, 0x6B, 0xF7}), ElementsAreArray(plus(capability, {0xF7})));
    EXPECT_THAT(answerTo({0xF0, 0x69, 0xF7}), ElementsAreArray(plus(mapping, {0xF7})));
}

TEST_F(FirmwareFirmata, TellsThePinState) {
    EXPECT_THAT(answerTo({0xF0, 0x6D, 9, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 9, 1, 0, 0, 0xF7}));
    does(plus(write(9, 1500), attach(9)));
    EXPECT_THAT(answerTo({0xF0, 0x6D, 9, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 9, 4, 0x5C, 0x0B, 0xF7}));
    does(write(9, 2400)); // beyond its limits
    EXPECT_THAT(answerTo({0xF0, 0x6D, 9, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 9, 4, low(1999), high(1999), 0xF7}))
        << "a microsecond inside of them, so that the wire does not pass them";
    EXPECT_THAT(answerTo({0xF0, 0x6D, 8, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 8, 0x7F, 0, 0xF7}));
    EXPECT_THAT(answerTo({0xF0, 0x6D, 99, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 99, 0xF7}));
}

TEST_F(FirmwareFirmata, StartsWithExactlyThePulseWrittenBefore) {
    does(write(9, 1234));
    EXPECT_THAT(widthsOf(9), IsEmpty());
    (void)board_.takePulses();
    board_.send(attach(9));
    board_.run(200.0);
    const std::vector<Pulse> pulses = board_.takePulses();
    ASSERT_GE(pulses.size(), 8U);
    for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, 1234.0, 4.0);
    EXPECT_LE(pulses.front().start, board_.now() - 150.0);
}

TEST_F(FirmwareFirmata, AServoThatWasNeverToldAPlaceGetsNoPulse) {
    does(attach(9));
    EXPECT_THAT(widthsOf(9), IsEmpty());
    (void)board_.takePulses();
    does(write(9, 1111));
    const std::vector<Pulse> pulses = board_.takePulses();
    ASSERT_FALSE(pulses.empty());
    for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, 1111.0, 4.0);
}

TEST_F(FirmwareFirmata, AttachesAndDetachesWithoutCuttingAPulse) {
    does(plus(write(9, 1900), write(10, 1100)));
    for (int i = 0; i < 40; ++i) {
        board_.send(plus(attach(9), attach(10)));
        board_.run(37.3);
        board_.send(plus(detach(9), detach(10)));
        board_.run(31.7);
    }
    const std::vector<Pulse> pulses = board_.takePulses();
    EXPECT_GT(pulses.size(), 80U);
    for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, pulse.pin == 9 ? 1900.0 : 1100.0, 4.0);
    EXPECT_FALSE(board_.isHigh(9));
    EXPECT_THAT(widthsOf(9), IsEmpty());
}

TEST_F(FirmwareFirmata, DetachesWithinTwoFrames) {
    does(plus(write(9, 1900), attach(9)));
    for (int i = 0; i < 40; ++i) {
        does(attach(9));
        board_.run(1.0 + 0.51 * i);
        (void)board_.takePulses();
        board_.send(detach(9));
        board_.runUntilSent();
        const double sent = board_.now();
        board_.run(80.0);
        for (const Pulse& pulse : board_.takePulses()) EXPECT_LE(pulse.start, sent + 40.0);
    }
}

TEST_F(FirmwareFirmata, ClampsToTheHeadersLimits) {
    does(attach(9));
    does(write(9, 2500));
    EXPECT_THAT(widthNow(9), about(2000));
    does(write(9, 544));
    EXPECT_THAT(widthNow(9), about(1000));
    does(write(9, 16383));
    EXPECT_THAT(widthNow(9), about(2000));
    does({0xF0, 0x6F, 9, 0x5C, 0x0B, 0xF7});
    EXPECT_THAT(widthNow(9), about(1500));
    does({0xF0, 0x6F, 9, 0x5C, 0x0B, 0x01, 0xF7}); // 17884
    EXPECT_THAT(widthNow(9), about(2000));
    does({0xF0, 0x6F, 9, 0x5C, 0x0B, 0x00, 0x00, 0x00, 0x40, 0xF7});
    EXPECT_THAT(widthNow(9), about(2000));
}

TEST_F(FirmwareFirmata, ClampsToTheStudiosLimitsWhichCannotWidenTheHeaders) {
    does(limits(9, 1200, 1700));
    EXPECT_THAT(widthsOf(9), IsEmpty()) << "limits do not attach";
    does(plus(write(9, 1900), attach(9)));
    EXPECT_THAT(widthNow(9), about(1700));
    does(write(9, 1000));
    EXPECT_THAT(widthNow(9), about(1200));
    does(limits(9, 600, 2400));
    does(write(9, 2400));
    EXPECT_THAT(widthNow(9), about(2000));
    EXPECT_THAT(answerTo(limits(9, 1700, 1200)), ElementsAreArray(textMessage("Limits the wrong way round")));
}

TEST_F(FirmwareFirmata, LimitsNarrowedWhileDetachedHoldForTheFirstPulseToo) {
    does(plus(write(9, 1900), limits(9, 1200, 1700)));
    (void)board_.takePulses();
    does(attach(9));
    const std::vector<Pulse> pulses = board_.takePulses();
    ASSERT_FALSE(pulses.empty());
    for (const Pulse& pulse : pulses) EXPECT_NEAR(pulse.width, 1700.0, 4.0);
}

TEST_F(FirmwareFirmata, TakesDegreesAndMistakesForWhatTheyAre) {
    does(plus(attach(9), limits(9, 1100, 1900)));
    const int rows[][2] = {{0, 1100}, {90, 1500}, {180, 1900}, {45, 1300}, {181, 1300}, {499, 1300}, {500, 1100}};
    for (const auto& [value, width] : rows) {
        does(write(9, value));
        EXPECT_THAT(widthNow(9), about(width)) << value;
    }
    EXPECT_THAT(answerTo(write(9, 300)), ElementsAreArray(textMessage("Neither degrees nor microseconds")));
}

TEST_F(FirmwareFirmata, ResetDetachesAndForgets) {
    does(plus(plus(limits(9, 1200, 1700), write(9, 1500)), attach(9)));
    EXPECT_THAT(widthNow(9), about(1500));
    does({0xFF});
    EXPECT_THAT(widthsOf(9), IsEmpty());
    does(attach(9));
    EXPECT_THAT(widthsOf(9), IsEmpty());
    does(write(9, 2000));
    EXPECT_THAT(widthNow(9), about(2000));
}

TEST_F(FirmwareFirmata, SaysWhatIsWrong) {
    EXPECT_THAT(answerTo(attach(8)), ElementsAreArray(textMessage("No servo on this pin")));
    EXPECT_THAT(answerTo({0xF4, 9, 3}), ElementsAreArray(textMessage("Unknown pin mode")));
    EXPECT_THAT(answerTo({0xF0, 0x55, 0xF7}), ElementsAreArray(textMessage("Unknown message")));
    EXPECT_THAT(answerTo({0xF0, 0x6F, 9, 0xF7}), ElementsAreArray(textMessage("Message too short")));
    EXPECT_THAT(answerTo(plus(plus({0xF0, 0x6F, 9}, Bytes(200, 1)), {0xF7})),
                ElementsAreArray(textMessage("Message too long")));
    EXPECT_THAT(answerTo({0xF0, 0x7A, 10, 0, 0xF7}), IsEmpty());
    EXPECT_THAT(answerTo({0xF0, 0xF7}), IsEmpty());
}

TEST_F(FirmwareFirmata, BrokenOffMessagesMoveNothing) {
    does(plus(write(9, 1500), attach(9)));
    does({0xE9, 0x10, 0xE9}); // one write broken off, one begun ...
    EXPECT_THAT(widthNow(9), about(1500));
    does({0xF0, 0x6F, 9, 0x10, 0x0C, 0xF0, 0x6F}); // ... and two long ones
    EXPECT_THAT(widthNow(9), about(1500));
    does({0xF9, 0x10, 0x0C, 0xF7, 0x10, 0xC0, 0x09, 0x10});
    EXPECT_THAT(widthNow(9), about(1500));
    does({0xE9, 0x5C, 0x0B});
    EXPECT_THAT(answerTo({0xF0, 0x6D, 9, 0xF7}), ElementsAreArray(Bytes{0xF0, 0x6E, 9, 4, 0x5C, 0x0B, 0xF7}));
}

TEST_F(FirmwareFirmata, MeasuresTheBattery) {
    for (const int pin : {200, 764, 1000}) { // millivolts behind the divider of 11 to 1
        board_.setPinMillivolts(pin);
        board_.run(700.0);
        const Bytes answer = answerTo({0xF0, 0x02, 0xF7});
        ASSERT_EQ(answer.size(), 6U);
        EXPECT_EQ(answer[0], 0xF0);
        EXPECT_EQ(answer[1], 0x02);
        EXPECT_EQ(answer[5], 0xF7);
        const int millivolts = answer[2] | answer[3] << 7 | answer[4] << 14;
        EXPECT_NEAR(millivolts, 11 * pin, 13) << "a step of the converter is 11.8 mV of the battery";
    }
}

} // namespace
} // namespace lumorph::firmware_test
