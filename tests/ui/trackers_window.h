#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <QDockWidget>
#include <QLabel>
#include <QScrollArea>

#include "tests/ui/studio_window.h"

namespace lumorph::test {

using namespace std::chrono_literals;

/// The Devices workspace with its trackers in front.
class TrackersWindow : public ::testing::Test {
protected:
    TrackersWindow() : window(folder_ / "session", "devices") {
        window.studio().settings.setValue("trackers/roles", {});
        if (auto* dock = window.window().findChild<QDockWidget*>("dock.devices.trackers")) dock->raise();
    }

    [[nodiscard]] bool opens(const QString& address) {
        window.enter("trackers.address", address, Qt::Key_Tab);
        window.click("trackers.open");
        return eventually([&] { return window.findNow<QWidget>("tracker.0") != nullptr; }, 10s);
    }
    [[nodiscard]] std::string viewer() { return window.studio().loop.frame()->viewer; }
    [[nodiscard]] QString textNow(const QString& name) {
        const auto* label = window.findNow<QLabel>(name);
        return label ? label->text() : QString();
    }
    [[nodiscard]] std::optional<glm::vec3> eye() { return window.studio().loop.frame()->eye; }
    /// The one body that is open, where it truly is.
    [[nodiscard]] Pose truth() { return window.studio().trackers.trackers().at(0).steering->truth(); }
    /// Brings a part of the dock into sight, as somebody would by scrolling.
    void reveal(const QString& name) {
        auto* part = window.find<QWidget>(name);
        if (part == nullptr) return;
        for (QWidget* up = part->parentWidget(); up != nullptr; up = up->parentWidget())
            if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(part);
    }
    [[nodiscard]] double framesPerSecond() { return textNow("tracker.0.frames").section(' ', 0, 0).toDouble(); }

    TemporaryFolder folder_;
    StudioWindow window;
};

} // namespace lumorph::test
