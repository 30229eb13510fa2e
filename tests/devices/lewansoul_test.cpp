#include "devices/protocol/lewansoul.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/byte_cuts.h"

namespace lumorph::lewansoul {
namespace {

using testing::ElementsAre;

TEST(Lewansoul, WritesTheVendorsVectors) {
    EXPECT_THAT(move(std::array{Place{1, 2000}}, 1000),
                ElementsAre(0x55, 0x55, 0x08, 0x03, 0x01, 0xE8, 0x03, 0x01, 0xD0, 0x07));
    EXPECT_THAT(move(std::array{Place{2, 1200}, Place{9, 2300}}, 800),
                ElementsAre(0x55, 0x55, 0x0B, 0x03, 0x02, 0x20, 0x03, 0x02, 0xB0, 0x04, 0x09, 0xFC, 0x08));
    EXPECT_THAT(askVoltage(), ElementsAre(0x55, 0x55, 0x02, 0x0F));
    EXPECT_THAT(unload(std::array{1, 2, 6}), ElementsAre(0x55, 0x55, 0x06, 0x14, 0x03, 0x01, 0x02, 0x06));
    EXPECT_THAT(askPositions(std::array{4}), ElementsAre(0x55, 0x55, 0x04, 0x15, 0x01, 0x04));
}

TEST(Lewansoul, RefusesWhatDoesNotFit) {
    EXPECT_THROW((void)move({}, 20), InvalidInput);
    EXPECT_THROW((void)move(std::vector<Place>(84), 20), InvalidInput);
    EXPECT_EQ(move(std::vector<Place>(83), 20)[2], 254);
    EXPECT_THROW((void)move(std::array{Place{1, -1}}, 20), InvalidInput);
    EXPECT_THROW((void)move(std::array{Place{1, 500}}, 70000), InvalidInput);
    EXPECT_THROW((void)unload(std::array{255}), InvalidInput);
    // Questions, answers and moves of so many servos fit one report.
    EXPECT_LE(move(std::vector<Place>(kServosPerReport), 20).size(), kReportBytes);
}

const Bytes kStream = {
    0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C,                               // 7400 mV
    0x55, 0x55, 0x09, 0x15, 0x02, 0x01, 0xF4, 0x01, 0x02, 0xFB, 0xFF, // 1 at 500, 2 at -5
    0x00, 0x00,                                                       // filling
    0x55, 0x55, 0x05, 0x08, 0x01, 0x01, 0x00,                         // an action group has ended
};
const std::vector<Message> kMeant = {Voltage{7.4}, Positions{{{1, 500}, {2, -5}}}, Other{8}};

TEST(LewansoulParser, GivesTheSameHoweverItsBytesAreCut) {
    test::expectTheSameHoweverCut(kStream, kMeant, [] { return Parser(); });
}

TEST(LewansoulParser, GoesOnAfterGarbageAndCountsIt) {
    struct Row {
        const char* what;
        Bytes bytes;
        std::uint64_t broken;
    };
    const std::vector<Row> rows = {
        {"other bytes", {0x01, 0x02, 0x03}, 1},
        {"one header byte too many", {0x55}, 1},
        {"a length that cannot be", {0x55, 0x55, 0x01, 0x0F}, 1},
        {"a voltage that is too long", {0x55, 0x55, 0x06, 0x0F}, 1},
        {"positions that are not threes", {0x55, 0x55, 0x07, 0x15}, 1},
        {"a count that is a lie", {0x55, 0x55, 0x06, 0x15, 0x02, 0x01, 0xF4, 0x01}, 1},
        {"two runs", {0x07, 0x00, 0x07}, 2},
    };
    for (const Row& row : rows) {
        Parser parser;
        std::vector<Message> messages = parser.feed(row.bytes);
        for (Message& m : parser.feed(Bytes{0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C})) messages.push_back(std::move(m));
        EXPECT_EQ(messages, std::vector<Message>{Voltage{7.4}}) << row.what;
        EXPECT_EQ(parser.broken(), row.broken) << row.what;
        EXPECT_FALSE(parser.waiting());
    }
}

TEST(LewansoulParser, FramesDoNotGoOnInTheNextReport) {
    Parser parser;
    Bytes report = {0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C};
    report.resize(kReportBytes, 0);
    EXPECT_EQ(parser.report(report), std::vector<Message>{Voltage{7.4}});
    EXPECT_EQ(parser.broken(), 0U);
    const Bytes cut = {0x55, 0x55, 0x04, 0x0F, 0xE8};
    EXPECT_TRUE(parser.report(cut).empty());
    EXPECT_EQ(parser.broken(), 1U);
    EXPECT_EQ(parser.report(report), std::vector<Message>{Voltage{7.4}});
    EXPECT_EQ(parser.broken(), 1U);
}

/// A header that cannot begin a frame holds nothing up that follows it.
TEST(LewansoulParser, AFrameRightAfterAnImpossibleHeaderIsReadAtOnce) {
    for (const std::uint8_t length : {7, 100, 250}) { // positions come in threes
        Parser parser;
        EXPECT_TRUE(parser.feed(Bytes{0x55, 0x55, length, 0x15}).empty());
        // 7400 mV: 0x1CE8
        EXPECT_EQ(parser.feed(Bytes{0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C}), std::vector<Message>{Voltage{7.4}}) << length;
    }
}

} // namespace
} // namespace lumorph::lewansoul
