#pragma once

#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <QCoreApplication>
#include <QNetworkDatagram>
#include <QNetworkInterface>
#include <QUdpSocket>

#include <gtest/gtest.h>

#include "devices/protocol/natnet_writer.h"
#include "devices/trackers/tracker.h"

namespace lumorph::test {

inline constexpr std::uint64_t kHertz = 10'000'000;
inline constexpr std::uint64_t kServerAhead = 123'456 * kHertz;

inline std::uint64_t serverTicks(Microseconds time) {
    return kServerAhead + static_cast<std::uint64_t>(time.count()) * (kHertz / 1'000'000);
}

/// A port that is free, as well as that can be known.
inline quint16 freePort() {
    QUdpSocket socket;
    EXPECT_TRUE(socket.bind(QHostAddress::LocalHost, 0));
    return socket.localPort();
}

inline QNetworkInterface loopback() {
    for (const QNetworkInterface& candidate : QNetworkInterface::allInterfaces())
        if (candidate.flags().testFlag(QNetworkInterface::IsLoopBack)) return candidate;
    return {};
}

/// A NatNet server at a port that the system chooses; answers while it is looked after.
class TestServer {
public:
    explicit TestServer(natnet::Version version, bool multicast = false,
                        const QHostAddress& local = QHostAddress::LocalHost)
        : version_(version), writer_(version) {
        EXPECT_TRUE(socket_.bind(local, 0));
        info_ = {"Motive", {2, 1, 0, 0}, version, {}};
        if (version.major >= 3) info_.connection = natnet::Connection{kHertz, 1511, multicast, {239, 255, 42, 99}};
    }
    /// The port that asked last; 0 while nobody did.
    [[nodiscard]] quint16 client() const { return client_; }
    [[nodiscard]] std::string port() const { return std::to_string(socket_.localPort()); }
    [[nodiscard]] int count(natnet::Message message) const { return counts_[static_cast<std::size_t>(message)]; }

    void serve() {
        while (socket_.hasPendingDatagrams()) {
            const QNetworkDatagram datagram = socket_.receiveDatagram();
            const QByteArray data = datagram.data();
            const natnet::Packet packet =
                natnet::readPacket(std::as_bytes(std::span(data.constData(), static_cast<std::size_t>(data.size()))));
            client_ = static_cast<quint16>(datagram.senderPort());
            ++counts_[static_cast<std::size_t>(packet.message)];
            if (packet.message == natnet::Message::connect) send(writer_.serverInfo(info_));
            if (packet.message == natnet::Message::requestModels) send(writer_.models(models));
            if (packet.message == natnet::Message::echoRequest) {
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
    natnet::Version version_;
    NatNetWriter writer_;
    natnet::ServerInfo info_;
    QUdpSocket socket_;
    quint16 client_ = 0;
    std::array<int, 128> counts_{};
};

/// Trackers in their threads, and what they deliver.
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

    std::unique_ptr<Tracker> open(const std::string& uri, bool openToNetwork = false) {
        TrackerOptions options;
        options.openToNetwork = openToNetwork;
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

} // namespace lumorph::test
