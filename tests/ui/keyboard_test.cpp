#include <memory>
#include <set>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QButtonGroup>
#include <QComboBox>
#include <QDialog>
#include <QDockWidget>
#include <QLineEdit>
#include <QScrollBar>
#include <QTest>
#include <QTreeView>
#include <gtest/gtest.h>

#include "app/studio/shell/main_window.h"
#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/plot.h"
#include "app/studio/widgets/range_slider.h"
#include "app/workspaces/field/actuator_grid.h"
#include "app/workspaces/scene/direction_dial.h"
#include "app/workspaces/workspaces.h"
#include "tests/ui/event_loop.h"
#include "tests/ui/project_world.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

constexpr int kMostSteps = 400;
constexpr int kMostLinks = 40; ///< of a page that is read: Tab visits each before it leaves the page

/// Which have a command with a key, or belong to another control that is reached.
bool reachedOtherwise(const QWidget& control) {
    const QString name = control.objectName();
    if (name.startsWith("qt_")) return true;                    // inside Qt's own composites
    if (qobject_cast<const QScrollBar*>(&control)) return true; // follows what is reached in its area
    for (const QWidget* up = control.parentWidget(); up; up = up->parentWidget())
        if (qobject_cast<const QComboBox*>(up) || qobject_cast<const QAbstractSpinBox*>(up) ||
            qobject_cast<const QAbstractItemView*>(up))
            return true;
    return false;
}

bool isControl(const QWidget& widget) {
    return qobject_cast<const QAbstractButton*>(&widget) || qobject_cast<const QLineEdit*>(&widget) ||
           qobject_cast<const QComboBox*>(&widget) || qobject_cast<const QAbstractSlider*>(&widget) ||
           qobject_cast<const QAbstractSpinBox*>(&widget) || qobject_cast<const QAbstractItemView*>(&widget) ||
           qobject_cast<const Plot*>(&widget) || qobject_cast<const RangeSlider*>(&widget) ||
           qobject_cast<const ActuatorGrid*>(&widget) || qobject_cast<const DirectionDial*>(&widget) ||
           qobject_cast<const ViewportWidget*>(&widget);
}

std::vector<QWidget*> controlsOf(const QWidget& window) {
    std::vector<QWidget*> controls;
    for (QWidget* widget : window.findChildren<QWidget*>())
        if (widget->window() == &window && widget->isVisible() && widget->isEnabled() && isControl(*widget) &&
            !reachedOtherwise(*widget))
            controls.push_back(widget);
    return controls;
}

std::string named(const QWidget& widget) {
    std::string path = std::string(widget.metaObject()->className()) + " '" + widget.objectName().toStdString() + "'";
    for (const QWidget* up = widget.parentWidget(); up; up = up->parentWidget())
        if (!up->objectName().isEmpty()) return path + " in '" + up->objectName().toStdString() + "'";
    return path;
}

/// All widgets that have the keyboard while Tab (or Shift+Tab) goes once round.
std::set<const QWidget*> walk(QWidget& window, bool backwards) {
    std::set<const QWidget*> reached;
    int steps = 0;
    for (int idle = 0; steps < kMostSteps && idle < kMostLinks; ++steps) {
        QWidget* now = window.focusWidget() ? window.focusWidget() : &window;
        QTest::keyClick(now, backwards ? Qt::Key_Backtab : Qt::Key_Tab, backwards ? Qt::ShiftModifier : Qt::NoModifier);
        if (const QWidget* next = window.focusWidget()) idle = reached.insert(next).second ? 0 : idle + 1;
    }
    EXPECT_LT(steps, kMostSteps) << "Tab never comes round";
    return reached;
}

/// Of buttons of which one is down, Tab reaches that one and the arrow keys the others.
bool reachedByArrows(const QWidget& control, const std::set<const QWidget*>& reached) {
    const auto* button = qobject_cast<const QAbstractButton*>(&control);
    if (!button || !button->group() || !button->group()->exclusive()) return false;
    const auto together = button->group()->buttons();
    return std::any_of(together.begin(), together.end(),
                       [&](const QAbstractButton* other) { return reached.contains(other); });
}

void expectReachable(QWidget& window) {
    for (const bool backwards : {false, true}) {
        const std::set<const QWidget*> reached = walk(window, backwards);
        for (const QWidget* control : controlsOf(window))
            EXPECT_TRUE(reached.contains(control) || reachedByArrows(*control, reached))
                << named(*control) << (backwards ? " by Shift+Tab" : " by Tab");
    }
}

void expectNames(QWidget& window) {
    for (QWidget* control : controlsOf(window)) {
        QAccessibleInterface* told = QAccessible::queryAccessibleInterface(control);
        ASSERT_NE(told, nullptr) << named(*control);
        EXPECT_FALSE(told->text(QAccessible::Name).trimmed().isEmpty()) << named(*control);
    }
}

class Keyboard : public ::testing::Test {
protected:
    void SetUp() override {
        QSettings(QSettings::IniFormat, QSettings::UserScope, "lumorph", "studio").clear();
        studio = std::make_unique<Studio>();
        test::drawLittle(*studio);
        window = std::make_unique<MainWindow>(*studio, makeWorkspaces(*studio));
        window->resize(1500, 950);
        window->show();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
        studio->project.openDemo("field");
        ASSERT_TRUE(eventually([&] {
            const auto& frame = studio->loop.frame();
            return frame && frame->matched && studio->jobs.running().empty();
        }));
        test::setPlaying(*studio, false);
    }

    /// Docks behind others are raised one after another, each with what it shows.
    void expectAll(const QString& workspace) {
        window->showWorkspace(workspace);
        test::pass(std::chrono::milliseconds(200));
        for (QDockWidget* dock : window->findChildren<QDockWidget*>()) {
            if (dock->isHidden() || !dock->parentWidget()->isVisible()) continue;
            SCOPED_TRACE(dock->objectName().toStdString());
            dock->raise();
            test::pass(std::chrono::milliseconds(50));
            expectReachable(*window);
            expectNames(*window);
        }
    }

    /// The inspector with all its sections unfolded.
    void expectFoldsAway() {
        auto* dock = window->findChild<QDockWidget*>("dock.scene.inspector");
        for (auto* section : dock->findChildren<QAbstractButton*>())
            if (section->objectName().contains(".section.") && section->isVisible() && !section->isChecked())
                section->click();
        test::pass(std::chrono::milliseconds(100));
        expectReachable(*window);
        expectNames(*window);
    }

    void expectDialog(const char* command) {
        SCOPED_TRACE(command);
        QAction* action = studio->commands.find(command);
        ASSERT_NE(action, nullptr);
        ASSERT_TRUE(action->isEnabled());
        action->trigger();
        QDialog* dialog = nullptr;
        ASSERT_TRUE(eventually([&] {
            for (auto* one : window->findChildren<QDialog*>())
                if (one->isVisible()) dialog = one;
            return dialog != nullptr;
        }));
        ASSERT_TRUE(QTest::qWaitForWindowActive(dialog));
        expectReachable(*dialog);
        expectNames(*dialog);
        dialog->close();
        ASSERT_TRUE(eventually([&] { return window->isActiveWindow(); }));
    }

    test::SessionFiles files;
    std::unique_ptr<Studio> studio;
    std::unique_ptr<MainWindow> window;
};

TEST_F(Keyboard, ReachesEveryControlOfTheFieldWorkspace) { expectAll("field"); }

TEST_F(Keyboard, ReachesEveryControlOfTheRigWorkspace) { expectAll("rig"); }

TEST_F(Keyboard, ReachesEveryControlOfTheSceneWorkspace) { expectAll("scene"); }

TEST_F(Keyboard, ReachesEveryControlOfTheCalibrateWorkspace) { expectAll("calibrate"); }
TEST_F(Keyboard, ReachesEveryControlOfTheDevicesWorkspace) { expectAll("devices"); }

TEST_F(Keyboard, ReachesEverythingOfWhatIsChosen) {
    window->showWorkspace("scene");
    auto* tree = window->findChild<QTreeView*>("scene.outliner");
    ASSERT_NE(tree, nullptr);
    window->findChild<QDockWidget*>("dock.scene.outliner")->raise();
    for (const char* command : {"scene.add.water", "scene.add.sun", "scene.add.box"}) {
        studio->commands.find(command)->trigger();
        expectFoldsAway();
    }
    for (const QModelIndex setup = tree->model()->index(1, 0); const int row : {0, 2, 3}) {
        tree->setCurrentIndex(tree->model()->index(row, 0, setup)); // device, projector, viewer
        expectFoldsAway();
    }
}

TEST_F(Keyboard, ReachesTheFieldsControlsInEveryView) {
    window->showWorkspace("field");
    auto* dock = window->findChild<QDockWidget*>("dock.field");
    ASSERT_NE(dock, nullptr);
    dock->raise();
    for (const char* mode : {"field.show.voxels", "field.show.surface", "field.show.nothing"}) {
        SCOPED_TRACE(mode);
        auto* button = window->findChild<QAbstractButton*>(mode);
        ASSERT_NE(button, nullptr);
        button->click();
        test::pass(std::chrono::milliseconds(100));
        expectReachable(*window);
        expectNames(*window);
    }
}

TEST_F(Keyboard, ReachesEveryControlOfTheDialogs) {
    window->showWorkspace("field");
    for (const char* command : {"settings", "help.guide", "help.shortcuts", "help.about", "field.build", "export.mesh",
                                "export.picture", "export.turntable"})
        expectDialog(command);
}

TEST_F(Keyboard, ReachesTheRemediesOfANotice) {
    window->showWorkspace("field");
    files.writeText("broken.obj", "v 0 0 0\nf 1 2 9\n");
    studio->project.open(files / "broken.obj");
    ASSERT_TRUE(eventually([&] { return !studio->notices.at("target").empty(); }));
    auto* dock = window->findChild<QDockWidget*>("dock.target");
    ASSERT_NE(dock, nullptr);
    dock->raise();
    test::pass(std::chrono::milliseconds(100));
    expectReachable(*window);
    expectNames(*window);
}

} // namespace
} // namespace lumorph::studio
