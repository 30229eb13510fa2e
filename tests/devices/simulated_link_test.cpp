#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/discovery.h"
#include "devices/transport/link_keeper.h"
#include "devices/transport/transport.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

class SimulatedLink : public testing::Test {
protected:
    void fail(const char* board, bool BoardFaults::*fault, bool isSo) {
        BoardFaults faults = bench_.board(board)->faults();
        faults.*fault = isSo;
        bench_.board(board)->setFaults(faults);
    }

    EventLoop loop_;
    std::shared_ptr<ManualClock> time_ = std::make_shared<ManualClock>();
    SimulatedBench bench_{time_};
};

TEST_F(SimulatedLink, AMaestroAnswersOverTheTransport) {
    Bytes received;
    const auto transport =
        makeTransport(parseDeviceAddress("sim://maestro"),
                      {[] {}, [&](auto bytes) { received.insert(received.end(), bytes.begin(), bytes.end()); },
                       [](const LinkTrouble&) {}},
                      &bench_);
    transport->open();
    ASSERT_TRUE(transport->isOpen());
    time_->advance(5s);                           // it has started
    transport->write(Bytes{0x84, 0, 0x70, 0x2E}); // channel 0 to 1500 us
    transport->write(Bytes{0xA1});                // errors: two bytes
    ASSERT_TRUE(EventLoop::runUntil([&] { return time_->advance(1ms), received.size() == 2; }, 2s));
    EXPECT_THAT(received, ElementsAre(0, 0));
    EXPECT_EQ(bench_.board("maestro")->servos()[0].pulse, 1500.0);
}

TEST_F(SimulatedLink, WhatIsNotThereIsRefusedInWords) {
    try {
        (void)makeTransport(parseDeviceAddress("sim://table"), {}, &bench_);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), HasSubstr("'table'"));
        EXPECT_THAT(error.remedy(), HasSubstr("tablet, uno, xarm, maestro"));
    }
    std::vector<LinkTrouble> troubles;
    const auto none =
        makeTransport(parseDeviceAddress("sim://tablet"),
                      {[] {}, [](auto) {}, [&](const LinkTrouble& why) { troubles.push_back(why); }}, nullptr);
    none->open();
    ASSERT_EQ(troubles.size(), 1u);
    EXPECT_EQ(troubles[0].why, "there are no simulated devices here");
    EXPECT_FALSE(none->isOpen());
}

TEST_F(SimulatedLink, EveryBoardIsFoundWithItsTrouble) {
    fail("uno", &BoardFaults::busy, true);
    std::vector<FoundDevice> boards = findDevices(&bench_);
    const std::size_t real = findDevices(nullptr).size();
    ASSERT_EQ(boards.size(), real + 4);
    boards.erase(boards.begin(), boards.begin() + static_cast<std::ptrdiff_t>(real)); // they come last
    std::vector<std::string> addresses;
    for (const FoundDevice& board : boards) addresses.push_back(board.address);
    EXPECT_THAT(addresses, ElementsAre("sim://tablet", "sim://uno", "sim://xarm", "sim://maestro"));
    EXPECT_EQ(boards[0].trouble, LinkTrouble{});
    EXPECT_THAT(boards[1].trouble.why, HasSubstr("another program"));
}

TEST_F(SimulatedLink, AKeeperFollowsThePanel) {
    int opened = 0;
    std::vector<std::string> lost;
    LinkKeeper keeper(parseDeviceAddress("sim://tablet?jitter=5"),
                      {[&] { ++opened; }, [](auto) {}, [&](const LinkTrouble& why) { lost.push_back(why.why); }},
                      &bench_);
    const auto runUntil = [&](const std::function<bool()>& isDone) {
        return EventLoop::runUntil([&] { return time_->advance(10ms), keeper.tick(time_->now()), isDone(); }, 30s);
    };
    keeper.start(time_->now());
    ASSERT_TRUE(keeper.isOpen());
    fail("tablet", &BoardFaults::unplugged, true);
    ASSERT_TRUE(runUntil([&] { return !keeper.isOpen(); }));
    const Microseconds later = time_->now() + 10s;
    ASSERT_TRUE(runUntil([&] { return time_->now() > later; }));
    EXPECT_EQ(lost.size(), 1u);
    fail("tablet", &BoardFaults::unplugged, false);
    const Microseconds back = time_->now();
    ASSERT_TRUE(runUntil([&] { return keeper.isOpen(); }));
    EXPECT_LE(time_->now() - back, 300ms);
    EXPECT_EQ(opened, 2);
}

TEST_F(SimulatedLink, AUsbBoardThatStartsAnewLeavesTheBusOneBehindAPortDoesNot) {
    for (const char* name : {"xarm", "tablet", "uno", "maestro"}) {
        int opened = 0;
        std::vector<std::string> lost;
        LinkKeeper keeper(parseDeviceAddress(std::string("sim://") + name),
                          {[&] { ++opened; }, [](auto) {}, [&](const LinkTrouble& why) { lost.push_back(why.why); }},
                          &bench_);
        keeper.start(time_->now());
        ASSERT_TRUE(keeper.isOpen()) << name;
        bench_.board(name)->reboot();
        const Microseconds later = time_->now() + 3s;
        ASSERT_TRUE(EventLoop::runUntil(
            [&] { return time_->advance(5ms), keeper.tick(time_->now()), time_->now() > later; }, 30s));
        EXPECT_TRUE(keeper.isOpen()) << name;
        const bool leaves = name == std::string("xarm");
        EXPECT_EQ(opened, leaves ? 2 : 1) << name;
        ASSERT_EQ(lost.size(), leaves ? 1U : 0U) << name;
        if (leaves) {
            EXPECT_THAT(lost[0], HasSubstr("gone from the USB"));
        }
    }
}

TEST_F(SimulatedLink, AKeeperTellsOfABoardThatIsNone) {
    std::vector<std::string> lost;
    LinkKeeper keeper(parseDeviceAddress("sim://table"),
                      {[] {}, [](auto) {}, [&](const LinkTrouble& why) { lost.push_back(why.why); }}, &bench_);
    keeper.start(time_->now());
    EXPECT_THAT(lost, ElementsAre("there is none of this name"));
}

} // namespace
} // namespace lumorph
