#include "devices/controllers/servo_link.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <sched.h>

#include <QCoreApplication>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/thread_priority.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;

/// Links want an application; it need not run.
void needApplication() {
    static int count = 1;
    static char name[] = "servo_link_test";
    static char* names[] = {name, nullptr};
    static const std::unique_ptr<QCoreApplication> application =
        QCoreApplication::instance() ? nullptr : std::make_unique<QCoreApplication>(count, names);
}

bool waitFor(const std::function<bool()>& condition, std::chrono::milliseconds atMost = 10s) {
    const auto end = std::chrono::steady_clock::now() + atMost;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(2ms);
    }
    return condition();
}

DeviceProfile tabletProfile(const std::string& board = "tablet", int first = 2) {
    DeviceProfile profile;
    profile.address = "sim://" + board;
    profile.staggerSeconds = 0.02;
    profile.restOnExit = false;
    profile.servos = {{.channel = first}, {.channel = first + 1}, {.channel = first + 2}};
    for (ServoSetup& servo : profile.servos) servo.maxAcceleration = 20.0;
    return profile;
}

/// A link to a board of a bench, and what it said.
class ServoLinkTest : public testing::Test {
protected:
    ServoLinkTest() { needApplication(); }

    void open(const DeviceProfile& profile) {
        profile_ = profile;
        board_ = bench_.board(profile.address.substr(6));
        LinkOptions options;
        options.bench = &bench_;
        options.onWire = [this](std::span<const std::uint8_t> bytes, bool sent) {
            policy_ = ::sched_getscheduler(0);
            if (sent && faultsToCome_ > 0 && --faultsToCome_ >= 0) throw std::runtime_error("out of memory");
            const std::scoped_lock lock(mutex_);
            if (sent) sent_.insert(sent_.end(), bytes.begin(), bytes.end());
        };
        link_ = std::make_unique<ServoLink>(profile, options);
        link_->connect();
    }
    bool reaches(LinkPhase phase) {
        return waitFor([&] { return link_->status().phase == phase; });
    }
    /// Servos stand in the middle at first, and are told to start there.
    void goLive() {
        ASSERT_TRUE(reaches(LinkPhase::disarmed)) << said();
        link_->command(std::vector<double>(3, 0.5));
        link_->arm(true);
        ASSERT_TRUE(reaches(LinkPhase::live)) << said();
    }
    double pulse(std::size_t servo) { return board_->servos().at(servo).pulse; }
    bool allLimp() {
        return std::ranges::all_of(board_->servos(), [](const SimulatedServo& s) { return s.pulse == 0.0; });
    }
    bool arrives(std::size_t servo, double microseconds) {
        return waitFor([&] { return std::abs(board_->servos().at(servo).position - microseconds) < 3.0; });
    }
    template <typename Change> void fault(Change change) {
        BoardFaults faults = board_->faults();
        change(faults);
        board_->setFaults(faults);
    }
    std::string said() {
        for (const LinkEvent& event : link_->takeEvents()) said_ += event.text + " (" + event.remedy + ")\n";
        return said_;
    }
    int times(const std::string& words) {
        int count = 0;
        const std::string all = said();
        for (auto at = all.find(words); at != std::string::npos; at = all.find(words, at + 1)) ++count;
        return count;
    }
    bool hears(const std::string& words) {
        return waitFor([&] { return times(words) > 0; });
    }
    /// What the board itself saw. Threads are woken late on a busy machine, so twice the limit is what cannot be
    /// mistaken; the exact limit is that of the test without threads.
    void expectSoft(double atMostJump = 3.0) {
        for (const SimulatedServo& servo : board_->servos()) {
            EXPECT_LE(servo.fastest, 2.0 * 1000.0);
            EXPECT_LE(servo.largestJump, atMostJump);
            if (servo.pulse == 0.0) continue;
            EXPECT_GE(servo.pulse, 1000.0);
            EXPECT_LE(servo.pulse, 2000.0);
        }
    }

    SimulatedBench bench_;
    DeviceProfile profile_;
    std::shared_ptr<SimulatedBoard> board_;
    std::atomic<int> faultsToCome_ = 0; ///< of what is sent next, as if the link itself failed
    std::atomic<int> policy_ = -1;      ///< of the thread that sends
    std::mutex mutex_;
    std::vector<std::uint8_t> sent_;
    std::unique_ptr<ServoLink> link_;
    std::string said_;
};

TEST_F(ServoLinkTest, TakesServosWhereTheyAreWanted) {
    open(tabletProfile());
    goLive();
    link_->command(std::vector<double>{0.9, 0.2, 0.5});
    EXPECT_TRUE(arrives(0, 1900.0));
    EXPECT_TRUE(arrives(1, 1200.0));
    EXPECT_TRUE(arrives(2, 1500.0));
    EXPECT_EQ(pulse(3), 0.0) << "of no concern";
    EXPECT_TRUE(waitFor([&] { return std::abs(link_->status().servos[0].microseconds - 1900.0) < 0.1; }));
    const LinkStatus status = link_->status();
    EXPECT_NEAR(status.servos[0].commanded, 0.9, 1e-3);
    EXPECT_NEAR(status.servos[0].microseconds, 1900.0, 1.0);
    EXPECT_TRUE(status.servos[0].known && status.servos[0].attached);
    EXPECT_GT(status.bytesSent, 20U);
    EXPECT_EQ(times("The board is ready (Firmata, LumorphTablet"), 1) << said_;
    expectSoft();
}

TEST_F(ServoLinkTest, AFaultOfItsOwnLetsServosGoAndIsToldAsItIs) {
    open(tabletProfile());
    goLive();
    faultsToCome_ = 1;
    link_->command(std::vector<double>(3, 0.9));
    EXPECT_TRUE(hears("The link has failed: out of memory. (Servos were stopped; connect the device again.)"));
    EXPECT_TRUE(waitFor([&] { return allLimp(); }));
    EXPECT_TRUE(reaches(LinkPhase::stopped));
    link_->arm(true);
    ASSERT_TRUE(reaches(LinkPhase::live)) << "it still heeds orders";
    faultsToCome_ = 2;
    link_->command(std::vector<double>(3, 0.1));
    EXPECT_TRUE(hears("Servos may still have power: switch it off by hand"));
    EXPECT_TRUE(waitFor([&] { return allLimp(); })) << "what was not said is said again";
    link_->stop();
    EXPECT_TRUE(reaches(LinkPhase::stopped));
}

TEST_F(ServoLinkTest, StartsNoServoWithoutAWordWhosePlaceIsUnknown) {
    open(tabletProfile());
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    link_->arm(false);
    ASSERT_TRUE(hears("Nobody knows where servos 1, 2 and 3 stand, so they were not started."));
    EXPECT_EQ(link_->status().waiting.size(), 3U);
    EXPECT_EQ(link_->status().phase, LinkPhase::starting) << "they do not follow";
    EXPECT_TRUE(allLimp());
}

TEST_F(ServoLinkTest, StopsWhileItsUserIsStuckAndStaysStopped) {
    open(tabletProfile());
    goLive();
    link_->command(std::vector<double>(3, 1.0));
    ASSERT_TRUE(waitFor([&] { return pulse(0) > 1600.0; }));
    const Microseconds before = bench_.now();
    link_->stop();
    // This thread turns no event loop, and only looks.
    while (!allLimp() && bench_.now() - before < 5s) std::this_thread::yield();
    EXPECT_LT(bench_.now() - before, 250ms) << "50 ms on a machine that is not busy";
    link_->command(std::vector<double>(3, 0.2));
    link_->disarm();
    link_->wiggle(0);
    std::this_thread::sleep_for(300ms);
    EXPECT_TRUE(allLimp());
    EXPECT_EQ(link_->status().phase, LinkPhase::stopped);
    link_->arm(false);
    EXPECT_TRUE(reaches(LinkPhase::live));
    EXPECT_TRUE(arrives(0, 1200.0));
    // One slot of the rate cap at full speed, and the horn's way to its pulse.
    expectSoft(60.0);
}

TEST_F(ServoLinkTest, RunsBeforeUsualThreadsWhereTheSystemGrantsIt) {
    bool granted = false;
    std::thread([&] { granted = runPromptly(); }).join();
    open(tabletProfile());
    goLive();
    EXPECT_EQ(policy_, granted ? SCHED_RR | SCHED_RESET_ON_FORK : SCHED_OTHER);
    EXPECT_EQ(::sched_getscheduler(0), SCHED_OTHER) << "it is the link's thread alone";
}

TEST_F(ServoLinkTest, TakesBackWhatWasAskedBeforeTheStop) {
    open(tabletProfile());
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    for (int i = 0; i < 20; ++i) link_->arm(true);
    link_->stop();
    EXPECT_TRUE(reaches(LinkPhase::stopped));
    std::this_thread::sleep_for(100ms);
    EXPECT_TRUE(allLimp());
}

TEST_F(ServoLinkTest, ToldOfARebootItDoesNotMoveAgainByItself) {
    open(tabletProfile());
    goLive();
    link_->command(std::vector<double>(3, 0.8));
    ASSERT_TRUE(arrives(0, 1800.0));
    board_->reboot();
    ASSERT_TRUE(hears("The board has restarted")) << said_;
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    EXPECT_EQ(times("Check its battery and power supply"), 1) << said_;
    link_->command(std::vector<double>(3, 0.1));
    std::this_thread::sleep_for(200ms);
    EXPECT_TRUE(allLimp());
    for (const ServoStatus& servo : link_->status().servos) EXPECT_FALSE(servo.known);
    expectSoft();
}

TEST_F(ServoLinkTest, ComesBackAfterAnUnplugButMovesNothing) {
    open(tabletProfile());
    goLive();
    fault([](BoardFaults& faults) { faults.unplugged = true; });
    ASSERT_TRUE(reaches(LinkPhase::lost));
    EXPECT_TRUE(hears("The link is lost: the simulated device 'tablet' is unplugged")) << said_;
    EXPECT_TRUE(link_->status().trouble);
    fault([](BoardFaults& faults) { faults.unplugged = false; });
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    EXPECT_EQ(link_->status().reconnects, 1U);
    EXPECT_EQ(times("The link is lost"), 1) << said_;
    std::this_thread::sleep_for(100ms);
    EXPECT_TRUE(allLimp());
    goLive();
    expectSoft();
}

TEST_F(ServoLinkTest, SaysWhyABoardCannotBeOpened) {
    bench_.board("tablet")->setFaults({.forbidden = true});
    open(tabletProfile());
    ASSERT_TRUE(hears("There is no link: permission denied")) << said_;
    EXPECT_EQ(link_->status().phase, LinkPhase::connecting);
    link_->arm(true);
    EXPECT_TRUE(hears("The servos cannot be started"));
}

TEST_F(ServoLinkTest, DropsABoardThatHasFallenSilent) {
    open(tabletProfile());
    goLive();
    fault([](BoardFaults& faults) { faults.silent = true; });
    ASSERT_TRUE(waitFor([&] { return link_->status().phase != LinkPhase::live; }));
    EXPECT_TRUE(hears("The link is lost: the board has fallen silent")) << said_;
    EXPECT_EQ(link_->status().phase, LinkPhase::lost);
    EXPECT_FALSE(link_->status().servos[0].attached);
    fault([](BoardFaults& faults) { faults.silent = false; });
    EXPECT_TRUE(reaches(LinkPhase::disarmed));
}

TEST_F(ServoLinkTest, ConnectedAnewItSaysNothingGoodOfTheTimeBefore) {
    open(tabletProfile());
    goLive();
    fault([](BoardFaults& faults) { faults.silent = true; });
    ASSERT_TRUE(hears("The link is lost: the board has fallen silent")) << said_;
    link_->disconnect();
    std::this_thread::sleep_for(1300ms); // letting go is repeated before the link is closed
    EXPECT_EQ(link_->status().phase, LinkPhase::off);
    fault([](BoardFaults& faults) { faults.silent = false; });
    link_->connect();
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    std::this_thread::sleep_for(100ms);
    EXPECT_EQ(times("answers again"), 0) << said_;
}

TEST_F(ServoLinkTest, TellsOfALowBatteryOnce) {
    open(tabletProfile());
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    fault([](BoardFaults& faults) { faults.volts = 5.5; });
    ASSERT_TRUE(hears("The battery is low: 5.5 V")) << said_;
    fault([](BoardFaults& faults) { faults.volts = 5.4; });
    ASSERT_TRUE(waitFor([&] { return link_->status().controller.volts.value_or(9.0) < 5.45; }));
    EXPECT_EQ(times("The battery is low"), 1) << said_;
    fault([](BoardFaults& faults) { faults.volts = 7.4; });
    EXPECT_TRUE(hears("The battery is well again: 7.4 V")) << said_;
}

TEST_F(ServoLinkTest, TellsOfNoiseAndStillStops) {
    open(tabletProfile());
    goLive();
    fault([](BoardFaults& faults) { faults.noise = 0.05; });
    EXPECT_TRUE(waitFor([&] {
        link_->command(std::vector<double>(3, 0.5 + 0.4 * std::sin(1e-6 * static_cast<double>(bench_.now().count()))));
        return times("noisy") > 0 || times("The link is lost") > 0;
    })) << said_;
    EXPECT_EQ(times("noisy") + times("The link is lost") > 0, true) << said_;
    link_->stop();
    fault([](BoardFaults& faults) { faults.noise = 0.0; });
    EXPECT_TRUE(waitFor([&] { return allLimp(); })) << "told again until it was heard";
}

TEST_F(ServoLinkTest, AddsNothingToAQueueThatStands) {
    open(tabletProfile());
    goLive();
    fault([](BoardFaults& faults) { faults.stalled = true; });
    ASSERT_TRUE(waitFor([&] {
        link_->command(std::vector<double>(3, 0.5 + 0.4 * std::sin(1e-6 * static_cast<double>(bench_.now().count()))));
        return link_->status().phase != LinkPhase::live;
    })) << said();
    // What went before the link was seen to stand: its few bytes, one pass more, and questions when it was opened anew.
    std::size_t before = 0;
    {
        const std::scoped_lock lock(mutex_);
        before = sent_.size();
    }
    std::this_thread::sleep_for(1500ms);
    const std::scoped_lock lock(mutex_);
    EXPECT_LE(sent_.size() - before, 600U);
    EXPECT_LE(times("The link is lost"), 1) << said_;
}

TEST_F(ServoLinkTest, GoesToRestAndLetsGoAtTheEnd) {
    DeviceProfile profile = tabletProfile();
    profile.restOnExit = true;
    open(profile);
    goLive();
    link_.reset();
    EXPECT_NEAR(board_->servos()[0].position, 1000.0, 30.0);
    EXPECT_TRUE(allLimp());
    for (const SimulatedServo& servo : board_->servos()) EXPECT_LE(servo.fastest, 2000.0);
}

TEST_F(ServoLinkTest, StopCutsTheWayToRestShort) {
    DeviceProfile profile = tabletProfile();
    profile.restOnExit = true;
    for (ServoSetup& servo : profile.servos) servo.maxVelocity = 0.25; // two seconds to rest
    open(profile);
    goLive();
    std::thread leaving([this] { link_->leave(); });
    ASSERT_TRUE(waitFor([&] { return pulse(0) > 0.0 && pulse(0) < 1480.0; })) << "it is on its way";
    const auto stopped = std::chrono::steady_clock::now();
    link_->stop();
    EXPECT_TRUE(waitFor([&] { return allLimp(); }, 50ms));
    leaving.join();
    EXPECT_LT(std::chrono::steady_clock::now() - stopped, 1s);
    EXPECT_GT(board_->servos()[0].position, 1300.0) << "the middle is where it came from";
}

TEST_F(ServoLinkTest, WantsTheBoardOfTheProfile) {
    DeviceProfile profile = tabletProfile();
    profile.identity = "another";
    open(profile);
    ASSERT_TRUE(reaches(LinkPhase::unidentified));
    EXPECT_TRUE(hears("not the board that the profile was set up with"));
    link_->arm(true);
    EXPECT_TRUE(hears("Confirm first"));
    EXPECT_TRUE(allLimp());
    link_->confirmIdentity();
    goLive();
}

TEST_F(ServoLinkTest, StartsServosThatAreReadWhereTheyAre) {
    DeviceProfile profile = tabletProfile("xarm", 1);
    profile.controller = ControllerKind::lewansoul;
    open(profile);
    ASSERT_TRUE(waitFor([&] {
        const LinkPhase phase = link_->status().phase;
        if (phase == LinkPhase::unidentified) link_->confirmIdentity();
        return phase == LinkPhase::disarmed;
    })) << said();
    ASSERT_TRUE(waitFor([&] {
        return std::ranges::all_of(link_->status().servos, [](const ServoStatus& servo) { return servo.known; });
    }));
    link_->arm(false);
    ASSERT_TRUE(reaches(LinkPhase::live));
    link_->command(std::vector<double>(3, 0.9));
    EXPECT_TRUE(arrives(2, 1900.0));
    for (const SimulatedServo& servo : board_->servos()) EXPECT_LE(servo.largestJump, 4.0);
}

TEST_F(ServoLinkTest, WarnsOfFirmwareThatJumps) {
    open(tabletProfile("uno"));
    goLive();
    EXPECT_EQ(times("jump to their middle"), 1) << said_;
}

TEST_F(ServoLinkTest, TakesOtherLimitsOverWhileServosFollow) {
    open(tabletProfile());
    goLive();
    link_->command(std::vector<double>(3, 1.0));
    ASSERT_TRUE(arrives(0, 2000.0));
    DeviceProfile narrow = profile_;
    narrow.servos[0].pulseMax = 1800.0;
    link_->setProfile(narrow);
    EXPECT_TRUE(arrives(0, 1800.0));
    // It is known where it stands once it is within its limits.
    EXPECT_TRUE(waitFor([&] { return std::abs(link_->status().servos[0].commanded - 1.0) < 1e-9; }));
    EXPECT_EQ(link_->status().phase, LinkPhase::live);
    DeviceProfile wide = narrow;
    wide.servos[0].pulseMax = 2300.0;
    wide.commandsPerSecond = 30.0;
    link_->setProfile(wide);
    EXPECT_TRUE(arrives(0, 2300.0)) << said();
    EXPECT_EQ(link_->status().phase, LinkPhase::live);
    EXPECT_EQ(link_->status().reconnects, 0U);
    EXPECT_EQ(times("let go"), 0) << said_;
    DeviceProfile elsewhere = wide;
    elsewhere.servos[0].channel = 7;
    link_->setProfile(elsewhere);
    EXPECT_TRUE(hears("Another board or other wires: the servos were let go."));
    EXPECT_TRUE(reaches(LinkPhase::disarmed));
    EXPECT_TRUE(allLimp());
    elsewhere.servos[0].pulseMax = NAN;
    EXPECT_THROW(link_->setProfile(elsewhere), InvalidInput);
    EXPECT_EQ(link_->profile().servos[0].pulseMax, 2300.0);
}

TEST_F(ServoLinkTest, PassesAMovingCommandOnWithinMilliseconds) {
    open(tabletProfile());
    goLive();
    for (int i = 0; i < 100; ++i) {
        link_->command(std::vector<double>(3, 0.5 + 0.4 * std::sin(0.1 * i)));
        std::this_thread::sleep_for(13ms);
    }
    const LinkStatus status = link_->status();
    std::printf("latency beyond the rate cap: %.2f ms, %.0f commands a second\n", status.latencyMilliseconds,
                status.commandsPerSecond);
    EXPECT_GT(status.commandsPerSecond, 10.0);
    EXPECT_LT(status.latencyMilliseconds, 20.0) << "2 ms on a machine that is not busy";
}

TEST_F(ServoLinkTest, RefusesProfilesAndAddressesAtOnce) {
    DeviceProfile profile = tabletProfile();
    profile.address = "tablet";
    EXPECT_THROW(ServoLink(profile, {}), InvalidInput);
    profile = tabletProfile();
    profile.servos[1].channel = profile.servos[0].channel;
    EXPECT_THROW(ServoLink(profile, {}), InvalidInput);
}

} // namespace
} // namespace lumorph
