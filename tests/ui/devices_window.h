#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <QAbstractButton>
#include <QCheckBox>
#include <QDockWidget>
#include <QListWidget>
#include <gtest/gtest.h>

#include "devices/controllers/controller_kinds.h"
#include "devices/simulator/simulated_bench.h"
#include "tests/ui/studio_window.h"

namespace lumorph::test {

/// No profile of the test before is left.
struct NoProfiles {
    NoProfiles() { std::filesystem::remove_all(studio::Settings().folder() / "devices"); }
};

/// The Devices workspace as its user has it, against one simulated board; servos from 1000 to 2000 us.
class DevicesWindow : public ::testing::Test {
protected:
    explicit DevicesWindow(const std::string& name = "tablet") : window(folder_ / "session", "devices") {
        // Round numbers, whatever servos the bundled tablet asks for.
        DeviceProfile profile = window.studio().devices.profile();
        for (ServoSetup& servo : profile.servos) {
            servo.pulseMin = 1000.0;
            servo.pulseMax = 2000.0;
        }
        window.studio().devices.setProfile(profile, {});
        none_ = NoProfiles();
        use(name);
    }

    /// The board that the test is about.
    void use(const std::string& name) { board = window.studio().devices.bench().board(name); }
    [[nodiscard]] QString address() const { return QString::fromStdString("sim://" + board->name()); }

    [[nodiscard]] LinkPhase phase() { return window.studio().devices.status().phase; }
    [[nodiscard]] bool reaches(LinkPhase wanted) {
        return eventually([&] { return phase() == wanted; });
    }
    /// Whether the card says so, soon.
    [[nodiscard]] bool tells(const QString& words) {
        return eventually([&] {
            return window.text("devices.card.title").contains(words) ||
                   window.text("devices.card.text").contains(words);
        });
    }
    /// Whether the log says so in a line that is newer than the last clearLog().
    [[nodiscard]] bool logsNow(const QString& words) {
        const auto* log = window.findNow<QListWidget>("devices.log");
        for (int row = 0; log && row < log->count() - seen_; ++row)
            if (log->item(row)->text().contains(words)) return true;
        return false;
    }
    [[nodiscard]] bool logs(const QString& words) {
        return eventually([&] { return logsNow(words); });
    }
    void clearLog() { seen_ = static_cast<int>(window.studio().devices.log().size()); }
    [[nodiscard]] QString next() {
        if (const auto* hold = window.findNow<QAbstractButton>("start.hold"); hold && hold->isEnabled())
            return hold->text();
        const auto* button = window.findNow<QAbstractButton>("devices.card.next");
        return button ? button->text() : QString();
    }
    [[nodiscard]] bool offersStart() {
        return eventually([&] { return next().startsWith("Hold to start"); });
    }
    [[nodiscard]] bool offers(const QString& words) {
        return eventually([&] { return next() == words; });
    }
    /// From nothing to servos that follow, by the card's button alone.
    void goLive() {
        setByHand(0, 0.0); // the show stands still
        ASSERT_TRUE(offers("Connect the simulated tablet"));
        window.click("devices.card.next");
        ASSERT_TRUE(offersStart());
        startServos();
    }
    /// The same on the board that is used, by its address.
    void goLiveByAddress() {
        setByHand(0, 0.0);
        window.studio().devices.connectTo(address());
        ASSERT_TRUE(offersStart());
        startServos();
    }
    void startServos() {
        window.hold("start.hold");
        ASSERT_TRUE(eventually([&] { return allDriven(); })) << story();
    }
    /// What the card and the log say, for those who read of a failure.
    [[nodiscard]] std::string story() {
        QString text = window.text("devices.card.title") + " [" + next() + "]";
        for (const studio::DeviceLogLine& line : window.studio().devices.log()) text += "\n" + line.text;
        return text.toStdString();
    }
    /// Every servo of the rig has its pulse.
    [[nodiscard]] bool allDriven() {
        const LinkStatus& link = window.studio().devices.status();
        return link.phase == LinkPhase::live && link.waiting.empty() && !link.servos.empty() &&
               std::ranges::all_of(link.servos, &ServoStatus::attached);
    }
    void setByHand(std::size_t servo, double stroke) {
        window.studio().document.change("Move by hand", [&](studio::StudioState& state) {
            state.matching.driver = Driver::hand;
            state.strokes.assign(state.rig.rig->actuatorCount(), 0.0);
            state.strokes[servo] = stroke;
        });
    }
    [[nodiscard]] SimulatedServo servoOf(std::size_t servo) {
        const int channel = window.studio().devices.profile().servos.at(servo).channel;
        return board->servos().at(
            static_cast<std::size_t>(channel - firstChannel(likelyController(address().toStdString()))));
    }
    [[nodiscard]] bool allLimp() const {
        for (const SimulatedServo& servo : board->servos())
            if (servo.pulse != 0.0) return false;
        return true;
    }
    void raise(const QString& name) {
        auto* dock = window.window().findChild<QDockWidget*>(name);
        ASSERT_NE(dock, nullptr);
        dock->raise();
    }
    void showSimulator() {
        raise("dock.devices.simulator");
        ASSERT_NE(window.find<QWidget>("sim.board"), nullptr);
    }
    void set(const QString& name, bool on) {
        auto* box = window.find<QCheckBox>(name);
        ASSERT_NE(box, nullptr);
        if (box->isChecked() != on) QTest::mouseClick(box, Qt::LeftButton, {}, QPoint(8, box->height() / 2));
        ASSERT_EQ(box->isChecked(), on);
    }

    TemporaryFolder folder_;
    NoProfiles none_;
    StudioWindow window;
    std::shared_ptr<SimulatedBoard> board;

private:
    int seen_ = 0;
};

} // namespace lumorph::test
