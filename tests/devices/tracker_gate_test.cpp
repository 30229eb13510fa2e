#include <fstream>
#include <set>
#include <sstream>

#include <QVariant>
#include <QtEndian>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/trackers/udp_port.h"
#include "tests/devices/running_tracker.h"

// What a tracker hears while the user has not opened it to the network, as the kernel's own tables tell it.

namespace lumorph {
namespace {

using test::freePort;
using test::loopback;
using test::TestServer;
using ::testing::IsEmpty;

class TrackerGate : public test::RunningTracker {};

/// As Linux prints the bytes of an address in its tables.
std::uint32_t rawOf(const QHostAddress& address) { return qToBigEndian<quint32>(address.toIPv4Address()); }

/// Interfaces on which anybody on this machine has joined the group.
std::set<std::string> interfacesThatJoined(const QHostAddress& group) {
    std::set<std::string> interfaces;
    std::ifstream file("/proc/net/igmp");
    std::string line, name;
    std::getline(file, line); // headings
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string first;
        words >> first;
        if (line.empty() || line[0] != '\t') { // its number, its name, and its groups below
            words >> name;
            if (name.ends_with(':')) name.pop_back();
        } else if (std::stoul(first, nullptr, 16) == rawOf(group)) {
            interfaces.insert(name);
        }
    }
    return interfaces;
}

/// Local addresses of the sockets at a UDP port.
std::set<std::uint32_t> addressesBoundAt(quint16 port) {
    std::set<std::uint32_t> addresses;
    for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
        std::ifstream file(table);
        std::string line, slot, local;
        std::getline(file, line); // headings
        while (std::getline(file, line)) {
            std::istringstream(line) >> slot >> local;
            const std::size_t colon = local.find(':');
            if (std::stoul(local.substr(colon + 1), nullptr, 16) != port) continue;
            // One of IPv6 is longer, and would be none that we want.
            addresses.insert(colon == 8 ? static_cast<std::uint32_t>(std::stoul(local.substr(0, 8), nullptr, 16))
                                        : ~0U);
        }
    }
    return addresses;
}

/// A group that no other test joins.
QHostAddress ownGroup(int number) {
    const auto process = QCoreApplication::applicationPid();
    return QHostAddress(QString("239.%1.%2.%3").arg(77 + number).arg(process / 256 % 256).arg(process % 256));
}

/// An interface for multicast that is not loopback; none where there is no network.
QNetworkInterface networkInterface() {
    for (const QNetworkInterface& candidate : QNetworkInterface::allInterfaces()) {
        const auto flags = candidate.flags();
        if (!flags.testFlag(QNetworkInterface::IsUp) || !flags.testFlag(QNetworkInterface::CanMulticast)) continue;
        if (flags.testFlag(QNetworkInterface::IsLoopBack)) continue;
        for (const QNetworkAddressEntry& entry : candidate.addressEntries())
            if (entry.ip().protocol() == QAbstractSocket::IPv4Protocol) return candidate;
    }
    return {};
}

TEST_F(TrackerGate, WhileClosedAGroupIsJoinedOnLoopbackAloneWhateverTheAddressSays) {
    const QHostAddress group = ownGroup(0);
    const std::string words = "multicast=" + group.toString().toStdString() + "&data=" + std::to_string(freePort());
    std::string local = "127.0.0.1";
    for (const QHostAddress& own : ownAddresses())
        if (!own.isLoopback()) local = own.toString().toStdString();
    for (const std::string& uri : {"natnet://127.0.0.1?" + words, "natnet://203.0.113.5?" + words,
                                   "natnet://" + local + "?" + words + "&local=" + local}) {
        SCOPED_TRACE(uri);
        const auto tracker = open(uri);
        EXPECT_EQ(interfacesThatJoined(group), std::set<std::string>{loopback().name().toStdString()});
    }
    EXPECT_THAT(interfacesThatJoined(group), IsEmpty());
}

TEST_F(TrackerGate, WhileOpenAGroupIsJoinedWhereTheSystemChoosesOrTheAddressSays) {
    const QHostAddress group = ownGroup(0), usual = ownGroup(1);
    QUdpSocket socket;
    ASSERT_TRUE(socket.bind(QHostAddress::AnyIPv4, 0));
    if (!socket.joinMulticastGroup(usual)) GTEST_SKIP() << "no network here: " << socket.errorString().toStdString();
    const std::string uri = "natnet://127.0.0.1?command=" + std::to_string(freePort()) +
                            "&multicast=" + group.toString().toStdString() + "&data=" + std::to_string(freePort());
    {
        const auto tracker = open(uri, true);
        EXPECT_EQ(interfacesThatJoined(group), interfacesThatJoined(usual));
    }
    const auto tracker = open(uri + "&local=127.0.0.1", true);
    EXPECT_EQ(interfacesThatJoined(group), std::set<std::string>{loopback().name().toStdString()});
}

TEST_F(TrackerGate, WhileClosedNothingComesFromANetworkEvenWhereAnotherProgramHasJoined) {
    const QHostAddress group = ownGroup(0);
    const quint16 data = freePort();
    TestServer server({3, 1}, true);
    const auto tracker = open("natnet://127.0.0.1?version=3.1&command=" + server.port() +
                              "&multicast=" + group.toString().toStdString() + "&data=" + std::to_string(data));
    server.socket().setMulticastInterface(loopback());

    // Somebody whom the gate would let through sends on the network, and a program listens there. No packet leaves us.
    const QNetworkInterface network = networkInterface();
    TestServer outside({3, 1}, true, QHostAddress::AnyIPv4);
    QUdpSocket other;
    const bool isNetwork = network.isValid() &&
                           other.bind(group, data, QUdpSocket::ShareAddress | QUdpSocket::ReuseAddressHint) &&
                           other.joinMulticastGroup(group, network);
    outside.socket().setMulticastInterface(network);
    outside.socket().setSocketOption(QAbstractSocket::MulticastTtlOption, QVariant(0));
    int number = 0;
    ASSERT_TRUE(waitFor([&] {
        server.serve();
        const auto frameOf = [&](int id) { return server.frame(++number, {{id, {}, {1, 0, 0, 0}, 0.0F, true}}); };
        if (isNetwork) outside.sendTo(frameOf(66), group, data);
        server.sendTo(frameOf(7), group, data);
        return frames().size() >= 10;
    })) << tracker->status().advice;
    for (const TrackerFrame& frame : frames()) EXPECT_EQ(frame.bodies.at(0).id, 7) << "it came from the network";
    if (!isNetwork) GTEST_SKIP() << "there is no network here; only loopback was tried";
    bool isHeardThere = false;
    while (other.hasPendingDatagrams())
        isHeardThere |= other.receiveDatagram().senderPort() == outside.socket().localPort();
    EXPECT_TRUE(isHeardThere) << "this is a real test";
}

TEST_F(TrackerGate, AGroupIsJoinedNowhereWhereTheNetworkThatIsMeantIsMissing) {
    const QHostAddress group = ownGroup(0);
    UdpPort port(UdpBinding{QHostAddress::LocalHost}, [](std::span<const std::byte>, const QHostAddress&, quint16) {});
    EXPECT_THROW(port.join(group, QHostAddress("203.0.113.7")), DeviceError);
    EXPECT_THAT(interfacesThatJoined(group), IsEmpty());
}

TEST_F(TrackerGate, WhileClosedEverySocketIsBoundToLoopbackWhateverTheAddressSays) {
    const std::uint32_t here = rawOf(QHostAddress(QHostAddress::LocalHost));
    for (const char* where : {"127.0.0.1", "0.0.0.0", "192.168.0.5"})
        for (const char* scheme : {"opentrack://", "osc://"}) {
            const quint16 port = freePort();
            const std::string uri = scheme + std::string(where) + ":" + std::to_string(port);
            SCOPED_TRACE(uri);
            const auto tracker = open(uri);
            EXPECT_EQ(addressesBoundAt(port), std::set<std::uint32_t>{here});
        }
    TestServer server({3, 1});
    const quint16 data = freePort();
    const auto tracker =
        open("natnet://127.0.0.1?mode=unicast&command=" + server.port() + "&data=" + std::to_string(data));
    EXPECT_EQ(addressesBoundAt(data), std::set<std::uint32_t>{here});
    ASSERT_TRUE(waitFor([&] {
        server.serve();
        return server.client() != 0;
    }));
    EXPECT_EQ(addressesBoundAt(server.client()), std::set<std::uint32_t>{here});
}

TEST_F(TrackerGate, WhileOpenPacketsOfAllNetworksAreTaken) {
    const std::uint32_t anywhere = rawOf(QHostAddress(QHostAddress::AnyIPv4));
    for (const char* scheme : {"opentrack://", "osc://"}) {
        const quint16 port = freePort();
        const auto tracker = open(scheme + ("127.0.0.1:" + std::to_string(port)), true);
        EXPECT_EQ(addressesBoundAt(port), std::set<std::uint32_t>{anywhere});
    }
}

TEST_F(TrackerGate, OnlyThisMachineMaySendUnlessTheUserOpensTheWay) {
    const PacketGate closed(false);
    EXPECT_TRUE(closed.lets(QHostAddress("127.0.0.1")));
    EXPECT_TRUE(closed.lets(QHostAddress("127.3.2.1")));
    for (const QHostAddress& own : ownAddresses()) EXPECT_TRUE(closed.lets(own)) << own.toString().toStdString();
    EXPECT_FALSE(closed.lets(QHostAddress("203.0.113.5")));
    EXPECT_FALSE(closed.lets(QHostAddress("8.8.8.8")));
    EXPECT_TRUE(PacketGate(true).lets(QHostAddress("203.0.113.5")));
}

} // namespace
} // namespace lumorph
