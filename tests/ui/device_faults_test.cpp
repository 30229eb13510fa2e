#include <chrono>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QSlider>

#include "tests/ui/devices_window.h"

// Each simulated board is broken on purpose from the simulator's panel: what its user is told, what is offered next,
// and what the board's servos get meanwhile.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

class DeviceFaults : public DevicesWindow, public ::testing::WithParamInterface<const char*> {
protected:
    DeviceFaults() : DevicesWindow(GetParam()) {}

    void connectNow() {
        setByHand(0, 0.0); // the show stands still
        window.studio().devices.connectTo(address());
        showSimulator();
    }
    void setSlider(const QString& name, int steps) {
        auto* slider = window.find<QSlider>(name);
        ASSERT_NE(slider, nullptr);
        slider->setValue(steps);
    }
    /// As if the profile had been set up with another board, whose port this one now has.
    void expectAnotherIsAskedAbout() {
        window.click("devices.disconnect");
        ASSERT_TRUE(reaches(LinkPhase::off));
        DeviceProfile other = window.studio().devices.profile();
        other.identity = "A9007Xyz";
        ASSERT_TRUE(window.studio().devices.setProfile(other));
        window.studio().devices.connectTo(address());
        EXPECT_TRUE(offers("Yes, this is it")) << story();
        EXPECT_TRUE(logs("This is not the board that the profile was set up with."));
        pass(300ms);
    }
    /// The board is whole again and its user starts the servos, as the card offers it.
    void goOn() {
        window.click("sim.mend");
        ASSERT_TRUE(eventually([&] { return next().startsWith("Hold to start") || allDriven(); }, 20s)) << story();
        if (!allDriven()) startServos();
        EXPECT_TRUE(allDriven());
        clearLog();
    }
};

TEST_P(DeviceFaults, WhatKeepsALinkFromOpeningIsTold) {
    const struct {
        const char* fault;
        const char* why;
        const char* remedy;
    } rows[] = {
        {"sim.unplugged", "is unplugged", "Plug it in on the simulator's panel."},
        {"sim.forbidden", "ermission denied", "Allow access to it on the simulator's panel."},
        {"sim.busy", "nother program uses", "Let it go on the simulator's panel."},
    };
    connectNow();
    ASSERT_TRUE(offersStart());
    for (const auto& row : rows) {
        SCOPED_TRACE(row.fault);
        window.click("devices.disconnect");
        ASSERT_TRUE(reaches(LinkPhase::off));
        pass(1s); // servos are told to let go before the port is closed
        set(row.fault, true);
        clearLog();
        window.studio().devices.connectTo(address());
        EXPECT_TRUE(logs("There is no link: "));
        EXPECT_TRUE(logs(row.why));
        EXPECT_TRUE(tells("No link to ")) << story();
        EXPECT_TRUE(tells(row.why)) << story();
        EXPECT_TRUE(tells(row.remedy)) << story();
        EXPECT_EQ(phase(), LinkPhase::connecting);
        EXPECT_EQ(next(), "") << "the studio tries again by itself";
        set(row.fault, false);
        EXPECT_TRUE(offersStart()) << story();
        EXPECT_TRUE(allLimp());
    }
}

TEST_P(DeviceFaults, APulledCableLetsNothingStartByItself) {
    connectNow();
    ASSERT_TRUE(offersStart());
    startServos();
    set("sim.unplugged", true);
    EXPECT_TRUE(reaches(LinkPhase::lost));
    EXPECT_TRUE(tells("The link to ")) << story();
    EXPECT_TRUE(tells("is lost")) << story();
    EXPECT_TRUE(tells("Plug it in")) << story();
    EXPECT_TRUE(logs("The link is lost: the simulated device '" + QString(GetParam()) + "' is unplugged."));
    set("sim.unplugged", false);
    EXPECT_TRUE(reaches(LinkPhase::disarmed));
    EXPECT_TRUE(offersStart());
    pass(300ms);
    EXPECT_EQ(phase(), LinkPhase::disarmed);
    startServos();
    EXPECT_TRUE(tells("Live"));
}

TEST_P(DeviceFaults, ARestartIsTold) {
    connectNow();
    ASSERT_TRUE(offersStart());
    startServos();
    window.click("sim.reboot");
    EXPECT_TRUE(eventually([&] { return phase() != LinkPhase::live; })) << story();
    // A board whose USB is its own goes from the bus; others say so, or are seen to have let go of their servos.
    const QString words = board->name() == "xarm" ? "has gone from the USB" : "The board has restarted";
    EXPECT_TRUE(logs(words));
    EXPECT_TRUE(offersStart()) << story();
    pass(300ms);
    EXPECT_TRUE(allLimp()) << "nothing starts by itself";
    startServos();
    EXPECT_TRUE(tells("Live"));
}

TEST_P(DeviceFaults, ASilentOrStalledBoardIsTold) {
    connectNow();
    ASSERT_TRUE(offersStart());
    startServos();
    set("sim.silent", true);
    EXPECT_TRUE(eventually([&] { return phase() != LinkPhase::live; })) << "within seconds nobody calls it live";
    EXPECT_TRUE(logs("The link is lost: "));
    EXPECT_TRUE(tells("is lost") || tells("does not answer")) << story();
    goOn();
    set("sim.stalled", true);
    setByHand(0, 1.0); // something to send
    EXPECT_TRUE(eventually([&] { return phase() != LinkPhase::live; })) << story();
    EXPECT_TRUE(logs("The link"));
    setByHand(0, 0.0);
    goOn();
}

TEST_P(DeviceFaults, NoiseIsToldAndServosStayWithinTheirLimits) {
    connectNow();
    ASSERT_TRUE(offersStart());
    startServos();
    clearLog();
    setSlider("sim.noise", 60); // 6 %
    for (int k = 0; k < 40 && !logsNow("noisy") && !logsNow("lost") && !logsNow("restarted"); ++k) {
        setByHand(static_cast<std::size_t>(k % 2), k % 4 < 2 ? 1.0 : 0.0);
        pass(250ms);
    }
    EXPECT_TRUE(logsNow("noisy") || logsNow("lost") || logsNow("restarted"));
    setByHand(0, 0.0);
    goOn();
}

TEST_P(DeviceFaults, ALowBatteryIsToldWhereItIsMeasured) {
    connectNow();
    ASSERT_TRUE(offersStart());
    const bool measured = window.studio().devices.status().controller.traits.readsVoltage;
    EXPECT_EQ(measured, std::string(GetParam()) == "tablet" || std::string(GetParam()) == "xarm");
    setSlider("sim.volts", 15); // 5.5 V
    if (!measured) {
        EXPECT_TRUE(eventually([&] { return window.text("devices.fact.battery") == "not measured"; }));
        return;
    }
    EXPECT_TRUE(logs("The battery is low: 5.5 V."));
    EXPECT_TRUE(logs("Charge it or change it"));
    EXPECT_TRUE(eventually([&] { return window.text("devices.fact.battery") == "5.5 V"; }));
    setSlider("sim.volts", 34); // 7.4 V
    EXPECT_TRUE(logs("The battery is well again: 7.4 V."));
}

TEST_P(DeviceFaults, TheWordThatThisIsTheBoardIsKeptForThisBoardAlone) {
    BoardFaults nameless;
    nameless.nameless = true;
    board->setFaults(nameless);
    connectNow();
    ASSERT_TRUE(eventually([&] { return next() == "Yes, this is it" || next().startsWith("Hold to start"); }))
        << story();
    if (next().startsWith("Hold to start")) return; // what it says of itself is enough
    EXPECT_TRUE(tells("Is this your device?"));
    window.click("devices.card.next");
    ASSERT_TRUE(offersStart());
    EXPECT_EQ(window.studio().devices.profile().identity, "simulated " + board->name());

    // The same board again: as after a start of the studio, the profile is read from its file.
    window.click("devices.disconnect");
    ASSERT_TRUE(reaches(LinkPhase::off));
    window.studio().devices.loadProfile(QString::fromStdString(window.studio().devices.profile().name));
    clearLog();
    window.studio().devices.connectTo(address());
    ASSERT_TRUE(offersStart()) << story();
    EXPECT_FALSE(logsNow("Confirm"));

    expectAnotherIsAskedAbout();
    EXPECT_EQ(phase(), LinkPhase::unidentified);
    window.click("devices.card.next");
    ASSERT_TRUE(offersStart());
    EXPECT_EQ(window.studio().devices.profile().identity, "simulated " + board->name());
}

TEST_P(DeviceFaults, AnotherBoardWhereTheOneThatWasLiveWasIsAskedAbout) {
    goLiveByAddress();
    const std::string known = "simulated " + board->name();
    EXPECT_TRUE(eventually([&] { return window.studio().devices.profile().identity == known; }));
    expectAnotherIsAskedAbout();
    EXPECT_TRUE(allLimp());
}

/// Another program that has a port for itself.
class OtherProgram {
public:
    explicit OtherProgram(const std::string& path) {
        int told[2] = {-1, -1};
        if (::pipe(told) != 0) return;
        process_ = ::fork();
        if (process_ == 0) { // nothing but calls of the system from here on
            const int port = ::open(path.c_str(), O_RDWR | O_NOCTTY);
            const char locked = ::flock(port, LOCK_EX | LOCK_NB) == 0 ? 1 : 0;
            (void)!::write(told[1], &locked, 1);
            for (;;) ::pause();
        }
        char locked = 0;
        hasIt_ = ::read(told[0], &locked, 1) == 1 && locked == 1;
        ::close(told[0]);
        ::close(told[1]);
    }
    ~OtherProgram() { end(); }
    OtherProgram(const OtherProgram&) = delete;
    OtherProgram& operator=(const OtherProgram&) = delete;
    [[nodiscard]] bool hasIt() const { return hasIt_; }
    void end() {
        if (process_ <= 0) return;
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
        process_ = -1;
    }

private:
    pid_t process_ = -1;
    bool hasIt_ = false;
};

using DeviceConflict = DevicesWindow;

TEST_F(DeviceConflict, APortThatAnotherProgramHasIsToldAndTakenOnceItIsFree) {
    const int far = ::posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_TRUE(far >= 0 && ::grantpt(far) == 0 && ::unlockpt(far) == 0);
    const QString path = ::ptsname(far);
    OtherProgram other(path.toStdString());
    ASSERT_TRUE(other.hasIt());
    window.studio().devices.connectTo("serial://" + path + "?baud=57600");
    EXPECT_TRUE(logs("There is no link: ")) << story();
    EXPECT_TRUE(tells("No link to ")) << story();
    EXPECT_TRUE(tells("he program ") && tells(" uses " + path)) << story();
    EXPECT_TRUE(tells("Close ")) << story();
    EXPECT_EQ(phase(), LinkPhase::connecting);
    other.end();
    EXPECT_TRUE(reaches(LinkPhase::handshake)) << "the studio tries again by itself: " << story();
    window.click("devices.disconnect");
    EXPECT_TRUE(reaches(LinkPhase::off));
    ::close(far);
}

TEST_F(DeviceConflict, APortThatIsNotThereIsTold) {
    window.studio().devices.connectTo("serial:///dev/ttyNothing?baud=57600");
    EXPECT_TRUE(logs("There is no link: there is no port /dev/ttyNothing.")) << story();
    EXPECT_TRUE(tells("There is no port /dev/ttyNothing. Plug the device in, or choose another port."));
}

INSTANTIATE_TEST_SUITE_P(Boards, DeviceFaults, ::testing::Values("tablet", "uno", "xarm", "maestro"),
                         [](const auto& board) { return std::string(board.param); });

} // namespace
} // namespace lumorph::test
