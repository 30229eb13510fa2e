#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <QSlider>

#include "app/studio/devices/device_shelf.h"
#include "app/workspaces/devices/device_words.h"
#include "devices/controllers/device_profile.h"
#include "tests/ui/devices_window.h"

// The Devices workspace as its user has it, against the simulated tablet: what counts is what the board's servos get.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

TEST_F(DevicesWindow, NothingIsConnectedUntilTheUserSaysSoThenServosFollow) {
    EXPECT_EQ(phase(), LinkPhase::off);
    EXPECT_EQ(window.text("status.hardware"), "Virtual lab");
    EXPECT_TRUE(allLimp());
    goLive();
    EXPECT_TRUE(tells("Live"));
    EXPECT_NE(window.text("status.hardware"), "Virtual lab");
    setByHand(2, 1.0);
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(2).pulse - 2000.0) <= 2.0; })) << servoOf(2).pulse;
    EXPECT_NEAR(servoOf(0).pulse, 1000.0, 2.0);
    EXPECT_TRUE(eventually([&] { return window.text("devices.pulse.2") == "2000 µs"; }))
        << window.text("devices.pulse.2").toStdString();
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(2).position - 2000.0) < 20.0; }));
    window.screenshot("devices-live");
    window.click("devices.disconnect");
    EXPECT_TRUE(reaches(LinkPhase::off));
    EXPECT_TRUE(allLimp());
    EXPECT_EQ(window.text("status.hardware"), "Virtual lab");
}

TEST_F(DevicesWindow, AnUnpluggedBoardIsToldAndComesBackLimp) {
    goLive();
    showSimulator();
    set("sim.unplugged", true);
    EXPECT_TRUE(reaches(LinkPhase::lost));
    EXPECT_TRUE(tells("is lost"));
    EXPECT_TRUE(logs("The link is lost"));
    window.screenshot("devices-unplugged");
    set("sim.unplugged", false);
    EXPECT_TRUE(reaches(LinkPhase::disarmed));
    EXPECT_TRUE(offers("Start servos"));
    EXPECT_TRUE(allLimp()) << "it is started by its user alone";
    startServos();
    EXPECT_TRUE(tells("Live"));
}

TEST_F(DevicesWindow, ARestartIsToldAndNothingStartsByItself) {
    goLive();
    showSimulator();
    window.click("sim.reboot");
    // While its bootloader runs it is silent, which is noticed first.
    EXPECT_TRUE(eventually([&] { return phase() != LinkPhase::live; }));
    EXPECT_TRUE(offers("Start servos"));
    EXPECT_TRUE(logs("The board has restarted"));
    EXPECT_TRUE(tells("ready again"));
    pass(500ms);
    EXPECT_TRUE(allLimp());
    EXPECT_EQ(phase(), LinkPhase::disarmed);
}

TEST_F(DevicesWindow, ALowBatteryIsWarnedOf) {
    goLive();
    showSimulator();
    auto* volts = window.find<QSlider>("sim.volts");
    ASSERT_NE(volts, nullptr);
    volts->setValue(15); // 5.5 V
    EXPECT_NEAR(board->faults().volts, 5.5, 1e-9);
    EXPECT_TRUE(logs("The battery is low"));
    EXPECT_TRUE(eventually([&] { return window.text("devices.fact.battery") == "5.5 V"; }))
        << window.text("devices.fact.battery").toStdString();
    EXPECT_EQ(phase(), LinkPhase::live);
}

TEST_F(DevicesWindow, StopReachesTheBoardWhileTheWindowIsStuck) {
    goLive();
    setByHand(0, 1.0);
    ASSERT_TRUE(eventually([&] { return servoOf(0).pulse > 1100.0; })) << "it moves";
    window.click("stop");
    // From here on no event of the window's thread runs.
    const auto deadline = Steady::now() + 5s;
    while (!allLimp() && Steady::now() < deadline) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(allLimp());
    EXPECT_TRUE(reaches(LinkPhase::stopped));
    EXPECT_TRUE(offers("Start again"));
    window.screenshot("devices-stopped");
    pass(300ms);
    EXPECT_TRUE(allLimp()) << "it is latched";
    window.click("resume");
    EXPECT_FALSE(window.studio().loop.stopped());
    EXPECT_TRUE(eventually([&] { return allDriven(); })) << "servos that were live start softly";
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(0).pulse - 2000.0) <= 2.0; }));
}

TEST_F(DevicesWindow, WhoHitsStopTwiceDoesNotStartTheServosAgain) {
    goLive();
    auto* stop = window.find<QWidget>("stop");
    ASSERT_NE(stop, nullptr);
    const QPoint place = stop->mapTo(&window.window(), stop->rect().center());
    QTest::mouseClick(stop, Qt::LeftButton);
    ASSERT_TRUE(reaches(LinkPhase::stopped));
    // Whatever is under the pointer now, is hit four times more.
    for (int press = 0; press < 4; ++press)
        if (QWidget* there = window.window().childAt(place)) QTest::mouseClick(there, Qt::LeftButton);
    pass(500ms);
    EXPECT_EQ(phase(), LinkPhase::stopped);
    EXPECT_TRUE(window.studio().loop.stopped());
    EXPECT_TRUE(allLimp());
    window.screenshot("devices-stopped-twice");
    window.click("resume");
    EXPECT_TRUE(eventually([&] { return allDriven(); }));
    EXPECT_EQ(window.findNow<QWidget>("resume"), nullptr) << "it is not offered where nothing is stopped";
}

TEST_F(DevicesWindow, WhereEscIsNotHeardEverywhereItIsSaid) {
    goLive();
    EXPECT_EQ(window.findNow<QWidget>("devices.stopKeys"), nullptr) << "here it is";
    window.studio().devices.setStopKeysProblem("this desktop does not let a program hear other windows' keys");
    EXPECT_TRUE(eventually([&] {
        return window.findNow<QWidget>("devices.stopKeys") != nullptr &&
               window.text("devices.stopKeys").contains("does not let a program hear");
    }));
    window.screenshot("devices-deaf");
}

TEST_F(DevicesWindow, ServosFollowAndStopWhileTheWindowIsStuck) {
    goLive();
    setByHand(1, 1.0);
    window.studio().loop.stop(); // hands the wish over, so that the loop has nothing left to be told
    window.studio().loop.resume();
    ASSERT_TRUE(eventually([&] { return allDriven(); }));
    setByHand(1, 0.0);
    ASSERT_TRUE(eventually([&] { return servoOf(1).pulse < 1010.0 && servoOf(1).pulse > 0.0; }));
    setByHand(1, 1.0);
    QCoreApplication::processEvents(); // the wish goes out; the servo has yet to move
    const auto until = Steady::now() + 5s;
    while (servoOf(1).pulse < 1990.0 && Steady::now() < until) std::this_thread::sleep_for(2ms);
    EXPECT_NEAR(servoOf(1).pulse, 2000.0, 10.0);
    // STOP from a thread of its own, as the keys that are heard past the window.
    std::thread([this] { window.studio().devices.stopNow(); }).join();
    const auto stopped = Steady::now() + 5s;
    while (!allLimp() && Steady::now() < stopped) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(allLimp());
}

TEST_F(DevicesWindow, TheProfileLimitsThePulse) {
    goLive();
    window.click("devices.row.3");
    EXPECT_TRUE(eventually([&] { return window.text("servo.title").startsWith("Servo 4"); }));
    window.enter("servo.pulseMax", "1600");
    EXPECT_EQ(window.studio().devices.profile().servos[3].pulseMax, 1600.0);
    setByHand(3, 1.0);
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(3).pulse - 1600.0) <= 2.0; })) << servoOf(3).pulse;
    pass(300ms);
    EXPECT_LE(servoOf(3).pulse, 1601.0);
    window.enter("servo.channel", "2"); // the first servo has it
    EXPECT_NE(window.studio().devices.profile().servos[3].channel, 2);
    EXPECT_NE(window.find<QWidget>("notice"), nullptr) << "and it is said why";
    const auto file = studio::DeviceShelf(window.studio().settings.folder() / "devices")
                          .fileOf(QString::fromStdString(window.studio().devices.profile().name));
    EXPECT_EQ(readProfile(file).servos.at(3).pulseMax, 1600.0) << "it is kept";
    std::filesystem::remove(file);
}

TEST_F(DevicesWindow, ATestMovesOneServoSlowlyAndLetsItFollowAgain) {
    goLive();
    window.click("devices.row.4");
    const auto began = Steady::now();
    window.click("servo.middle");
    ASSERT_TRUE(eventually([&] { return std::abs(servoOf(4).pulse - 1500.0) <= 2.0; })) << servoOf(4).pulse;
    EXPECT_GE(Steady::now() - began, 1800ms) << "half a stroke takes two seconds";
    EXPECT_NEAR(servoOf(5).pulse, 1000.0, 2.0);
    window.click("servo.follow");
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(4).pulse - 1000.0) <= 2.0; }));
    EXPECT_FALSE(window.studio().devices.testing());
}

TEST_F(DevicesWindow, TheRowThatMovedGetsTheChannelThatWiggled) {
    goLive();
    const int first = window.studio().devices.profile().servos[0].channel;
    const int sixth = window.studio().devices.profile().servos[5].channel;
    window.click("devices.row.0");
    window.click("servo.assign");
    EXPECT_TRUE(window.text("devices.hint.text").contains("Click the row"));
    window.click("devices.row.5");
    EXPECT_EQ(window.studio().devices.profile().servos[5].channel, first);
    EXPECT_EQ(window.studio().devices.profile().servos[0].channel, sixth);
    window.click("servo.resetProfile");
    EXPECT_EQ(window.studio().devices.profile().servos[0].channel, first);
}

TEST_F(DevicesWindow, WhatIsNoAddressIsToldWhereItIsTyped) {
    window.enter("devices.address", "sim:/tablet");
    EXPECT_NE(window.find<QWidget>("notice"), nullptr);
    EXPECT_EQ(phase(), LinkPhase::off);
    window.enter("devices.address", "sim://maestro");
    EXPECT_TRUE(eventually([&] { return phase() != LinkPhase::off; }));
    EXPECT_EQ(window.studio().devices.profile().controller, ControllerKind::maestro);
    EXPECT_EQ(window.studio().devices.profile().servos[0].channel, 0) << "channels as a Maestro counts them";
}

TEST(DeviceWords, TheNextStepFitsTheState) {
    studio::DeviceView view;
    view.rig = true;
    view.name = "Tablet";
    view.servos = {"left", "middle", "right"};
    using Step = studio::DeviceCard::Step;
    const struct {
        LinkPhase phase;
        std::vector<std::size_t> waiting;
        Step step;
        const char* words;
    } rows[] = {
        {LinkPhase::off, {}, Step::connect, "Nothing is connected"},
        {LinkPhase::unidentified, {}, Step::confirm, "Is this your device?"},
        {LinkPhase::disarmed, {}, Step::start, "Tablet is ready"},
        {LinkPhase::starting, {}, Step::none, "Servos start"},
        {LinkPhase::starting, {2}, Step::startAnyway, "Servo 3 (right) may jump when it starts: hands off"},
        {LinkPhase::starting, {0, 2}, Step::startAnyway, "Servos 1 and 3 may jump when they start: hands off"},
        {LinkPhase::live, {0, 1, 2}, Step::startAnyway, "All servos may jump when they start: hands off"},
        {LinkPhase::live, {}, Step::none, "Live"},
        {LinkPhase::stopped, {}, Step::startAgain, "Stopped"},
        {LinkPhase::lost, {}, Step::none, "The link to Tablet is lost"},
    };
    for (const auto& row : rows) {
        view.link.phase = row.phase;
        view.link.waiting = row.waiting;
        const studio::DeviceCard card = cardOf(view);
        EXPECT_EQ(card.title.toStdString(), row.words);
        EXPECT_EQ(card.step, row.step) << row.words;
        EXPECT_EQ(card.button.isEmpty(), row.step == Step::none) << row.words;
    }
    view.rig = false;
    EXPECT_EQ(cardOf(view).step, Step::openRig);
}

TEST(DeviceShelfNames, AreNamesOfFiles) {
    EXPECT_EQ(studio::fileNameOf(" my tablet "), "my tablet");
    EXPECT_EQ(studio::fileNameOf("../../etc/passwd"), "_.._etc_passwd");
    EXPECT_EQ(studio::fileNameOf("  "), "Device");
}

} // namespace
} // namespace lumorph::test
