#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <QByteArray>
#include <QSerialPort>
#include <gtest/gtest.h>

#include "devices/controllers/servo_link.h"
#include "tests/devices/event_loop.h"
#include "tests/firmware/firmata_bytes.h"
#include "tests/firmware/live_board.h"
#include "tests/firmware/twelve.h"

namespace lumorph::firmware_test {
namespace {

using namespace std::chrono_literals;

template <typename Condition> bool comesTrue(Condition condition, std::chrono::milliseconds limit = 20s) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(5ms);
    }
    return true;
}

bool allAre(const LiveBoard& board, const DeviceProfile& profile, double stroke) {
    return std::all_of(profile.servos.begin(), profile.servos.end(), [&](const ServoSetup& servo) {
        return std::abs(board.widthNow(servo.channel) - pulseOf(servo, stroke)) <= 4.0;
    });
}

bool noneMoves(const LiveBoard& board, const DeviceProfile& profile) {
    return std::all_of(profile.servos.begin(), profile.servos.end(),
                       [&](const ServoSetup& servo) { return board.widthNow(servo.channel) == 0.0; });
}

TEST(FirmwareOnASerialPort, ASerialPortDrivesItAndItsEndLetsServosGo) {
    const EventLoop loop;
    LiveBoard board;
    QSerialPort port;
    port.setPortName(QString::fromStdString(board.path()));
    port.setBaudRate(57600);
    ASSERT_TRUE(port.open(QIODevice::ReadWrite)) << port.errorString().toStdString();
    const auto send = [&](const Bytes& bytes) {
        port.write(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()));
    };
    QByteArray heard;
    send({0xF0, 0x6D, 9, 0xF7});
    const QByteArray state = QByteArray::fromHex("f06e09010000f7");
    ASSERT_TRUE(EventLoop::runUntil(
        [&] {
            heard += port.readAll();
            return heard.contains(state);
        },
        20s));
    send(write(9, 1650));
    send(attach(9));
    ASSERT_TRUE(EventLoop::runUntil([&] { return board.widthNow(9) > 0.0; }, 20s));
    for (const Pulse& pulse : board.pulses()) EXPECT_NEAR(pulse.width, 1650.0, 4.0) << "from the first on";
    port.close();
    ASSERT_TRUE(comesTrue([&] { return board.widthNow(9) == 0.0; }));
}

class ServoLinkOnTheSketch : public testing::Test {
protected:
    ServoLinkOnTheSketch() : profile_(sixServos()) {
        profile_.address = "serial://" + board_.path() + "?baud=57600";
        profile_.staggerSeconds = 0.05;
        profile_.restOnExit = false;
        for (ServoSetup& servo : profile_.servos) servo.maxVelocity = 4.0;
    }
    bool isLive(ServoLink& link) {
        link.connect();
        if (!comesTrue([&] { return link.status().phase == LinkPhase::disarmed; })) return false;
        link.command(std::vector<double>(6, 0.25));
        link.arm(true);
        return comesTrue([&] { return link.status().phase == LinkPhase::live; });
    }
    EventLoop loop_; // the link's thread needs a program of Qt
    LiveBoard board_;
    DeviceProfile profile_;
};

TEST_F(ServoLinkOnTheSketch, TheStudioKnowsTheSketchAndDrivesIt) {
    ServoLink link(profile_, {});
    ASSERT_TRUE(isLive(link));
    EXPECT_EQ(link.status().controller.firmware, "LumorphTablet 1.2");
    EXPECT_TRUE(link.status().controller.traits.failsafe);
    EXPECT_FALSE(link.status().controller.traits.jumpsOnAttach);
    ASSERT_TRUE(comesTrue([&] { return allAre(board_, profile_, 0.25); }));
    for (const Pulse& pulse : board_.pulses())
        EXPECT_NEAR(pulse.width, 1250.0, 4.0) << "servos start where they are wanted, without a jump";
    link.command(std::vector<double>(6, 0.8));
    EXPECT_TRUE(comesTrue([&] { return allAre(board_, profile_, 0.8); }));
    EXPECT_TRUE(comesTrue([&] { return link.status().controller.volts.has_value(); }));
    EXPECT_NEAR(link.status().controller.volts.value_or(0.0), 7.7, 0.02);
    // It stands still for longer than the sketch waits: heartbeats keep it awake.
    const double rest = board_.now();
    ASSERT_TRUE(comesTrue([&] { return board_.now() > rest + 1200.0; }));
    EXPECT_TRUE(allAre(board_, profile_, 0.8));
    link.stop();
    EXPECT_TRUE(comesTrue([&] { return noneMoves(board_, profile_); }, 5s));
    EXPECT_EQ(link.status().phase, LinkPhase::stopped);
}

TEST_F(ServoLinkOnTheSketch, ACutLineLetsServosGo) {
    ServoLink link(profile_, {});
    ASSERT_TRUE(isLive(link));
    ASSERT_TRUE(comesTrue([&] { return allAre(board_, profile_, 0.25); }));
    board_.cutTheLine();
    EXPECT_TRUE(comesTrue([&] { return noneMoves(board_, profile_); }));
    EXPECT_TRUE(comesTrue([&] { return link.status().phase == LinkPhase::lost; }));
}

/// Greatest from one frame to the next, microseconds, of all pins; starts after a pause do not count.
double largestStep(const std::vector<Pulse>& pulses) {
    std::map<int, Pulse> before;
    double largest = 0.0;
    for (const Pulse& pulse : pulses) {
        const auto last = before.find(pulse.pin);
        if (last != before.end() && pulse.start - last->second.start < 30.0)
            largest = std::max(largest, std::abs(pulse.width - last->second.width));
        before[pulse.pin] = pulse;
    }
    return largest;
}

// Two cuts here; twenty in ten minutes where LUMORPH_SOAK is set.
TEST_F(ServoLinkOnTheSketch, TheLineIsCutAndMendedAgainAndAgain) {
    const bool soak = std::getenv("LUMORPH_SOAK") != nullptr;
    const int cuts = soak ? 20 : 2;
    const auto between = soak ? 26s : 1s;
    ServoLink link(profile_, {});
    ASSERT_TRUE(isLive(link));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    double slowest = 0.0;
    for (int cut = 0; cut < cuts; ++cut) {
        const auto until = std::chrono::steady_clock::now() + between;
        while (std::chrono::steady_clock::now() < until) {
            std::vector<double> strokes(6);
            for (double& stroke : strokes) stroke = any(random);
            link.command(strokes);
            std::this_thread::sleep_for(100ms);
        }
        board_.cutTheLine();
        ASSERT_TRUE(comesTrue([&] { return link.status().phase == LinkPhase::lost; })) << cut;
        ASSERT_TRUE(comesTrue([&] { return noneMoves(board_, profile_); })) << cut;
        const auto mended = std::chrono::steady_clock::now();
        board_.mendTheLine();
        ASSERT_TRUE(comesTrue([&] { return link.status().phase == LinkPhase::disarmed; })) << cut;
        slowest = std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - mended).count());
        EXPECT_TRUE(noneMoves(board_, profile_)) << "nothing starts by itself";
        link.arm(true);
        ASSERT_TRUE(comesTrue([&] { return link.status().phase == LinkPhase::live; })) << cut;
    }
    const std::vector<Pulse> pulses = board_.pulses();
    for (const Pulse& pulse : pulses) {
        ASSERT_GE(pulse.width, 1000.0);
        ASSERT_LE(pulse.width, 2000.0);
    }
    // 4 strokes of 1000 us a second are 80 us a frame, whenever the bytes arrive; and a microsecond is rounded.
    const double largest = largestStep(pulses);
    EXPECT_LE(largest, 81.0) << "the velocity limit";
    EXPECT_GT(largest, 30.0) << "it did move";
    if (soak) {
        EXPECT_LE(slowest, 3.0) << "seconds until it was found again";
    }
    std::printf("%d cuts, found again within %.2f s; %zu pulses, largest step %.1f us a frame of 80 allowed\n", cuts,
                slowest, pulses.size(), largest);
}

} // namespace
} // namespace lumorph::firmware_test
