#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <QLineEdit>
#include <QSlider>

#include "app/studio/devices/device_shelf.h"
#include "app/studio/devices/start_moves.h"
#include "app/workspaces/devices/device_words.h"
#include "app/workspaces/devices/servo_board.h"
#include "app/workspaces/devices/stroke_bar.h"
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
    EXPECT_TRUE(offersStart());
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
    EXPECT_TRUE(offersStart());
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
    EXPECT_TRUE(offersStart());
    window.screenshot("devices-stopped");
    pass(300ms);
    EXPECT_TRUE(allLimp()) << "it is latched";
    window.click("resume");
    EXPECT_FALSE(window.studio().loop.stopped());
    pass(500ms);
    EXPECT_TRUE(allLimp()) << "this board cannot tell where its servos are: somebody may have moved them";
    EXPECT_EQ(window.text("start.title"), "Start the servos again?");
    EXPECT_TRUE(window.text("start.text").contains("cannot tell")) << window.text("start.text").toStdString();
    window.screenshot("devices-resumed");
    startServos();
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(0).pulse - 2000.0) <= 2.0; }));
}

TEST_F(DevicesWindow, StopIsOneThingWithOnePromiseWhereverItIsOffered) {
    std::vector<QAction*> stops;
    for (const auto& entry : window.studio().commands.all())
        if (entry.action->text().contains("STOP") && !entry.action->text().contains("after"))
            stops.push_back(entry.action);
    ASSERT_EQ(stops.size(), 1U);
    EXPECT_EQ(stops[0]->toolTip(), window.find<QWidget>("stop")->toolTip());
    EXPECT_TRUE(stops[0]->toolTip().contains("limp"));
    goLive();
    stops[0]->trigger();
    EXPECT_TRUE(reaches(LinkPhase::stopped));
    EXPECT_TRUE(allLimp());
    EXPECT_TRUE(window.studio().loop.stopped());
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
    startServos();
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
    ASSERT_TRUE(eventually([&] { return allLimp() && phase() != LinkPhase::live; })) << "STOP has arrived";
    window.studio().loop.resume();
    ASSERT_TRUE(offersStart());
    startServos();
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

/// Who double-clicks, once or ten times, has said nothing about his fingers.
TEST_F(DevicesWindow, DoubleClicksOnConnectAndOnStartStartNothing) {
    setByHand(0, 0.0);
    ASSERT_TRUE(offers("Connect the simulated tablet"));
    auto* connect = window.find<QWidget>("devices.card.next");
    const QPoint place = connect->mapTo(&window.window(), connect->rect().center());
    for (int press = 0; press < 10 || !next().startsWith("Hold"); ++press) {
        ASSERT_LT(press, 200);
        if (QWidget* there = window.window().childAt(place)) {
            QTest::mouseClick(there, Qt::LeftButton);
            QTest::mouseDClick(there, Qt::LeftButton);
            QTest::mouseRelease(there, Qt::LeftButton);
        }
        pass(100ms);
    }
    auto* hold = window.find<QWidget>("start.hold");
    const QRect dangerous(hold->mapTo(&window.window(), QPoint()), hold->size());
    EXPECT_FALSE(dangerous.contains(place)) << "nothing dangerous comes up under the pointer";
    for (int press = 0; press < 5; ++press) {
        QTest::mouseClick(hold, Qt::LeftButton);
        QTest::mouseDClick(hold, Qt::LeftButton);
        QTest::mouseRelease(hold, Qt::LeftButton);
        pass(100ms);
    }
    window.hold("start.hold", 700ms);
    pass(600ms);
    EXPECT_EQ(phase(), LinkPhase::disarmed);
    EXPECT_TRUE(allLimp());
    // The menu and the keys ask the same.
    window.studio().commands.find("device.start")->trigger();
    window.studio().commands.find("device.next")->trigger();
    pass(300ms);
    EXPECT_EQ(phase(), LinkPhase::disarmed);
    EXPECT_EQ(QApplication::focusWidget(), hold);
    QTest::keyPress(hold, Qt::Key_Space);
    EXPECT_TRUE(eventually([&] { return allDriven(); }, 10s)) << story();
}

TEST_F(DevicesWindow, AStartShowsThePoseToComeAndTheLargestJump) {
    setByHand(2, 0.8);
    window.studio().devices.connectTo(address());
    ASSERT_TRUE(offers("Hold to start anyway"));
    // 1000 to 2000 us; what may be at 1000 and is wanted at 1800 leaps by 800, one that is wanted at 1000 by 1000.
    EXPECT_TRUE(eventually([&] {
        const auto* list = window.findNow<QListWidget>("start.servos");
        return list && list->item(2)->text() ==
                           studio::servoName(studio::servoNamesOf(window.studio()), 2) + ": may jump by up to 800 µs";
    }));
    // The loop glides to that pose first.
    EXPECT_TRUE(eventually([&] { return window.text("start.text").contains("1000 µs, of Servo 1"); }))
        << window.text("start.text").toStdString();
    EXPECT_TRUE(window.text("start.text").startsWith("Hands off"));
    auto* view = window.find<studio::ViewportWidget>("start.view");
    std::vector<double> strokes(window.state().rig.rig->actuatorCount(), 0.0);
    strokes[2] = 0.8;
    std::vector<glm::vec3> wanted(window.state().rig.rig->restMesh().positions.size());
    window.state().rig.rig->deform(strokes, wanted);
    const auto shows = [&](std::size_t surface, const std::vector<glm::vec3>& positions) {
        const auto& scene = view->scene();
        if (!scene || surface >= scene->surfaces.size()) return false;
        const auto& drawn = *scene->surfaces[surface].positions;
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (glm::distance(drawn[i], positions[i]) > 1e-4F) return false;
        return drawn.size() == positions.size();
    };
    EXPECT_TRUE(eventually([&] { return shows(0, wanted); }));
    EXPECT_LT(view->scene()->surfaces[0].opacity, 1.0F) << "nobody knows where it is: it is a ghost";
    window.screenshot("devices-start");
    startServos();
    ASSERT_TRUE(eventually([&] { return std::abs(servoOf(2).pulse - 1800.0) <= 2.0; }));
    window.studio().devices.release();
    setByHand(1, 1.0);
    ASSERT_TRUE(offers("Hold to start servos"));
    EXPECT_TRUE(eventually([&] { return window.text("start.text").contains("100 % of a stroke, of Servo 2"); }))
        << window.text("start.text").toStdString();
    EXPECT_TRUE(eventually([&] { return shows(0, wanted); })) << "where it was let go";
    strokes[2] = 0.0;
    strokes[1] = 1.0;
    window.state().rig.rig->deform(strokes, wanted);
    EXPECT_TRUE(eventually([&] { return shows(1, wanted); })) << "and over it the pose to come";
    window.screenshot("devices-start-known");
}

TEST_F(DevicesWindow, ResumeStartsServosByItselfWhereTheyAreRead) {
    use("xarm");
    goLiveByAddress();
    window.click("stop");
    ASSERT_TRUE(reaches(LinkPhase::stopped));
    pass(1s);
    window.click("resume");
    EXPECT_TRUE(eventually([&] { return allDriven(); })) << story();
}

TEST_F(DevicesWindow, ANumberThatMayNotBeIsRefusedAndNotMadeAnother) {
    goLive();
    window.click("devices.row.3");
    const DeviceProfile before = window.studio().devices.profile();
    const struct {
        const char* field;
        const char* typed;
        const char* told;
    } rows[] = {
        {"servo.pulseMax", "2600", "2600"}, {"servo.pulseMin", "1990", "1990"}, {"servo.trim", "700", "700"},
        {"servo.velocity", "30", "30"},     {"servo.channel", "2.6", "2.6"},    {"servo.channel", "300", "300"},
    };
    for (const auto& row : rows) {
        SCOPED_TRACE(row.field);
        window.enter(row.field, row.typed);
        const auto told = window.studio().notices.at("servo");
        ASSERT_EQ(told.size(), 1U);
        EXPECT_TRUE(told.front().why.contains(row.told)) << told.front().why.toStdString();
        EXPECT_TRUE(told.front().subject.contains("Servo 4")) << told.front().subject.toStdString();
        EXPECT_EQ(window.studio().devices.profile().servos, before.servos);
    }
    // Every number of a servo says in what it is counted.
    for (const auto& [field, unit] :
         {std::pair{"servo.velocity", "(strokes/s)"}, std::pair{"servo.acceleration", "(strokes/s²)"},
          std::pair{"servo.pulseMin", "(µs)"}}) {
        const auto labels = window.window().findChildren<QLabel*>();
        const auto label = std::ranges::find_if(
            labels, [&](const QLabel* one) { return one->buddy() && one->buddy()->objectName() == field; });
        ASSERT_NE(label, labels.end()) << field;
        EXPECT_TRUE((*label)->text().contains(QString::fromUtf8(unit))) << (*label)->text().toStdString();
    }
    window.enter("servo.pulseMax", "1950");
    EXPECT_EQ(window.studio().devices.profile().servos[3].pulseMax, 1950.0);
    EXPECT_TRUE(window.studio().notices.at("servo").empty());
}

TEST_F(DevicesWindow, AChannelThatIsTakenNamesBothServosAndTheyMayExchange) {
    window.click("devices.row.0");
    const auto names = studio::servoNamesOf(window.studio());
    const int first = window.studio().devices.profile().servos[0].channel;
    const int fourth = window.studio().devices.profile().servos[3].channel;
    window.enter("servo.channel", QString::number(fourth));
    const auto told = window.studio().notices.at("servo");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_TRUE(told.front().subject.contains(studio::servoName(names, 0))) << told.front().subject.toStdString();
    EXPECT_TRUE(told.front().why.contains(studio::servoName(names, 3))) << told.front().why.toStdString();
    EXPECT_EQ(window.studio().devices.profile().servos[0].channel, first);
    EXPECT_EQ(window.find<QLineEdit>("servo.channel")->text(), QString::number(first)) << "what is so is shown";
    window.screenshot("devices-channel-taken");
    ASSERT_EQ(told.front().actions.size(), 1U);
    told.front().actions.front().run();
    EXPECT_EQ(window.studio().devices.profile().servos[0].channel, fourth);
    EXPECT_EQ(window.studio().devices.profile().servos[3].channel, first);
    EXPECT_EQ(window.text("devices.channel.0"), "channel " + QString::number(fourth));
}

TEST_F(DevicesWindow, WantedMarksFollowTheLoopWithoutABoard) {
    const auto wanted = [&](std::size_t servo) {
        const auto* row = window.find<QWidget>("devices.row." + QString::number(servo));
        return row->findChild<studio::StrokeBar*>()->shown().wanted;
    };
    EXPECT_TRUE(eventually([&] { return wanted(0) > 0.0 || wanted(1) > 0.0 || wanted(2) > 0.0; }, 5s))
        << "the demonstration plays from the start";
    setByHand(2, 0.7);
    EXPECT_TRUE(eventually([&] { return std::abs(wanted(2) - 0.7) < 1e-6; }, 5s)) << wanted(2);
    setByHand(2, 0.2);
    EXPECT_TRUE(eventually([&] { return std::abs(wanted(2) - 0.2) < 1e-6; }, 5s)) << wanted(2);
}

TEST_F(DevicesWindow, UndoIsOfTheSetUpHereAndOfTheDocumentElsewhereAndSaysWhatItTookBack) {
    window.studio().document.change("Rename sky", [](studio::StudioState& state) {
        Scene scene = *state.scene;
        scene.items.front().name = "renamed";
        state.scene = std::make_shared<const Scene>(std::move(scene));
    });
    QAction* undo = window.studio().commands.find("edit.undo");
    EXPECT_FALSE(undo->isEnabled()) << "the scene is not undone from here, where nobody sees it";
    window.click("devices.row.1");
    const DeviceProfile before = window.studio().devices.profile();
    window.enter("servo.pulseMax", "1900");
    window.enter("servo.trim", "20");
    EXPECT_EQ(window.studio().devices.profile().servos[1].trim, 20.0);
    ASSERT_TRUE(undo->isEnabled());
    QTest::keyClick(window.find<QLineEdit>("servo.trim"), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(window.studio().devices.profile().servos[1].trim, 0.0);
    EXPECT_EQ(window.studio().devices.profile().servos[1].pulseMax, 1900.0);
    const QString who = studio::servoName(studio::servoNamesOf(window.studio()), 1);
    EXPECT_EQ(window.text("undo.toast.text"), "Undone: Trim of " + who + " (Devices)");
    window.screenshot("devices-undo");
    undo->trigger();
    EXPECT_EQ(window.studio().devices.profile().servos, before.servos);
    EXPECT_FALSE(undo->isEnabled());
    window.studio().commands.find("edit.redo")->trigger();
    EXPECT_EQ(window.studio().devices.profile().servos[1].pulseMax, 1900.0);
    const auto file = studio::DeviceShelf(window.studio().settings.folder() / "devices")
                          .fileOf(QString::fromStdString(window.studio().devices.profile().name));
    EXPECT_EQ(readProfile(file).servos.at(1).pulseMax, 1900.0) << "it is kept as it is now";
    EXPECT_EQ(window.state().scene->items.front().name, "renamed");
    // In Field the document is undone, and it is said that it was the scene's.
    window.click("tab.field");
    ASSERT_TRUE(undo->isEnabled());
    undo->trigger();
    EXPECT_NE(window.state().scene->items.front().name, "renamed");
    EXPECT_EQ(window.text("undo.toast.text"), "Undone: Rename sky (Scene)");
    EXPECT_EQ(window.studio().devices.profile().servos[1].pulseMax, 1900.0);
    window.click("undo.toast.show");
    EXPECT_EQ(window.window().workspace(), "scene");
}

TEST_F(DevicesWindow, TheRigShowsTheSameChannel) {
    use("maestro");
    goLiveByAddress();
    window.click("devices.row.0");
    window.enter("servo.channel", "11");
    EXPECT_EQ(window.text("devices.channel.0"), "channel 11");
    window.click("tab.rig");
    auto* list = window.find<QListWidget>("rig.list");
    ASSERT_NE(list, nullptr);
    list->setCurrentRow(0);
    EXPECT_TRUE(eventually([&] { return window.text("rig.actuator.at-the-board") == "11"; }))
        << window.text("rig.actuator.at-the-board").toStdString();
}

TEST(StartMoves, SayWhoMayJumpAndHowFar) {
    DeviceProfile profile;
    profile.servos = {{.channel = 0, .pulseMin = 1000.0, .pulseMax = 2000.0},
                      {.channel = 1, .pulseMin = 600.0, .pulseMax = 2400.0},
                      {.channel = 2, .pulseMin = 1000.0, .pulseMax = 2000.0, .reversed = true}};
    LinkStatus link;
    link.servos.resize(3);
    const std::vector<double> wanted{0.25, 0.5, 0.1};
    auto moves = studio::startMoves(link, profile, wanted);
    EXPECT_EQ(moves[0].jump, 750.0) << "from 2000 to 1250";
    EXPECT_EQ(moves[1].jump, 900.0) << "from either end to 1500";
    EXPECT_NEAR(moves[2].jump, 900.0, 1e-9) << "reversed, 1900 is wanted: from 1000";
    EXPECT_FALSE(studio::startsFromReadPlaces(link));
    link.servos[1].known = true;
    link.servos[1].commanded = 0.9;
    moves = studio::startMoves(link, profile, wanted);
    EXPECT_EQ(moves[1].jump, 0.0);
    EXPECT_EQ(moves[1].from, 0.9);
    EXPECT_EQ(moves[1].to, 0.5);
    link.controller.traits.jumpsOnAttach = true;
    moves = studio::startMoves(link, profile, wanted);
    EXPECT_NEAR(moves[1].jump, 720.0, 1e-9) << "from 2220 to the middle first";
    EXPECT_EQ(moves[0].jump, 500.0);
    link.controller.traits.jumpsOnAttach = false;
    link.controller.traits.readsPosition = true;
    for (ServoStatus& servo : link.servos) servo.known = true;
    EXPECT_TRUE(studio::startsFromReadPlaces(link));
    link.servos[2].known = false;
    EXPECT_FALSE(studio::startsFromReadPlaces(link));
    link.servos[0].attached = true;
    EXPECT_EQ(studio::startMoves(link, profile, wanted)[0].jump, 0.0);
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
        EXPECT_EQ(card.button.isEmpty(), row.step == Step::none || card.starts()) << row.words;
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
