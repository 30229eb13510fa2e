#include "devices/transport/hid_transport.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "devices/simulator/pty.h"
#include "devices/transport/found_devices.h"
#include "devices/transport/link_keeper.h"
#include "tests/devices/event_loop.h"
#include "tests/devices/hid/fake_hidapi.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

const HidAddress kLobot{0x0483, 0x5750, "LOBOT"};

class HidTransportTest : public testing::Test {
protected:
    HidTransportTest() { fakeHidBus().devices.clear(); }
    ~HidTransportTest() override {
        transport_.reset();
        EXPECT_EQ(fakeHidBus().open, 0); // nothing stays open
    }
    static FakeHidDevice& plugIn(FakeHidDevice device = {}) {
        const std::scoped_lock lock(fakeHidBus().mutex);
        return fakeHidBus().devices.emplace_back(std::move(device));
    }
    /// Does something to a device while its transport may look at it.
    template <class Change> static auto with(FakeHidDevice& device, const Change& change) {
        const std::scoped_lock lock(fakeHidBus().mutex);
        return change(device);
    }
    void make(const HidAddress& address = kLobot) {
        transport_ = makeHidTransport(
            address, {[this] { ++opened_; }, [this](auto bytes) { received_.emplace_back(bytes.begin(), bytes.end()); },
                      [this](const LinkTrouble& why) { troubles_.push_back(why); }});
    }
    LinkTrouble troubleAtOpening(const HidAddress& address = kLobot) {
        make(address);
        troubles_.clear();
        transport_->open();
        EXPECT_EQ(troubles_.empty(), transport_->isOpen());
        return troubles_.empty() ? LinkTrouble{} : troubles_.front();
    }

    EventLoop loop_;
    int opened_ = 0;
    std::vector<Bytes> received_;
    std::vector<LinkTrouble> troubles_;
    std::unique_ptr<Transport> transport_;
};

TEST_F(HidTransportTest, WritesReportsOf65BytesAndReads64) {
    FakeHidDevice& board = plugIn();
    make();
    transport_->write(Bytes{1}); // not open
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    EXPECT_EQ(opened_, 1);
    EXPECT_EQ(transport_->identity(), "S1");
    EXPECT_EQ(transport_->product(), "LOBOT xArm");

    // Servo 1 to 2000 in 1000 ms, as its maker writes it.
    const Bytes move{0x55, 0x55, 0x08, 0x03, 0x01, 0xE8, 0x03, 0x01, 0xD0, 0x07};
    transport_->write(move);
    ASSERT_TRUE(EventLoop::runUntil([&] { return transport_->unsent() == 0; }, 2s));
    const auto written = with(board, [](const FakeHidDevice& device) { return device.written; });
    ASSERT_EQ(written.size(), 1u);
    Bytes expected(65, 0);
    std::copy(move.begin(), move.end(), expected.begin() + 1);
    EXPECT_EQ(written[0], expected);

    Bytes first(64, 0x11);
    Bytes second(64, 0x22);
    with(board, [&](FakeHidDevice& device) { device.toRead = {first, second, {0x55, 0x55}}; });
    ASSERT_TRUE(EventLoop::runUntil([&] { return received_.size() == 3; }, 2s));
    EXPECT_EQ(received_[0], first);
    EXPECT_EQ(received_[1], second);
    EXPECT_EQ(received_[2], (Bytes{0x55, 0x55})); // a short one stays short
    EXPECT_TRUE(troubles_.empty());
}

// hidapi keeps its descriptor to itself, so the failsafe process has the node opened once more.
TEST_F(HidTransportTest, SharesItsNodeWhereThereIsOne) {
    FakeHidDevice& board = plugIn();
    make();
    transport_->open();
    EXPECT_EQ(transport_->shared().descriptor, -1) << "hidapi's path is no file";
    transport_->close();

    const Pty node;
    with(board, [&](FakeHidDevice& device) { device.path = node.path(); });
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    EXPECT_EQ(transport_->shared().report, 64U);
    const Bytes report(65, 7);
    ASSERT_EQ(::write(transport_->shared().descriptor, report.data(), report.size()), 65);
    node.waitForBytes(5s);
    EXPECT_EQ(node.receive(), report);
    transport_->close();
    EXPECT_EQ(transport_->shared().descriptor, -1);
}

TEST_F(HidTransportTest, RefusesWhatDoesNotFitIntoAReport) {
    plugIn();
    make();
    transport_->open();
    transport_->write(Bytes(64, 1));
    EXPECT_THROW(transport_->write(Bytes(65, 1)), InvalidInput);
}

TEST_F(HidTransportTest, NoticesThatItWasUnpluggedOnceAndOpensAgain) {
    FakeHidDevice& board = plugIn();
    make();
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    with(board, [](FakeHidDevice& device) { device.unplugged = true; });
    ASSERT_TRUE(EventLoop::runUntil([&] { return !transport_->isOpen(); }, 1s));
    EventLoop::runFor(30ms);
    ASSERT_EQ(troubles_.size(), 1u);
    EXPECT_THAT(troubles_[0].why, HasSubstr("LOBOT xArm broke off"));
    transport_->write(Bytes{1}); // dropped
    transport_->open();
    ASSERT_EQ(troubles_.size(), 2u);
    EXPECT_THAT(troubles_[1].why, HasSubstr("there is no USB device 0483:5750"));

    with(board, [](FakeHidDevice& device) {
        device.unplugged = false;
        device.path = "/dev/hidraw-none7"; // it comes back under another name
        device.toRead = {{9}};
    });
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    ASSERT_TRUE(EventLoop::runUntil([&] { return received_.size() == 1; }, 2s));
    EXPECT_EQ(troubles_.size(), 2u);
}

TEST_F(HidTransportTest, AnotherBoardIsNotTakenForTheOneThatLeft) {
    FakeHidDevice& board = plugIn();
    make();
    transport_->open();
    with(board, [](FakeHidDevice& device) { device.unplugged = true; });
    ASSERT_TRUE(EventLoop::runUntil([&] { return !transport_->isOpen(); }, 1s));
    plugIn({.path = "/dev/hidraw-none1", .serialNumber = L"S2"});
    transport_->open();
    EXPECT_FALSE(transport_->isOpen());
    with(board, [](FakeHidDevice& device) { device.unplugged = false; });
    transport_->open(); // both are there, and it knows its own
    EXPECT_TRUE(transport_->isOpen());
    EXPECT_EQ(transport_->identity(), "S1");
}

TEST_F(HidTransportTest, DoesNotOpenWhatHasTheIdsAlone) {
    plugIn({.productText = L"STM32 Joystick"});
    const LinkTrouble trouble = troubleAtOpening();
    EXPECT_EQ(trouble.why, "the USB device 0483:5750 calls itself \"STM32 Joystick\", not \"LOBOT\"");
    EXPECT_FALSE(trouble.remedy.empty());
    plugIn({.path = "/dev/hidraw-none1", .serialNumber = L"S2", .usages = 3});
    EXPECT_EQ(troubleAtOpening(), LinkTrouble{});
    EXPECT_EQ(transport_->product(), "LOBOT xArm");
    EXPECT_EQ(transport_->identity(), "S2");
}

TEST_F(HidTransportTest, DoesNotGuessBetweenTwo) {
    plugIn();
    plugIn({.path = "/dev/hidraw-none1", .serialNumber = L""});
    const LinkTrouble trouble = troubleAtOpening();
    EXPECT_EQ(trouble.why, "2 USB devices answer to 0483:5750");
    EXPECT_EQ(trouble.remedy, "unplug all but the one that is to move");
}

TEST_F(HidTransportTest, SaysWhyItCannotBeOpened) {
    EXPECT_THAT(troubleAtOpening().why, HasSubstr("there is no USB device 0483:5750"));
    FakeHidDevice& board = plugIn();
    board.openError = std::generic_category().message(EACCES);
    LinkTrouble trouble = troubleAtOpening();
    EXPECT_EQ(trouble.why, "permission denied on /dev/hidraw-none0");
    EXPECT_THAT(trouble.remedy, HasSubstr("packaging/udev/60-lumorph.rules"));
    board.openError = "Input/output error";
    trouble = troubleAtOpening();
    EXPECT_THAT(trouble.why, HasSubstr("Input/output error"));
    board.openError = std::generic_category().message(EBUSY);
    EXPECT_THAT(troubleAtOpening().why, HasSubstr("another program uses /dev/hidraw-none0"));
    EXPECT_EQ(opened_, 0);
}

TEST_F(HidTransportTest, AStuckDeviceHoldsUpNobody) {
    FakeHidDevice& board = plugIn();
    make();
    transport_->open();
    with(board, [](FakeHidDevice& device) { device.deafForNow = true; });
    for (std::uint8_t i = 0; i < 3; ++i) transport_->write(Bytes{i});
    EventLoop::runFor(20ms);
    EXPECT_EQ(transport_->unsent(), 3u * 64);
    transport_->close(); // while the first one hangs
    EXPECT_FALSE(transport_->isOpen());
    EXPECT_EQ(transport_->unsent(), 0u);
    with(board, [](FakeHidDevice& device) { device.deafForNow = false; });
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    transport_->write(Bytes{7});
    ASSERT_TRUE(EventLoop::runUntil([&] { return transport_->unsent() == 0; }, 2s));
    const auto written = with(board, [](const FakeHidDevice& device) { return device.written; });
    // What had not been begun was dropped; the one that hung comes through before or after.
    EXPECT_EQ(std::ranges::count_if(written, [](const auto& report) { return report[1] == 7; }), 1);
    EXPECT_TRUE(std::ranges::all_of(written, [](const auto& report) { return report[1] == 7 || report[1] == 0; }));
    EXPECT_LE(written.size(), 2u);
    EXPECT_TRUE(troubles_.empty());
}

TEST_F(HidTransportTest, ABoardThatAnotherLinkOfTheProgramHoldsIsNotOpenedTwice) {
    plugIn();
    make();
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    std::vector<LinkTrouble> troubles;
    int opened = 0;
    const auto second = makeHidTransport(
        kLobot, {[&] { ++opened; }, [](auto) {}, [&](const LinkTrouble& trouble) { troubles.push_back(trouble); }});
    second->open();
    EXPECT_EQ(opened, 0);
    ASSERT_EQ(troubles.size(), 1u);
    EXPECT_THAT(troubles[0].why, HasSubstr("still takes the servos of LOBOT xArm to rest"));
    EXPECT_EQ(fakeHidBus().open, 1);
    transport_->close();
    second->open();
    EXPECT_EQ(opened, 1);
}

TEST_F(HidTransportTest, IsNotBusyWhileNothingHappens) {
    plugIn();
    make();
    transport_->open();
    fakeHidBus().reads = 0;
    EventLoop::runFor(200ms);
    transport_->close();
    EXPECT_GT(fakeHidBus().reads, 0);
    EXPECT_LT(fakeHidBus().reads, 200);
}

TEST_F(HidTransportTest, AKeeperBringsItBack) {
    FakeHidDevice& board = plugIn();
    LinkWorld world;
    world.makeTransport = [](const DeviceAddress& address, Transport::Events events) {
        return makeHidTransport(std::get<HidAddress>(address), std::move(events));
    };
    world.serialPorts = [] { return std::vector<SerialPort>{}; };
    world.sight = sightOfNode;
    std::vector<LinkTrouble> lost;
    LinkKeeper keeper(kLobot, {[] {}, [](auto) {}, [&](const LinkTrouble& why) { lost.push_back(why); }}, world);
    const SteadyClock clock;
    keeper.start(clock.now());
    ASSERT_TRUE(keeper.isOpen());
    with(board, [](FakeHidDevice& device) { device.unplugged = true; });
    const auto tick = [&] { keeper.tick(clock.now()); };
    ASSERT_TRUE(EventLoop::runUntil([&] { return tick(), !keeper.isOpen(); }, 1s));
    (void)EventLoop::runUntil([&] { return tick(), false; }, 300ms);
    EXPECT_FALSE(keeper.isOpen());
    with(board, [](FakeHidDevice& device) { device.unplugged = false; });
    EXPECT_TRUE(EventLoop::runUntil([&] { return tick(), keeper.isOpen(); }, 3s));
}

TEST_F(HidTransportTest, IsFoundOnTheBus) {
    plugIn({.usages = 2});
    plugIn({.path = "/dev/hidraw-none1", .vendor = 0x046d, .product = 0xc31c, .productText = L"Keyboard"});
    std::vector<FoundDevice> hid;
    for (const FoundDevice& found : findRealDevices())
        if (found.address.starts_with("hid://")) hid.push_back(found);
    ASSERT_EQ(hid.size(), 1u);
    EXPECT_EQ(hid[0].address, "hid://0483:5750?product=LOBOT%20xArm");
    EXPECT_EQ(hid[0].identity, "S1");
    // The fake's node is not in /dev.
    EXPECT_THAT(hid[0].trouble.why, HasSubstr("/dev/hidraw-none0"));
}

} // namespace
} // namespace lumorph
