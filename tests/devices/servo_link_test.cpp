#include "core/base/error.h"
#include "core/base/thread_priority.h"
#include "tests/devices/servo_link_trial.h"

namespace lumorph {
namespace {

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
    link_->stop(); // how soon it is there, servo_stop_test measures
    EXPECT_TRUE(waitFor([&] { return allLimp(); }));
    leaving.join();
    // The whole way takes two seconds: it was let go long before its end.
    EXPECT_GT(board_->servos()[0].position, 1200.0) << "the middle is where it came from";
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
