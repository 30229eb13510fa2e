#include "devices/protocol/maestro.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/byte_cuts.h"

namespace lumorph::maestro {
namespace {

using testing::ElementsAre;

/// Remainder of a division of polynomials over GF(2), bit by bit as they leave the wire (lowest first): another way
/// than the one that is tested.
int remainderOf(const Bytes& bytes) {
    std::vector<int> bits;
    for (const std::uint8_t byte : bytes)
        for (int i = 0; i < 8; ++i) bits.push_back(byte >> i & 1);
    bits.resize(bits.size() + 7, 0);
    const std::vector<int> divisor = {1, 0, 0, 0, 1, 0, 0, 1}; // 91
    for (std::size_t i = 0; i + 7 < bits.size(); ++i)
        if (bits[i])
            for (std::size_t j = 0; j < divisor.size(); ++j) bits[i + j] ^= divisor[j];
    int rest = 0;
    for (int i = 0; i < 7; ++i) rest |= bits[bits.size() - 7 + static_cast<std::size_t>(i)] << i;
    return rest;
}

TEST(Maestro, ChecksumIsTheVendors) {
    EXPECT_EQ(checksum(Bytes{0x83, 0x01}), 0x17);
    for (const Bytes& bytes :
         {Bytes{}, Bytes{0x00}, Bytes{0xFF}, Bytes{0x84, 0x00, 0x70, 0x2E}, Bytes{0xAA, 0x0C, 0x04, 0x05, 0x7F, 0x7F}})
        EXPECT_EQ(checksum(bytes), remainderOf(bytes));
}

TEST(Maestro, WritesTheVendorsVectors) {
    const Form compact;
    const Form pololu{true, 12, false};
    EXPECT_THAT(setTarget(compact, 0, 6000), ElementsAre(0x84, 0x00, 0x70, 0x2E));
    EXPECT_THAT(setTarget(pololu, 0, 6000), ElementsAre(0xAA, 0x0C, 0x04, 0x00, 0x70, 0x2E));
    EXPECT_THAT(setTarget(compact, 5, 0), ElementsAre(0x84, 0x05, 0x00, 0x00));
    EXPECT_THAT(setSpeed(compact, 5, 140), ElementsAre(0x87, 0x05, 0x0C, 0x01));
    EXPECT_THAT(askPosition(compact, 3), ElementsAre(0x90, 0x03));
    EXPECT_THAT(askPosition(pololu, 3), ElementsAre(0xAA, 0x0C, 0x10, 0x03));
    EXPECT_THAT(goHome(compact), ElementsAre(0xA2));
    EXPECT_THAT(askErrors(compact), ElementsAre(0xA1));
    EXPECT_THAT(askErrors(pololu), ElementsAre(0xAA, 0x0C, 0x21));
    const Bytes checked = setTarget({true, 12, true}, 0, 6000);
    ASSERT_EQ(checked.size(), 7U);
    EXPECT_EQ(checked.back(), remainderOf({0xAA, 0x0C, 0x04, 0x00, 0x70, 0x2E}));
}

TEST(Maestro, RefusesWhatItsBytesCannotCarry) {
    EXPECT_THROW((void)setTarget({}, 128, 6000), InvalidInput);
    EXPECT_THROW((void)setTarget({}, 0, 16384), InvalidInput);
    EXPECT_THROW((void)setTarget({}, 0, -1), InvalidInput);
    EXPECT_THROW((void)askErrors({true, 128, false}), InvalidInput);
}

void expectAll(Replies& replies) {
    replies.expectPosition(3);
    replies.expectErrors();
    replies.expectPosition(0);
}
const Bytes kStream = {0x70, 0x17, 0x28, 0x00, 0x00, 0x00};
const std::vector<Message> kMeant = {Position{3, 6000}, Errors{0x28}, Position{0, 0}};

TEST(MaestroReplies, GiveTheSameHoweverTheirBytesAreCut) {
    test::expectTheSameHoweverCut(kStream, kMeant, [] {
        Replies replies;
        expectAll(replies);
        return replies;
    });
}

TEST(MaestroReplies, TellErrorsInWords) {
    EXPECT_EQ(errorWords(0), "");
    EXPECT_EQ(errorWords(0x28), "checksum error, serial timeout");
    EXPECT_EQ(errorWords(1 << 1 | 1 << 2 | 1 << 4), "overrun, receive buffer full, protocol error");
}

TEST(MaestroReplies, CountWhatNobodyAskedForAndWhatCannotBe) {
    Replies replies;
    EXPECT_TRUE(replies.feed(Bytes{0x01, 0x02}).empty());
    EXPECT_EQ(replies.broken(), 2U);
    replies.expectErrors();
    replies.expectPosition(1);
    EXPECT_TRUE(replies.feed(Bytes{0xFF, 0xFF}).empty());
    EXPECT_EQ(replies.broken(), 3U);
    EXPECT_EQ(replies.open(), 0U) << "nobody knows whose bytes come next";
    replies.expectPosition(1);
    EXPECT_TRUE(replies.feed(Bytes{0x00, 0x40}).empty());
    EXPECT_EQ(replies.broken(), 4U);
}

TEST(MaestroReplies, DoNotGrow) {
    Replies replies;
    for (int i = 0; i < 10'000; ++i) replies.expectErrors();
    EXPECT_EQ(replies.open(), Replies::kMostOpen);
    EXPECT_EQ(replies.broken(), 10'000U - Replies::kMostOpen) << "each that was given up is told";
}

/// The oldest question is given up, with the half answer that has come to it; the next bytes answer the next one.
TEST(MaestroReplies, GiveUpTheOldestQuestionWithItsHalfAnswer) {
    for (const bool half : {false, true}) {
        Replies replies;
        for (int channel = 0; channel < static_cast<int>(Replies::kMostOpen); ++channel)
            replies.expectPosition(channel);
        if (half) {
            EXPECT_TRUE(replies.feed(Bytes{0x11}).empty());
        }
        EXPECT_EQ(replies.broken(), 0U);
        replies.expectPosition(99);
        EXPECT_EQ(replies.open(), Replies::kMostOpen);
        EXPECT_EQ(replies.broken(), 1U);
        EXPECT_EQ(replies.feed(Bytes{0x70, 0x17}), (std::vector<Message>{Position{1, 6000}}));
        EXPECT_EQ(replies.feed(Bytes{0x00, 0x10}), (std::vector<Message>{Position{2, 4096}}));
        for (std::size_t rest = Replies::kMostOpen - 3; rest > 0; --rest) (void)replies.feed(Bytes{0x00, 0x00});
        EXPECT_EQ(replies.feed(Bytes{0x01, 0x00}), (std::vector<Message>{Position{99, 1}}));
        EXPECT_EQ(replies.broken(), 1U);
    }
}

} // namespace
} // namespace lumorph::maestro
