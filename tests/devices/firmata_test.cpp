#include "devices/protocol/firmata.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/byte_cuts.h"

namespace lumorph::firmata {
namespace {

using testing::ElementsAre;

TEST(Firmata, WritesWhatTheProtocolSays) {
    EXPECT_THAT(askVersion(), ElementsAre(0xF9));
    EXPECT_THAT(askFirmware(), ElementsAre(0xF0, 0x79, 0xF7));
    EXPECT_THAT(askCapabilities(), ElementsAre(0xF0, 0x6B, 0xF7));
    EXPECT_THAT(askPinState(9), ElementsAre(0xF0, 0x6D, 0x09, 0xF7));
    EXPECT_THAT(askVoltage(), ElementsAre(0xF0, 0x02, 0xF7));
    EXPECT_THAT(attachServo(9), ElementsAre(0xF4, 0x09, 0x04));
    EXPECT_THAT(detachServo(9), ElementsAre(0xF4, 0x09, 0x01));
    EXPECT_THAT(resetBoard(), ElementsAre(0xFF));
    // 544 = 4 x 128 + 32, 2400 = 18 x 128 + 96
    EXPECT_THAT(configureServo(9, 544, 2400), ElementsAre(0xF0, 0x70, 0x09, 0x20, 0x04, 0x60, 0x12, 0xF7));
    EXPECT_THAT(limitStep(9, 300), ElementsAre(0xF0, 0x03, 0x09, 0x2C, 0x02, 0xF7)); // 2 x 128 + 44
    EXPECT_THAT(writeValue(9, 1500), ElementsAre(0xE9, 0x5C, 0x0B));
    EXPECT_THAT(writeExtended(9, 1500), ElementsAre(0xF0, 0x6F, 0x09, 0x5C, 0x0B, 0xF7));
    EXPECT_THAT(writeValue(15, 1500), ElementsAre(0xEF, 0x5C, 0x0B));
    EXPECT_THAT(writeValue(16, 1500), ElementsAre(0xF0, 0x6F, 0x10, 0x5C, 0x0B, 0xF7));
    EXPECT_THAT(writeValue(3, 20000), ElementsAre(0xF0, 0x6F, 0x03, 0x20, 0x1C, 0x01, 0xF7));
}

TEST(Firmata, RefusesWhatItsBytesCannotCarry) {
    EXPECT_THROW((void)attachServo(128), InvalidInput);
    EXPECT_THROW((void)writeValue(-1, 1500), InvalidInput);
    EXPECT_THROW((void)writeValue(3, -1), InvalidInput);
    EXPECT_THROW((void)configureServo(3, 0, 16384), InvalidInput);
}

/// Everything a board says, with facts of the tables by its side.
const Bytes kStream = {
    0xF9, 0x02, 0x05,                                                       // version 2.5
    0xF0, 0x79, 0x02, 0x05, 'A',  0x00, 'b',  0x00, 0x69, 0x01, 0xF7,       // firmware "Ab\xE9"
    0xF0, 0x6C, 0x7F, 0x00, 0x01, 0x04, 0x0E, 0x7F, 0x02, 0x0A, 0x7F, 0xF7, // three pins
    0xF0, 0x6A, 0x7F, 0x7F, 0x00, 0x01, 0xF7,                               // analog mapping
    0xF0, 0x6E, 0x09, 0x04, 0x5C, 0x0B, 0xF7,                               // pin 9 is a servo at 1500
    0xF0, 0x6E, 0x63, 0xF7,                                                 // there is no pin 99
    0xF0, 0x71, 'n',  0x00, 'o',  0x00, 0xF7,                               // "no"
    0xF0, 0x02, 0x68, 0x39, 0x00, 0xF7,                                     // 7400 mV = 57 x 128 + 104
    0xE3, 0x7F, 0x07, 0x91, 0x05, 0x01,                                     // readings
    0xF0, 0x55, 0x01, 0xF7,                                                 // somebody else's: skipped
};
const std::vector<Message> kMeant = {
    Version{2, 5},
    Firmware{2, 5, "Ab\xE9"},
    Capabilities{{{}, {{0, 1}, {4, 14}}, {{2, 10}}}},
    AnalogMapping{{-1, -1, 0, 1}},
    PinState{9, 4, 1500},
    PinState{99, -1, 0},
    Text{"no"},
    Voltage{7.4},
    Reading{false, 3, 1023},
    Reading{true, 1, 133},
};

TEST(FirmataParser, ReadsEveryAnswer) {
    Parser parser;
    const std::vector<Message> messages = parser.feed(kStream);
    ASSERT_EQ(messages.size(), kMeant.size());
    for (std::size_t i = 0; i < messages.size(); ++i) EXPECT_EQ(messages[i], kMeant[i]) << i;
    EXPECT_EQ(parser.broken(), 0U);
}

TEST(FirmataParser, GivesTheSameHoweverItsBytesAreCut) {
    test::expectTheSameHoweverCut(kStream, kMeant, [] { return Parser(); });
}

TEST(FirmataParser, GoesOnAfterGarbageAndCountsIt) {
    struct Row {
        const char* what;
        Bytes bytes;
        std::uint64_t broken;
    };
    const std::vector<Row> rows = {
        {"data outside of messages", {0x01, 0x02, 0x03}, 1},
        {"an extended message is broken off", {0xF0, 0x79, 0x02}, 1},
        {"a short one, too", {0xE3, 0x01}, 1},
        {"an end without beginning", {0xF7}, 1},
        {"what only a studio says", {0xF4, 0x09, 0x04}, 1},
        {"an empty extended message", {0xF0, 0xF7}, 1},
        {"half a letter", {0xF0, 0x71, 'a', 0xF7}, 1},
        {"a firmware without version", {0xF0, 0x79, 0x02, 0xF7}, 1},
        {"capabilities that do not end", {0xF0, 0x6C, 0x04, 0x0E, 0xF7}, 1},
        {"half a capability", {0xF0, 0x6C, 0x04, 0xF7}, 1},
        {"a state without value", {0xF0, 0x6E, 0x09, 0x04, 0xF7}, 1},
        {"a voltage of two bytes", {0xF0, 0x02, 0x01, 0x01, 0xF7}, 1},
        {"three things", {0xF0, 0x79, 0xE3, 0x01, 0x55 | 0x80, 0x00}, 3},
    };
    for (const Row& row : rows) {
        Parser parser;
        EXPECT_TRUE(parser.feed(row.bytes).empty()) << row.what;
        EXPECT_EQ(parser.feed(Bytes{0xF9, 0x02, 0x05}), std::vector<Message>{(Version{2, 5})}) << row.what;
        EXPECT_EQ(parser.broken(), row.broken) << row.what;
    }
}

TEST(FirmataParser, AnEndlessMessageIsGivenUpAndCountedOnce) {
    Parser parser;
    EXPECT_TRUE(parser.feed(Bytes{0xF0, 0x71}).empty());
    const Bytes letters(1000, 0x00);
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(parser.feed(letters).empty());
    EXPECT_TRUE(parser.feed(Bytes{0xF7}).empty());
    EXPECT_EQ(parser.broken(), 1U);
    EXPECT_EQ(parser.feed(Bytes{0xF0, 0x71, 'a', 0x00, 0xF7}), std::vector<Message>{Text{"a"}});
}

TEST(FirmataParser, TakesTheLongestMessageAndNoLonger) {
    for (const bool fits : {true, false}) {
        Bytes bytes(Parser::kLongest + (fits ? 1 : 2), 0x00);
        bytes[0] = 0xF0;
        bytes[1] = 0x01; // of somebody else, which is no error
        bytes.push_back(0xF7);
        Parser parser;
        EXPECT_TRUE(parser.feed(bytes).empty());
        EXPECT_EQ(parser.broken(), fits ? 0U : 1U);
    }
}

TEST(FirmataParser, ReadsVoltagesAboveSixteenVolts) {
    // 24 600 mV: 24600 = 1 x 16384 + 64 x 128 + 24
    EXPECT_EQ(Parser().feed(Bytes{0xF0, 0x02, 24, 64, 1, 0xF7}), std::vector<Message>{Voltage{24.6}});
}

TEST(FirmataParser, HasRoomForTheLargestBoard) {
    Bytes bytes = {0xF0, 0x6C};
    for (int pin = 0; pin < 128; ++pin) {
        for (std::uint8_t mode = 0; mode < 16; ++mode) bytes.insert(bytes.end(), {mode, 1});
        bytes.push_back(0x7F);
    }
    bytes.push_back(0xF7);
    Parser parser;
    const std::vector<Message> messages = parser.feed(bytes);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(std::get<Capabilities>(messages[0]).pins.size(), 128U);
}

} // namespace
} // namespace lumorph::firmata
