#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/transport/bluetooth_transport.h"
#include "devices/transport/bluetooth_trouble.h"
#include "devices/transport/discovery.h"
#include "tests/devices/pty.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST(Bluetooth, SaysInPlainWordsWhatIsInTheWay) {
    const std::string mac = "98:D3:31:F4:12:AB";
    struct Row {
        BluetoothObstacle obstacle;
        const char* why;
        const char* remedy;
    };
    const Row rows[] = {
        {BluetoothObstacle::noAdapter, "no Bluetooth adapter", "plug in"},
        {BluetoothObstacle::switchedOff, "switched off", "switch it on"},
        {BluetoothObstacle::notAllowed, "may not use Bluetooth", "usermod -aG bluetooth"},
        {BluetoothObstacle::notPaired, "98:D3:31:F4:12:AB is not paired", "1234 or 0000"},
        {BluetoothObstacle::outOfRange, "98:D3:31:F4:12:AB does not answer", "nearer"},
        {BluetoothObstacle::noSerialPort, "98:D3:31:F4:12:AB does not answer as a serial port", "HC-06"},
        {BluetoothObstacle::brokenOff, "link to 98:D3:31:F4:12:AB broke off", "power"},
    };
    for (const Row& row : rows) {
        const LinkTrouble trouble = bluetoothTrouble(row.obstacle, mac);
        EXPECT_THAT(trouble.why, HasSubstr(row.why));
        EXPECT_THAT(trouble.remedy, HasSubstr(row.remedy));
    }
}

TEST(Bluetooth, WithoutAnAdapterALinkFailsCleanly) {
    if (hasBluetoothAdapter()) GTEST_SKIP() << "this computer has a Bluetooth adapter";
    const EventLoop loop;
    std::vector<LinkTrouble> troubles;
    int opened = 0;
    const auto transport =
        makeBluetoothTransport({"98:D3:31:F4:12:AB"}, {[&] { ++opened; }, [](auto) {},
                                                       [&](const LinkTrouble& why) { troubles.push_back(why); }});
    for (std::size_t attempt = 1; attempt <= 2; ++attempt) {
        transport->open();
        ASSERT_TRUE(EventLoop::runUntil([&] { return troubles.size() == attempt; }, 2s));
        EXPECT_EQ(troubles.back(), bluetoothTrouble(BluetoothObstacle::noAdapter, {}));
        EXPECT_FALSE(transport->isOpen());
    }
    const std::vector<std::uint8_t> bytes{1, 2};
    transport->write(bytes); // dropped
    EXPECT_EQ(transport->unsent(), 0u);
    transport->close();
    EventLoop::runFor(20ms);
    EXPECT_EQ(troubles.size(), 2u);
    EXPECT_EQ(opened, 0);
    EXPECT_EQ(transport->identity(), "98:D3:31:F4:12:AB");
}

TEST(Bluetooth, WithoutAnAdapterASearchEndsAndSaysWhy) {
    if (hasBluetoothAdapter()) GTEST_SKIP() << "this computer has a Bluetooth adapter";
    const EventLoop loop;
    std::vector<LinkTrouble> ends;
    int found = 0;
    {
        const BluetoothSearch search(
            {[&](const FoundDevice&) { ++found; }, [&](const LinkTrouble& why) { ends.push_back(why); }});
        EXPECT_TRUE(ends.empty()); // its owner does not hold it yet
        ASSERT_TRUE(EventLoop::runUntil([&] { return !ends.empty(); }, 2s));
    }
    EXPECT_EQ(ends.size(), 1u);
    EXPECT_THAT(ends[0].why, HasSubstr("no Bluetooth adapter"));
    {
        const BluetoothSearch gone(
            {[&](const FoundDevice&) { ++found; }, [&](const LinkTrouble& why) { ends.push_back(why); }});
    }
    EventLoop::runFor(20ms);
    EXPECT_EQ(ends.size(), 1u);
    EXPECT_EQ(found, 0);
}

} // namespace
} // namespace lumorph
