#include "devices/trackers/tracker.h"

#include <bit>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/running_tracker.h"

namespace lumorph {
namespace {

using natnet::Message;
using natnet::Version;
using test::freePort;
using test::loopback;
using test::RunningTracker;
using test::TestServer;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

natnet::Model named(std::int32_t id, const std::string& name) {
    return {natnet::Model::Kind::rigidBody, name, id, {{name, id, -1, {}}}, {}};
}

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
    server.socket().setMulticastInterface(loopback());
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

TEST_F(RunningTracker, OscTellsOfRotationsThatItRefusesAndGoesOnWithPositions) {
    const quint16 port = freePort();
    const auto tracker = open("osc://127.0.0.1:" + std::to_string(port));
    const auto put = [](std::vector<std::byte>& bytes, std::string_view text) {
        for (const char c : text) bytes.push_back(std::byte(c));
    };
    const auto putNumber = [](std::vector<std::byte>& bytes, std::uint32_t number) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::byte(number >> shift));
    };
    std::vector<std::byte> bundle;
    put(bundle, std::string_view("#bundle\0\0\0\0\0\0\0\0\1", 16));
    for (const auto& [address, value] :
         {std::pair{std::string_view("/tracking/trackers/head/rotation\0\0\0\0,fff\0\0\0\0", 44), 1e6F},
          std::pair{std::string_view("/tracking/trackers/head/position\0\0\0\0,fff\0\0\0\0", 44), 2.0F}}) {
        putNumber(bundle, 56);
        put(bundle, address);
        for (int axis = 0; axis < 3; ++axis) putNumber(bundle, std::bit_cast<std::uint32_t>(value));
    }
    ASSERT_TRUE(waitFor([&] {
        sendTo(port, bundle);
        return tracker->status().advice.find("Poses arrive") != std::string::npos;
    })) << tracker->status().advice;
    EXPECT_THAT(tracker->status().lastRejected,
                HasSubstr("'/tracking/trackers/head/rotation': a number in it is out of range"));
    EXPECT_EQ(frames().front().bodies.at(0).name, "head");
    EXPECT_EQ(frames().front().bodies.at(0).pose.position, glm::dvec3(2, 2, -2));
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

} // namespace
} // namespace lumorph
