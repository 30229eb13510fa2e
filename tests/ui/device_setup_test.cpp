#include <cmath>
#include <fstream>
#include <iterator>

#include <QCheckBox>

#include "app/studio/devices/device_shelf.h"
#include "devices/firmware/pin_header.h"
#include "tests/ui/devices_window.h"
#include "tests/ui/file_dialog.h"

// What is set up for all servos of a profile: it is in force at once, and it is kept.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

class DeviceSetup : public DevicesWindow {
protected:
    DeviceSetup() { raise("dock.devices.setup"); }

    [[nodiscard]] const DeviceProfile& profile() { return window.studio().devices.profile(); }
    [[nodiscard]] DeviceProfile kept() {
        return studio::DeviceShelf(window.studio().settings.folder() / "devices")
            .load(QString::fromStdString(profile().name));
    }
};

TEST_F(DeviceSetup, NumbersAreTakenWithTheirUnitsAndKept) {
    window.enter("setup.stagger", "250 ms");
    EXPECT_DOUBLE_EQ(profile().staggerSeconds, 0.25);
    window.enter("setup.slowShare", "40");
    EXPECT_DOUBLE_EQ(profile().slowShare, 0.4);
    window.enter("setup.rate", "20");
    EXPECT_DOUBLE_EQ(profile().commandsPerSecond, 20.0);
    window.enter("setup.hand", "150 mm");
    EXPECT_DOUBLE_EQ(profile().handDistance, 0.15);
    set("setup.rest", false);
    EXPECT_FALSE(profile().restOnExit);
    EXPECT_EQ(kept(), profile());
    window.screenshot("devices-setup");
}

TEST_F(DeviceSetup, WhatIsOutOfRangeIsNotTaken) {
    const DeviceProfile before = profile();
    for (const auto& [name, text] : {std::pair{"setup.stagger", "11"}, std::pair{"setup.slowShare", "0"},
                                     std::pair{"setup.rate", "1000"}, std::pair{"setup.hand", "2 m"}}) {
        SCOPED_TRACE(name);
        window.enter(name, text);
        EXPECT_NO_THROW(checkProfile(profile()));
    }
    EXPECT_EQ(profile().servos, before.servos);
}

TEST_F(DeviceSetup, SlowModeHasTheShareThatIsSetWhileItRuns) {
    goLive();
    raise("dock.devices.setup");
    window.enter("setup.slowShare", "10");
    window.studio().devices.setSlow(true);
    const ServoSetup setup = profile().servos[0];
    const double whole = 1.0 / (0.1 * setup.maxVelocity); // seconds
    setByHand(0, 1.0);
    ASSERT_TRUE(eventually([&] { return servoOf(0).pulse > setup.pulseMin + 20.0; }));
    const double from = servoOf(0).pulse;
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_TRUE(eventually([&] { return servoOf(0).pulse >= from + 100.0; }));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    EXPECT_GE(seconds, 0.8 * 0.1 * whole) << "a tenth of the way in a tenth of the time";
}

TEST_F(DeviceSetup, TheRestPoseIsWhereServosGoWhenTheLinkEnds) {
    EXPECT_EQ(window.text("setup.pose"), "All servos down.");
    goLive();
    raise("dock.devices.setup");
    setByHand(1, 0.5);
    ASSERT_TRUE(eventually([&] { return std::abs(servoOf(1).pulse - 1500.0) <= 2.0; }));
    window.click("setup.poseNow");
    EXPECT_NEAR(profile().servos[1].exitStroke, 0.5, 0.01);
    EXPECT_NEAR(profile().servos[0].exitStroke, 0.0, 0.01);
    EXPECT_TRUE(window.text("setup.pose").contains("Servo 2")) << window.text("setup.pose").toStdString();
    setByHand(0, 1.0);
    ASSERT_TRUE(eventually([&] { return std::abs(servoOf(0).pulse - 2000.0) <= 2.0; }));
    // Another device is chosen: this one is left at rest.
    window.studio().devices.connectTo("sim://uno");
    EXPECT_TRUE(eventually([&] { return allLimp(); }));
    EXPECT_NEAR(servoOf(0).position, 1000.0, 30.0);
    EXPECT_NEAR(servoOf(1).position, 1500.0, 30.0);
}

TEST_F(DeviceSetup, StopIsHeardOnTheWayToRestToo) {
    goLive();
    window.studio().devices.setSlow(true);
    setByHand(0, 1.0);
    ASSERT_TRUE(eventually([&] { return servoOf(0).pulse > 1950.0; }));
    const std::shared_ptr<SimulatedBoard> left = board;
    const auto pulse = [&] { return left->servos().at(0).pulse; };
    window.studio().devices.connectTo("sim://uno");
    ASSERT_TRUE(eventually([&] { return pulse() < 1900.0; }));
    ASSERT_GT(pulse(), 0.0) << "it is on its way";
    window.click("stop");
    EXPECT_TRUE(eventually([&] { return allLimp(); }));
    EXPECT_GT(left->servos().at(0).position, 1200.0) << "and did not get there";
}

TEST_F(DeviceSetup, WhoIsOnTheWayToRestIsNotHurried) {
    goLive();
    window.studio().devices.setSlow(true);
    setByHand(0, 1.0);
    ASSERT_TRUE(eventually([&] { return servoOf(0).pulse > 1950.0; }));
    const DeviceProfile slow = profile();
    const std::shared_ptr<SimulatedBoard> left = board;
    window.studio().devices.connectTo("sim://uno");
    window.studio().devices.setSlow(false); // the other device's servos may be fast
    ASSERT_TRUE(eventually([&] { return allLimp(); }));
    const ServoSetup& setup = slow.servos[0];
    const double fast = setup.maxVelocity * (setup.pulseMax - setup.pulseMin);
    EXPECT_LT(left->servos().at(0).position, 1900.0) << "it was on its way";
    EXPECT_LT(left->servos().at(0).fastest, 2.0 * slow.slowShare * fast);
}

TEST_F(DeviceSetup, AMaestrosNumberIsAskedOfMaestrosAlone) {
    EXPECT_EQ(window.findNow<QWidget>("setup.controllerNumber"), nullptr);
    use("maestro");
    goLiveByAddress();
    raise("dock.devices.setup");
    ASSERT_NE(window.find<QWidget>("setup.controllerNumber"), nullptr);
    window.enter("setup.controllerNumber", "5");
    EXPECT_EQ(profile().controllerNumber, 5);
    // The simulated board has number 12: nothing answers that is called 5.
    EXPECT_TRUE(logs("Another board or other wires: the servos were let go."));
    EXPECT_TRUE(tells("o Maestro with device number 5 answers"));
    EXPECT_TRUE(allLimp());
    window.enter("setup.controllerNumber", "12");
    EXPECT_TRUE(offersStart());
    set("setup.maestroCrc", true);
    EXPECT_TRUE(profile().maestroCrc);
}

TEST_F(DeviceSetup, TheWholeSketchIsWrittenIntoTheFolderThatIsChosen) {
    window.studio().commands.find("device.firmware")->trigger();
    answerFileDialog(window, "device.firmware.file", folder_.path(), "Export here");
    const auto told = [&]() -> QString {
        for (const studio::Notice& notice : window.studio().notices.at("devices"))
            if (notice.level == studio::Notice::Level::info) return notice.why;
        return {};
    };
    ASSERT_TRUE(eventually([&] { return !told().isEmpty(); }, 10s));
    const std::filesystem::path sketch = folder_ / "tablet";
    EXPECT_TRUE(told().contains(QString::fromStdString(sketch.string()))) << told().toStdString();
    EXPECT_TRUE(std::filesystem::is_regular_file(sketch / "tablet.ino"));
    EXPECT_TRUE(std::filesystem::is_regular_file(sketch / "firmata.cpp"));
    std::ifstream file(sketch / "channels.h");
    const std::string header{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(header, channelsHeader(profile()));
}

} // namespace
} // namespace lumorph::test
