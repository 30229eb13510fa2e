#include "devices/transport/simulated_transport.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/simulator/simulated_bench.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Keeps what it gets and gives what the test puts in.
class FakeBoard final : public SimulatedBoard {
public:
    explicit FakeBoard(bool isHid = false) : isHid_(isHid) {}
    [[nodiscard]] std::string name() const override { return "tablet"; }
    [[nodiscard]] std::string product() const override { return "Fake"; }
    [[nodiscard]] BoardFaults faults() const override { return faults_; }
    void setFaults(const BoardFaults& faults) override { faults_ = faults; }
    void reboot() override {}
    [[nodiscard]] std::vector<SimulatedServo> servos() const override { return {}; }
    void plugged(Microseconds) override { ++links; }
    void take(std::span<const std::uint8_t> bytes, Microseconds now) override {
        taken.insert(taken.end(), bytes.begin(), bytes.end());
        times.push_back(now);
    }
    [[nodiscard]] std::vector<std::uint8_t> give(Microseconds) override {
        if (toGive.empty()) return {};
        Bytes bytes = toGive.front();
        toGive.pop_front();
        return bytes;
    }
    [[nodiscard]] bool isHid() const override { return isHid_; }

    BoardFaults faults_;
    Bytes taken;
    std::vector<Microseconds> times;
    std::deque<Bytes> toGive;
    int links = 0;

private:
    bool isHid_;
};

class SimulatedTransportTest : public testing::Test {
protected:
    void make(bool isHid = false, std::map<std::string, std::string> options = {}) {
        board_ = std::make_shared<FakeBoard>(isHid);
        received_.clear();
        transport_ = makeSimulatedTransport(board_, {"tablet", std::move(options)},
                                            {[this] { ++opened_; },
                                             [this](auto bytes) { received_.emplace_back(bytes.begin(), bytes.end()); },
                                             [this](const LinkTrouble& why) { troubles_.push_back(why.why); }},
                                            [this] { return now_; });
    }
    Bytes all() const {
        Bytes bytes;
        for (const Bytes& piece : received_) bytes.insert(bytes.end(), piece.begin(), piece.end());
        return bytes;
    }

    EventLoop loop_;
    Microseconds now_{5s};
    std::shared_ptr<FakeBoard> board_;
    int opened_ = 0;
    std::vector<Bytes> received_;
    std::vector<std::string> troubles_;
    std::unique_ptr<Transport> transport_;
};

TEST_F(SimulatedTransportTest, CarriesBytesBothWays) {
    make();
    transport_->write(Bytes{9}); // not open
    transport_->open();
    transport_->open();
    EXPECT_EQ(opened_, 1);
    EXPECT_EQ(board_->links, 1);
    EXPECT_EQ(transport_->product(), "Fake");
    EXPECT_FALSE(transport_->identity().empty());
    transport_->write(Bytes{1, 2, 3});
    EXPECT_EQ(board_->taken, (Bytes{1, 2, 3})); // without a turn of the event loop
    EXPECT_EQ(transport_->unsent(), 0u);
    board_->toGive = {{4, 5}, {6}};
    ASSERT_TRUE(EventLoop::runUntil([&] { return all().size() == 3; }, 2s));
    EXPECT_EQ(all(), (Bytes{4, 5, 6}));
    transport_->close();
    board_->toGive = {{7}};
    EventLoop::runFor(20ms);
    EXPECT_EQ(all().size(), 3u);
    EXPECT_TRUE(troubles_.empty());
}

TEST_F(SimulatedTransportTest, DropsWhatAStalledLinkHasNotTaken) {
    make();
    transport_->open();
    transport_->write(Bytes{1});
    board_->faults_.stalled = true;
    transport_->write(Bytes{2, 3});
    transport_->write(Bytes{4});
    EXPECT_EQ(transport_->unsent(), 3u);
    transport_->dropUnsent();
    EXPECT_EQ(transport_->unsent(), 0u);
    transport_->write(Bytes{5});
    board_->faults_.stalled = false;
    ASSERT_TRUE(EventLoop::runUntil([&] { return board_->taken.size() == 2; }, 2s));
    EXPECT_EQ(board_->taken, (Bytes{1, 5}));
}

TEST_F(SimulatedTransportTest, AHidBoardGetsWholeReports) {
    make(true);
    transport_->open();
    transport_->write(Bytes{0x55, 0x55, 2, 0x0F});
    ASSERT_EQ(board_->taken.size(), 64u);
    EXPECT_EQ(board_->taken[3], 0x0F);
    EXPECT_EQ(std::accumulate(board_->taken.begin() + 4, board_->taken.end(), 0), 0);
    EXPECT_THROW(transport_->write(Bytes(65)), InvalidInput);
    board_->toGive = {Bytes(64, 1), Bytes(64, 2)};
    ASSERT_TRUE(EventLoop::runUntil([&] { return received_.size() == 2; }, 2s)); // one report at a time
    EXPECT_EQ(received_[1], Bytes(64, 2));
}

TEST_F(SimulatedTransportTest, CannotBeOpenedWhileSomethingIsInTheWay) {
    struct Row {
        bool BoardFaults::*fault;
        const char* word;
    };
    for (const Row& row : {Row{&BoardFaults::unplugged, "unplugged"}, Row{&BoardFaults::forbidden, "permission denied"},
                           Row{&BoardFaults::busy, "another program"}}) {
        make();
        troubles_.clear();
        board_->faults_.*row.fault = true;
        transport_->open();
        EXPECT_FALSE(transport_->isOpen());
        ASSERT_EQ(troubles_.size(), 1u);
        EXPECT_THAT(troubles_[0], HasSubstr(row.word));
        EXPECT_EQ(board_->links, 0);
        board_->faults_.*row.fault = false;
        transport_->open();
        EXPECT_TRUE(transport_->isOpen());
    }
}

TEST_F(SimulatedTransportTest, IsCutWhenUnplugged) {
    make();
    transport_->open();
    board_->faults_.unplugged = true;
    transport_->write(Bytes{1});
    EXPECT_TRUE(board_->taken.empty());
    ASSERT_TRUE(EventLoop::runUntil([&] { return !troubles_.empty(); }, 1s));
    EXPECT_FALSE(transport_->isOpen());
    EventLoop::runFor(20ms);
    EXPECT_EQ(troubles_.size(), 1u);
}

TEST_F(SimulatedTransportTest, AStalledLinkKeepsWhatItGets) {
    make();
    transport_->open();
    board_->faults_.stalled = true;
    board_->toGive = {{1}};
    transport_->write(Bytes(18));
    transport_->write(Bytes(18));
    EventLoop::runFor(20ms);
    EXPECT_EQ(transport_->unsent(), 36u);
    EXPECT_TRUE(board_->taken.empty());
    EXPECT_TRUE(received_.empty());
    EXPECT_TRUE(transport_->isOpen());
    board_->faults_.stalled = false;
    ASSERT_TRUE(EventLoop::runUntil([&] { return transport_->unsent() == 0 && !received_.empty(); }, 1s));
    EXPECT_EQ(board_->taken.size(), 36u);
}

TEST_F(SimulatedTransportTest, LosesAndBreaksItsShareOfBytes) {
    constexpr std::size_t kCount = 20'000;
    make(false, {{"drop", "0.1"}});
    transport_->open();
    transport_->write(Bytes(kCount, 0x40));
    // Five standard deviations of a binomial share.
    EXPECT_NEAR(static_cast<double>(board_->taken.size()), 0.9 * kCount, 5 * std::sqrt(kCount * 0.1 * 0.9));

    make(false, {{"noise", "0.05"}});
    transport_->open();
    // The board's own faults are the board's work: done here too, they would be twice as bad.
    board_->faults_.noise = 0.5;
    board_->faults_.drop = 0.5;
    transport_->write(Bytes(kCount, 0x40));
    ASSERT_EQ(board_->taken.size(), kCount);
    const auto broken = static_cast<double>(kCount - std::ranges::count(board_->taken, 0x40));
    EXPECT_NEAR(broken, 0.05 * kCount, 5 * std::sqrt(kCount * 0.05 * 0.95));
    board_->toGive = {Bytes(kCount, 0x40)};
    ASSERT_TRUE(EventLoop::runUntil([&] { return !received_.empty(); }, 1s));
    EXPECT_NEAR(static_cast<double>(kCount - std::ranges::count(all(), 0x40)), 0.05 * kCount,
                5 * std::sqrt(kCount * 0.05 * 0.95));
}

TEST_F(SimulatedTransportTest, JitterDelaysButKeepsTheOrder) {
    make(false, {{"jitter", "50"}});
    transport_->open();
    Bytes sent;
    for (std::uint8_t i = 0; i < 100; ++i) {
        sent.push_back(i);
        transport_->write(Bytes{i});
    }
    const Microseconds begin = now_;
    EXPECT_LT(board_->taken.size(), 20u);
    EXPECT_EQ(transport_->unsent(), 0u); // on their way
    now_ += 50ms;
    ASSERT_TRUE(EventLoop::runUntil([&] { return board_->taken.size() == sent.size(); }, 1s));
    EXPECT_EQ(board_->taken, sent);
    for (const Microseconds time : board_->times) EXPECT_LE(time, begin + 50ms);
}

TEST_F(SimulatedTransportTest, RefusesOptionsItDoesNotUnderstand) {
    using Options = std::map<std::string, std::string>;
    for (const Options& options :
         {Options{{"jiter", "5"}}, Options{{"jitter", "much"}}, Options{{"drop", "1.5"}}, Options{{"noise", "nan"}},
          Options{{"drop", ""}}, Options{{"jitter", "-1"}}, Options{{"jitter", "5ms"}}, Options{{"noise", "inf"}}})
        EXPECT_THROW(make(false, options), InvalidInput) << options.begin()->first << '=' << options.begin()->second;
}

} // namespace
} // namespace lumorph
