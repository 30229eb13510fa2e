#include "devices/trackers/tracker.h"

#include <bit>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

#include <QCoreApplication>
#include <QNetworkDatagram>
#include <QNetworkInterface>
#include <QUdpSocket>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/trackers/udp_port.h"
#include "tests/support/natnet_frames.h"
#include "tests/support/natnet_writer.h"

namespace lumorph {
namespace {

using natnet::Message;
using natnet::Version;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kHertz = 10'000'000;
constexpr std::uint64_t kServerAhead = 123'456 * kHertz;

std::uint64_t serverTicks(Microseconds time) {
    return kServerAhead + static_cast<std::uint64_t>(time.count()) * (kHertz / 1'000'000);
}

/// A port that is free, as well as that can be known.
quint16 freePort() {
    QUdpSocket socket;
    EXPECT_TRUE(socket.bind(QHostAddress::LocalHost, 0));
    return socket.localPort();
}

/// A NatNet server at a port that the system chooses; answers while it is looked after.
class TestServer {
public:
    explicit TestServer(Version version, bool multicast = false) : version_(version), writer_(version) {
        EXPECT_TRUE(socket_.bind(QHostAddress::LocalHost, 0));
        info_ = {"Motive", {2, 1, 0, 0}, version, {}};
        if (version.major >= 3) info_.connection = natnet::Connection{kHertz, 1511, multicast, {239, 255, 42, 99}};
    }
    [[nodiscard]] std::string port() const { return std::to_string(socket_.localPort()); }
    [[nodiscard]] int count(Message message) const { return counts_[static_cast<std::size_t>(message)]; }

    void serve() {
        while (socket_.hasPendingDatagrams()) {
            const QNetworkDatagram datagram = socket_.receiveDatagram();
            const QByteArray data = datagram.data();
            const natnet::Packet packet =
                natnet::readPacket(std::as_bytes(std::span(data.constData(), static_cast<std::size_t>(data.size()))));
            client_ = static_cast<quint16>(datagram.senderPort());
            ++counts_[static_cast<std::size_t>(packet.message)];
            if (packet.message == Message::connect) send(writer_.serverInfo(info_));
            if (packet.message == Message::requestModels) send(writer_.models(models));
            if (packet.message == Message::echoRequest) {
                std::uint64_t number = 0;
                std::memcpy(&number, packet.payload.data(), sizeof number);
                send(writer_.echo(number, serverTicks(SteadyClock().now())));
            }
        }
    }
    void send(const std::vector<std::byte>& bytes) { sendTo(bytes, QHostAddress::LocalHost, client_); }
    void sendTo(const std::vector<std::byte>& bytes, const QHostAddress& to, quint16 port) {
        socket_.writeDatagram(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()), to, port);
    }
    [[nodiscard]] std::vector<std::byte> frame(int number, const std::vector<natnet::RigidBody>& bodies) {
        natnet::Frame frame;
        frame.number = number;
        frame.bodies = bodies;
        if (version_.major < 3) frame.latency = 0.0F;
        frame.timestamp = 0.01 * number;
        if (version_.major >= 3) {
            frame.ticks.emplace();
            frame.ticks->exposure = serverTicks(SteadyClock().now() - Microseconds{5'000});
        }
        return writer_.frame(frame);
    }
    QUdpSocket& socket() { return socket_; }

    std::vector<natnet::Model> models;

private:
    Version version_;
    test::NatNetWriter writer_;
    natnet::ServerInfo info_;
    QUdpSocket socket_;
    quint16 client_ = 0;
    std::array<int, 128> counts_{};
};

natnet::Model named(std::int32_t id, const std::string& name) {
    return {natnet::Model::Kind::rigidBody, name, id, {{name, id, -1, {}}}, {}};
}

class RunningTracker : public ::testing::Test {
protected:
    void SetUp() override {
        if (QCoreApplication::instance() == nullptr) {
            static int count = 1;
            static char name[] = "test";
            static char* arguments[] = {name, nullptr};
            new QCoreApplication(count, arguments); // as long as the program
        }
    }

    std::unique_ptr<Tracker> open(const std::string& uri) {
        TrackerOptions options;
        options.onFrame = [this](const TrackerFrame& frame) {
            const std::scoped_lock lock(mutex_);
            frames_.push_back(frame);
        };
        return openTracker(uri, std::move(options));
    }
    std::vector<TrackerFrame> frames() {
        const std::scoped_lock lock(mutex_);
        return frames_;
    }
    /// Until it holds, or for ten seconds.
    template <typename Condition> static bool waitFor(Condition condition) {
        for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return condition();
    }

    static void sendTo(quint16 port, const std::vector<std::byte>& bytes) {
        QUdpSocket socket;
        socket.writeDatagram(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()),
                             QHostAddress::LocalHost, port);
    }
    static std::vector<std::byte> openTrackPacket(const std::array<double, 6>& numbers) {
        std::vector<std::byte> bytes(48);
        std::memcpy(bytes.data(), numbers.data(), 48);
        return bytes;
    }

private:
    std::mutex mutex_;
    std::vector<TrackerFrame> frames_;
};

TEST_F(RunningTracker, NatNetUnicastFromTheFirstWordToPosesWithTheirTimes) {
    for (const Version version : {Version{2, 10}, Version{3, 1}, Version{4, 1}}) {
        SCOPED_TRACE(version.major);
        TestServer server(version);
        server.models = {named(7, "glasses")};
        const auto tracker = open("natnet://127.0.0.1?mode=unicast&command=" + server.port());
        int number = 0;
        const bool all = waitFor([&] {
            server.serve();
            if (server.count(Message::connect) > 0)
                server.send(server.frame(
                    ++number, {{7, {1, 2, 3}, {1, 0, 0, 0}, 0.0F, true}, {8, {4, 5, 6}, {1, 0, 0, 0}, 0.0F, false}}));
            const TrackerStatus status = tracker->status();
            const bool named = !status.bodies.empty() && status.bodies[0].name == "glasses";
            return named && (version.major < 3 || status.latencyMilliseconds) && status.framesPerSecond > 3.0;
        });
        const TrackerStatus status = tracker->status();
        ASSERT_TRUE(all) << status.source << " | " << status.advice << " | " << status.lastRejected;
        EXPECT_EQ(status.source, "Motive 2.1 at 127.0.0.1, NatNet " + std::to_string(version.major) + "." +
                                     std::to_string(version.minor));
        EXPECT_EQ(status.verified, version.major == 2);
        EXPECT_TRUE(status.receiving);
        EXPECT_EQ(status.rejected, 0U);
        EXPECT_THAT(status.advice, IsEmpty());
        ASSERT_EQ(status.bodies.size(), 2U);
        EXPECT_EQ(status.bodies[0].pose.position, glm::dvec3(1, 2, 3));
        EXPECT_TRUE(status.bodies[0].valid);
        EXPECT_FALSE(status.bodies[1].valid) << "lost, with a stale pose";
        EXPECT_EQ(status.bodies[1].pose.position, glm::dvec3(4, 5, 6));
        if (version.major >= 3) {
            EXPECT_GT(status.latencyMilliseconds.value(), 3.0) << "exposed 5 ms before it was sent";
        }
        EXPECT_FALSE(frames().empty());
    }
}

TEST_F(RunningTracker, NatNetUnicastIsKeptAlive) {
    TestServer server({2, 10});
    const auto tracker = open("natnet://127.0.0.1?mode=unicast&command=" + server.port());
    EXPECT_TRUE(waitFor([&] {
        server.serve();
        if (server.count(Message::connect) > 0) server.send(server.frame(1, {}));
        return server.count(Message::keepAlive) >= 1;
    }));
    EXPECT_EQ(server.count(Message::connect), 1);
}

TEST_F(RunningTracker, NatNetMulticastJoinsTheGroupOnTheLocalAddress) {
    TestServer server({3, 1}, true);
    server.models = {named(7, "glasses")};
    const quint16 data = freePort();
    const QHostAddress group("239.255.42.99");
    std::unique_ptr<Tracker> tracker;
    try {
        tracker = open("natnet://127.0.0.1?local=127.0.0.1&command=" + server.port() + "&data=" + std::to_string(data));
    } catch (const DeviceError& error) {
        GTEST_SKIP() << "no multicast here: " << error.what();
    }
    for (const QNetworkInterface& candidate : QNetworkInterface::allInterfaces())
        if (candidate.flags().testFlag(QNetworkInterface::IsLoopBack)) server.socket().setMulticastInterface(candidate);
    int number = 0;
    EXPECT_TRUE(waitFor([&] {
        server.serve();
        server.sendTo(server.frame(++number, {{7, {1, 2, 3}, {1, 0, 0, 0}, 0.0F, true}}), group, data);
        const TrackerStatus status = tracker->status();
        return !status.bodies.empty() && status.bodies[0].name == "glasses";
    })) << tracker->status().advice;
    EXPECT_EQ(server.count(Message::keepAlive), 0);
}

TEST_F(RunningTracker, NatNetSaysWhyNothingArrives) {
    TestServer server({3, 1}, true); // it says that it sends by multicast
    const auto tracker = open("natnet://127.0.0.1?mode=unicast&command=" + server.port());
    EXPECT_TRUE(waitFor([&] {
        server.serve();
        return tracker->status().advice.find("sends by multicast") != std::string::npos;
    })) << tracker->status().advice;
    EXPECT_THAT(frames(), IsEmpty());
}

TEST_F(RunningTracker, AMissingLocalAddressIsToldAndWaitedFor) {
    const auto tracker = open("natnet://127.0.0.1?local=203.0.113.7");
    EXPECT_TRUE(waitFor([&] { return !tracker->status().advice.empty(); }));
    EXPECT_THAT(tracker->status().advice, HasSubstr("no address 203.0.113.7"));
    EXPECT_THAT(tracker->status().advice, HasSubstr("127.0.0.1"));
}

TEST_F(RunningTracker, AServerOnAnotherMachineNeedsAnOpenWay) {
    const auto tracker = open("natnet://203.0.113.5?mode=unicast");
    EXPECT_TRUE(waitFor([&] { return !tracker->status().advice.empty(); }));
    EXPECT_THAT(tracker->status().advice, HasSubstr("Open it to the network"));
}

TEST_F(RunningTracker, OpenTrackComesAsAHeadInMetres) {
    const quint16 port = freePort();
    const auto tracker = open("opentrack://127.0.0.1:" + std::to_string(port));
    ASSERT_TRUE(waitFor([&] {
        sendTo(port, openTrackPacket({10, 20, 60, 0, 0, 0}));
        return !frames().empty();
    }));
    const TrackerFrame frame = frames().front();
    ASSERT_EQ(frame.bodies.size(), 1U);
    EXPECT_EQ(frame.bodies[0].name, "head");
    EXPECT_NEAR(frame.bodies[0].pose.position.z, 0.6, 1e-12);
    EXPECT_EQ(tracker->status().source, "opentrack from 127.0.0.1");
}

TEST_F(RunningTracker, WrongPacketsAreCountedAndTold) {
    const quint16 port = freePort();
    const auto tracker = open("opentrack://127.0.0.1:" + std::to_string(port));
    EXPECT_TRUE(waitFor([&] {
        sendTo(port, std::vector<std::byte>(12));
        return tracker->status().advice.find("12 bytes instead of 48") != std::string::npos;
    })) << tracker->status().advice;
    const TrackerStatus status = tracker->status();
    EXPECT_THAT(status.advice, HasSubstr("from 127.0.0.1 port "));
    EXPECT_GT(status.rejected, 0U);
    EXPECT_THAT(status.lastRejected, HasSubstr("12 bytes instead of 48"));
    EXPECT_FALSE(status.receiving);
    EXPECT_THAT(frames(), IsEmpty());
}

TEST_F(RunningTracker, OscComesUnderTheNameOfItsTracker) {
    const quint16 port = freePort();
    const auto tracker = open("osc://127.0.0.1:" + std::to_string(port));
    std::vector<std::byte> message;
    for (const char c : std::string_view("/tracking/trackers/1/position\0\0\0,fff\0\0\0\0", 40))
        message.push_back(std::byte(c));
    for (const float value : {1.0F, 2.0F, 3.0F})
        for (int shift = 24; shift >= 0; shift -= 8)
            message.push_back(std::byte(std::bit_cast<std::uint32_t>(value) >> shift));
    ASSERT_TRUE(waitFor([&] {
        sendTo(port, message);
        return !frames().empty();
    })) << tracker->status().lastRejected;
    EXPECT_EQ(frames().front().bodies.at(0).name, "1");
    EXPECT_EQ(frames().front().bodies.at(0).pose.position, glm::dvec3(1, 2, -3));
}

TEST_F(RunningTracker, ASimulatedHeadMoves) {
    const auto tracker = open("sim://head?rate=200&latency=10");
    ASSERT_TRUE(waitFor([&] { return frames().size() > 20; }));
    EXPECT_NE(frames().front().bodies[0].pose, frames().back().bodies[0].pose);
    EXPECT_NEAR(tracker->status().latencyMilliseconds.value(), 10.0, 1e-9);
}

TEST_F(RunningTracker, APortThatIsTakenNamesTheProgramThatHasIt) {
    QUdpSocket other;
    ASSERT_TRUE(other.bind(QHostAddress::LocalHost, 0, QUdpSocket::DontShareAddress));
    const std::string port = std::to_string(other.localPort());
    for (const char* scheme : {"opentrack", "osc"}) {
        try {
            (void)open(scheme + ("://127.0.0.1:" + port));
            ADD_FAILURE() << "the port is taken";
        } catch (const DeviceError& error) {
            EXPECT_THAT(error.what(), HasSubstr("UDP port " + port));
            EXPECT_THAT(error.what(),
                        HasSubstr("(process " + std::to_string(QCoreApplication::applicationPid()) + ") has it"));
        }
    }
}

TEST_F(RunningTracker, OnlyThisMachineMaySendUnlessTheUserOpensTheWay) {
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
