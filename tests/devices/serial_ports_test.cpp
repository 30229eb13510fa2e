#include "devices/transport/serial_ports.h"

#include <gtest/gtest.h>

namespace lumorph {
namespace {

using Ports = std::vector<SerialPort>;

SerialPort arduino(const std::string& path, const std::string& serial) { return {path, serial, 0x2341, 0x0043, "Uno"}; }
SerialPort clone(const std::string& path) { return {path, "", 0x1a86, 0x7523, "USB Serial"}; }

TEST(PortMemory, TakesTheTypedPathWhileItKnowsNoMore) {
    PortMemory memory;
    EXPECT_EQ(memory.find("/dev/none3", {}), "/dev/none3");
    // A pseudo-terminal is in no list, and a port of the board itself has nothing but its name.
    memory.remember("/dev/pts/77", Ports{arduino("/dev/none0", "A")});
    EXPECT_EQ(memory.find("/dev/pts/77", Ports{}), "/dev/pts/77");
    memory.remember("/dev/noneS0", Ports{{"/dev/noneS0", "", 0, 0, ""}, {"/dev/noneS1", "", 0, 0, ""}});
    EXPECT_EQ(memory.find("/dev/noneS0", Ports{{"/dev/noneS1", "", 0, 0, ""}}), "/dev/noneS0");
}

TEST(PortMemory, FollowsTheSerialNumber) {
    PortMemory memory;
    memory.remember("/dev/none0", Ports{arduino("/dev/none0", "A"), arduino("/dev/none1", "B")});
    struct Row {
        const char* what;
        Ports ports;
        std::optional<std::string> expected;
    };
    const Row rows[] = {
        {"still there", {arduino("/dev/none0", "A")}, "/dev/none0"},
        {"another name", {arduino("/dev/none5", "A")}, "/dev/none5"},
        {"the other took its name", {arduino("/dev/none0", "B"), arduino("/dev/none1", "A")}, "/dev/none1"},
        {"only the other is left", {arduino("/dev/none0", "B")}, std::nullopt},
        {"nothing is left", {}, std::nullopt},
        {"same number, other maker", {{"/dev/none0", "A", 0x0403, 0x6001, ""}}, std::nullopt},
    };
    for (const Row& row : rows) EXPECT_EQ(memory.find("/dev/none0", row.ports), row.expected) << row.what;
    memory.forget();
    EXPECT_EQ(memory.find("/dev/none0", Ports{arduino("/dev/none0", "B")}), "/dev/none0");
}

TEST(PortMemory, FollowsTheIdsWhereThereIsNoSerialNumber) {
    PortMemory memory;
    memory.remember("/dev/none0", Ports{clone("/dev/none0")});
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none3"), arduino("/dev/none0", "A")}), "/dev/none3");
    // Two that may be it, and neither has its name: a guess could move the wrong servos.
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none3"), clone("/dev/none4")}), std::nullopt);
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none0"), clone("/dev/none4")}), "/dev/none0");
}

TEST(PortMemory, DoesNotTakeItsNeighbourForIt) {
    PortMemory memory;
    memory.remember("/dev/none0", Ports{clone("/dev/none0"), clone("/dev/none1")});
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none1")}), std::nullopt);
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none1"), clone("/dev/none2")}), "/dev/none2");
    // Both were unplugged; what comes now may be either.
    EXPECT_EQ(memory.find("/dev/none0", Ports{}), std::nullopt);
    EXPECT_EQ(memory.find("/dev/none0", Ports{clone("/dev/none1")}), "/dev/none1");
}

} // namespace
} // namespace lumorph
