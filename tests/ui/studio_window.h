#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <QDialog>
#include <QDockWidget>
#include <QLabel>
#include <QTest>
#include <gtest/gtest.h>

#include "app/studio/shell/main_window.h"
#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"
#include "tests/core/temporary_folder.h"
#include "tests/ui/event_loop.h"

namespace lumorph::test {

/// How many times as long the endurance tests run: LUMORPH_SOAK, up to 10 in packaging/soak.
[[nodiscard]] int soakFactor();

/// What this process holds of the machine's memory.
[[nodiscard]] double residentMegabytes();

/// What of the heap is in use: without its holes, and without what drivers map by themselves.
[[nodiscard]] double allocatedMegabytes();

/// Limits the share of time that drawing in software may take to LUMORPH_TEST_DRAWS, where that is set: it would take
/// most of the time of tests that look at other things.
void drawLittle(studio::Studio& studio);
/// Starts or pauses the target's animation, which is matched and drawn all the time; no step of undo.
void setPlaying(studio::Studio& studio, bool on);

/// The studio as the program makes it, 1600 x 1000, with a session folder that the test names. Widgets are found by
/// objectName, and what a user would do is done with mouse and keys.
class StudioWindow {
public:
    /// Restores the session in `session`, or opens the field's demo, paused, where there is none; waits for the first
    /// field.
    explicit StudioWindow(const std::filesystem::path& session, const QString& workspace = "field");
    ~StudioWindow();

    studio::Studio& studio() { return *studio_; }
    studio::MainWindow& window() { return *window_; }
    [[nodiscard]] const studio::StudioState& state() const { return studio_->document.state(); }

    /// Waits for it; a test failure, and null, when it does not come.
    template <class Widget> Widget* find(const QString& name) {
        Widget* found = nullptr;
        (void)eventually([&] { return (found = findNow<Widget>(name)) != nullptr; }, std::chrono::seconds(20));
        EXPECT_NE(found, nullptr) << name.toStdString() << " does not come into sight";
        return found;
    }
    /// The visible one, in any window of the program; null when there is none.
    template <class Widget> Widget* findNow(const QString& name) {
        for (QWidget* top : QApplication::topLevelWidgets()) {
            if (top->objectName() == name && top->isVisible())
                if (auto* itself = qobject_cast<Widget*>(top)) return itself;
            for (Widget* widget : top->findChildren<Widget*>(name))
                if (widget->isVisible()) return widget;
        }
        return nullptr;
    }
    studio::ViewportWidget& view() { return *find<studio::ViewportWidget>("field.viewport"); }

    void click(const QString& name);
    /// Presses a button by the mouse, and lets go of it after a while, or once it is gone.
    void hold(const QString& name, std::chrono::milliseconds time = std::chrono::seconds(10));
    /// Types over what a field holds, then presses Enter, which in a dialog is its first button too, or Tab.
    void enter(const QString& name, const QString& text, Qt::Key then = Qt::Key_Return);
    /// Ctrl+K, the words, Enter.
    void command(const QString& words);
    /// Drags a file from a file manager onto the view, or onto another widget.
    void drop(const std::filesystem::path& file, QWidget* onto = nullptr);
    /// Moves a slider's handle from where it is to a share of its length, by the mouse.
    void slide(const QString& name, double share);
    [[nodiscard]] QString text(const QString& label);
    /// Until no job runs and the view shows the newest frame in full quality.
    [[nodiscard]] bool settles();
    /// Into the folder that LUMORPH_SCREENSHOTS names, to be looked at, `after` what moves has come to rest; without
    /// that folder nothing waits for it.
    void screenshot(const QString& name, std::chrono::milliseconds after = std::chrono::milliseconds(100));

private:
    std::unique_ptr<studio::Studio> studio_;
    std::unique_ptr<studio::MainWindow> window_;
};

} // namespace lumorph::test
