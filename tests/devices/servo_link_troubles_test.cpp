#include "tests/devices/servo_link_trial.h"

// What befalls a link, and what its user is told of it.

namespace lumorph {
namespace {

class ServoLinkTroubles : public ServoLinkTest {};

TEST_F(ServoLinkTroubles, AFaultOfItsOwnLetsServosGoAndIsToldAsItIs) {
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

TEST_F(ServoLinkTroubles, ToldOfARebootItDoesNotMoveAgainByItself) {
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

TEST_F(ServoLinkTroubles, ComesBackAfterAnUnplugButMovesNothing) {
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

TEST_F(ServoLinkTroubles, SaysWhyABoardCannotBeOpened) {
    bench_.board("tablet")->setFaults({.forbidden = true});
    open(tabletProfile());
    ASSERT_TRUE(hears("There is no link: permission denied")) << said_;
    EXPECT_EQ(link_->status().phase, LinkPhase::connecting);
    link_->arm(true);
    EXPECT_TRUE(hears("The servos cannot be started"));
}

TEST_F(ServoLinkTroubles, DropsABoardThatHasFallenSilent) {
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

TEST_F(ServoLinkTroubles, ConnectedAnewItSaysNothingGoodOfTheTimeBefore) {
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

TEST_F(ServoLinkTroubles, TellsOfALowBatteryOnce) {
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

TEST_F(ServoLinkTroubles, TellsOfNoiseAndStillStops) {
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

TEST_F(ServoLinkTroubles, AddsNothingToAQueueThatStands) {
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

} // namespace
} // namespace lumorph
