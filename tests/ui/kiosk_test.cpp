#include <QAbstractButton>
#include <QDragEnterEvent>
#include <QMenuBar>
#include <QMimeData>
#include <QToolButton>
#include <QUrl>
#include <QWheelEvent>

#include "app/studio/base/operator_pin.h"
#include "app/workspaces/scene/scene_central_view.h"
#include "core/base/resources.h"
#include "tests/ui/studio_window.h"

// What a visitor can do before the kiosk: stop it, choose among demonstrations, and nothing else.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

/// A demonstration is open: visitors may choose another.
const QStringList kShut{"bar.leaveKiosk", "stop", "visitors.cards", "visitors.language"};
const QStringList kStopped{"bar.leaveKiosk", "resume", "stop", "visitors.cards", "visitors.language"};

class KioskTest : public ::testing::Test {
protected:
    KioskTest() { studio::OperatorPin::forget(window.studio().settings); }
    ~KioskTest() override { studio::OperatorPin::forget(window.studio().settings); }

    /// On the screen, as by a finger.
    void tap(const QString& digits) {
        for (const QChar digit : digits) window.click(QString("pin.digit.") + digit);
        window.click("pin.accept");
    }
    void choosePinOnTheWay() {
        tap("2718");
        tap("2718");
    }
    void enter() {
        window.studio().commands.find("view.kiosk")->trigger();
        choosePinOnTheWay();
        ASSERT_TRUE(eventually([&] { return window.window().isFullScreen() && !pad(); }));
        ASSERT_TRUE(QTest::qWaitForWindowActive(&window.window()));
    }
    [[nodiscard]] QWidget* pad() { return window.findNow<QWidget>("pin"); }
    [[nodiscard]] bool stopped() { return window.studio().loop.stopped(); }
    [[nodiscard]] QStringList buttonsInSight() {
        QStringList names;
        for (const QWidget* top : QApplication::topLevelWidgets())
            for (const QAbstractButton* button : top->findChildren<QAbstractButton*>())
                if (button->isVisible()) names << button->objectName();
        names.sort();
        return names;
    }
    [[nodiscard]] static int windowsInSight() {
        int count = 0;
        for (const QWidget* top : QApplication::topLevelWidgets()) count += top->isVisible() ? 1 : 0;
        return count;
    }

    TemporaryFolder folder;
    StudioWindow window{folder / "session", "scene"};
};

TEST_F(KioskTest, HearsNothingButStop) {
    auto& studio = window.studio();
    const studio::StudioState before = window.state();
    enter();
    window.screenshot("kiosk");
    EXPECT_EQ(buttonsInSight(), kShut);
    for (const auto& entry : studio.commands.all())
        EXPECT_FALSE(entry.action->isVisible()) << entry.action->objectName().toStdString();
    const int steps = studio.document.undoStack().index();
    const bool plays = studio.loop.scenePlaying();
    const Theme theme = studio.settings.theme();

    for (const auto& entry : studio.commands.all())
        for (const QKeySequence& keys : entry.action->shortcuts()) QTest::keySequence(&window.window(), keys);
    for (const Qt::Key key : {Qt::Key_F10, Qt::Key_Menu, Qt::Key_Space, Qt::Key_Return, Qt::Key_Tab, Qt::Key_Delete,
                              Qt::Key_F, Qt::Key_1, Qt::Key_Plus, Qt::Key_Left})
        QTest::keyClick(&window.window(), key);
    QTest::keyClick(&window.window(), Qt::Key_F, Qt::AltModifier);
    auto* pane = window.find<QWidget>("scene.eye");
    const QPoint middle = pane->rect().center();
    for (const Qt::MouseButton button : {Qt::LeftButton, Qt::RightButton, Qt::MiddleButton}) {
        QTest::mousePress(pane, button, {}, middle);
        for (int step = 1; step <= 8; ++step) QTest::mouseMove(pane, middle + QPoint(10 * step, 4 * step));
        QTest::mouseRelease(pane, button, {}, middle + QPoint(80, 32));
        QTest::mouseClick(pane, button, {}, middle);
        QTest::mouseDClick(pane, button, {}, middle);
    }
    QWheelEvent wheel(middle, pane->mapToGlobal(middle), {}, QPoint(0, 240), Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(pane, &wheel);
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString(resourceFile("targets/dunes.glb").string()))});
    for (QWidget* onto : {static_cast<QWidget*>(&window.window()), pane}) {
        QDragEnterEvent enters(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(onto, &enters);
        EXPECT_FALSE(enters.isAccepted());
        QDropEvent drops(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(onto, &drops);
        EXPECT_FALSE(drops.isAccepted());
    }
    pass(400ms);

    EXPECT_EQ(windowsInSight(), 1);
    EXPECT_EQ(buttonsInSight(), kShut);
    EXPECT_TRUE(window.window().isFullScreen());
    EXPECT_EQ(window.window().workspace(), "scene");
    EXPECT_EQ(studio.document.undoStack().index(), steps);
    EXPECT_EQ(*window.state().scene, *before.scene);
    EXPECT_EQ(*window.state().installation, *before.installation) << "nor does a drag lead the viewer";
    EXPECT_EQ(window.state().target.target, before.target.target);
    EXPECT_EQ(studio.loop.scenePlaying(), plays);
    EXPECT_EQ(studio.settings.theme(), theme);
    EXPECT_FALSE(stopped());

    // A desktop's own way to close it, or to shrink it.
    window.window().close();
    EXPECT_TRUE(window.window().isVisible());
    ASSERT_NE(pad(), nullptr) << "the operator may";
    window.click("pin.cancel");
    window.window().showNormal();
    EXPECT_TRUE(eventually([&] { return window.window().isFullScreen(); }));
    window.window().closeNow();
    EXPECT_FALSE(window.window().isVisible()) << "the system ends it";
}

TEST_F(KioskTest, StopIsForAnyoneAndResumeForTheOperator) {
    enter();
    window.click("stop");
    EXPECT_TRUE(stopped());
    EXPECT_EQ(buttonsInSight(), kStopped);
    window.click("resume");
    ASSERT_TRUE(eventually([&] { return pad() != nullptr; }));
    EXPECT_TRUE(stopped());
    window.screenshot("kiosk-resume");
    window.click("pin.cancel");
    EXPECT_TRUE(stopped());
    window.click("resume");
    tap("1414");
    EXPECT_TRUE(stopped());
    EXPECT_NE(pad(), nullptr);
    EXPECT_EQ(window.text("pin.message"), "That is not the PIN.");
    // By keys as well.
    QTest::keyClicks(pad(), "2718");
    QTest::keyClick(pad(), Qt::Key_Return);
    EXPECT_TRUE(eventually([&] { return !stopped(); }));
    EXPECT_EQ(pad(), nullptr);
    EXPECT_TRUE(window.window().isFullScreen()) << "the doors stay closed";

    QTest::keyClick(&window.window(), Qt::Key_Escape);
    QTest::keyClick(&window.window(), Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return stopped(); }));
    window.click("resume");
    tap("2718");
    ASSERT_TRUE(eventually([&] { return !stopped(); }));
    // The pad keeps nobody from it.
    window.click("bar.leaveKiosk");
    ASSERT_TRUE(eventually([&] { return pad() != nullptr; }));
    QTest::keyClick(pad(), Qt::Key_Escape);
    QTest::keyClick(pad(), Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return stopped(); }));
    window.studio().loop.resume();
    window.click("stop");
    EXPECT_TRUE(stopped());
}

TEST_F(KioskTest, TheOperatorLeavesByThePinAndAllIsAsItWas) {
    auto* outliner = window.find<QWidget>("dock.scene.outliner");
    pass(100ms); // the first layout
    ASSERT_TRUE(eventually([&] { return !buttonsInSight().contains("job.cancel"); })) << "the field is being read";
    const QStringList before = buttonsInSight();
    enter();
    EXPECT_FALSE(outliner->isVisible());
    window.click("bar.leaveKiosk");
    for (int attempt = 1; attempt <= 5; ++attempt) {
        EXPECT_TRUE(window.find<QAbstractButton>("pin.digit.1")->isEnabled()) << attempt;
        tap("1111");
    }
    EXPECT_TRUE(eventually([&] { return window.text("pin.message").contains("wrong tries"); }));
    EXPECT_FALSE(window.find<QAbstractButton>("pin.digit.2")->isEnabled());
    QTest::keyClicks(pad(), "2718");
    QTest::keyClick(pad(), Qt::Key_Return);
    EXPECT_TRUE(window.window().isFullScreen());
    window.screenshot("kiosk-pause");
    window.click("pin.cancel");

    // The documented way out: another process forgets it, and the lock opens by itself.
    {
        studio::Settings other;
        studio::OperatorPin::forget(other);
    }
    window.click("bar.leaveKiosk");
    EXPECT_TRUE(eventually([&] { return !window.window().isFullScreen() && outliner->isVisible(); }));
    EXPECT_TRUE(window.find<QMenuBar>("")->isVisible());
    window.command("device workspace");

    // Again, and out by the right one.
    window.window().showWorkspace("scene");
    enter();
    window.click("bar.leaveKiosk");
    tap("2718");
    EXPECT_TRUE(eventually([&] { return !window.window().isFullScreen() && outliner->isVisible(); }));
    EXPECT_TRUE(eventually([&] { return buttonsInSight() == before; })) << before.join(" ").toStdString() << "\n"
                                                                        << buttonsInSight().join(" ").toStdString();
    QTest::keyClick(&window.window(), Qt::Key_2, Qt::ControlModifier);
    EXPECT_TRUE(eventually([&] { return window.window().workspace() == "field"; })) << "keys work again";
}

TEST_F(KioskTest, AStartAsAKioskClosesTheDoorsBeforeItAsksForAPin) {
    window.window().showWorkspace("devices"); // has nothing for visitors
    window.window().enterKiosk();
    ASSERT_NE(pad(), nullptr);
    EXPECT_EQ(window.findNow<QWidget>("pin.cancel"), nullptr);
    EXPECT_EQ(window.window().workspace(), "scene");
    EXPECT_TRUE(eventually([&] { return window.window().isFullScreen(); }));
    tap("2718");
    tap("2717");
    EXPECT_TRUE(window.text("pin.message").contains("not the same"));
    choosePinOnTheWay();
    EXPECT_EQ(pad(), nullptr);
    EXPECT_EQ(buttonsInSight(), kShut);
}

} // namespace
} // namespace lumorph::test
