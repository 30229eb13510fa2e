#include "app/workspaces/rig/draw_sheet.h"

#include <cstdio>
#include <fstream>

#include <QElapsedTimer>
#include <gtest/gtest.h>

#include "app/workspaces/rig/sheet_canvas.h"
#include "app/workspaces/rig/sheet_history.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/sheet_file.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

/// A maker before the page; what the hand does is counted.
struct DrawSheet : testing::Test {
    void SetUp() override {
        window.command("New device");
        click("rig.new.kind.sheet");
        ASSERT_TRUE(eventually([&] {
            auto* draw = window.findNow<QPushButton>("rig.new.draw");
            return draw && draw->isEnabled();
        }));
        click("rig.new.draw");
        canvas = window.find<SheetCanvas>("sheet.canvas");
        ASSERT_NE(canvas, nullptr);
        ASSERT_TRUE(ready());
    }
    void click(const QString& name) {
        ++hands;
        window.click(name);
    }
    void key(Qt::Key code, Qt::KeyboardModifiers modifiers = {}) {
        ++hands;
        QTest::keyClick(canvas, code, modifiers);
    }
    /// Centimetres on the page.
    [[nodiscard]] QPoint at(double x, double y) const { return canvas->view().pixel({0.01 * x, 0.01 * y}).toPoint(); }
    void press(double x, double y) {
        ++hands;
        QTest::mouseClick(canvas, Qt::LeftButton, {}, at(x, y));
    }
    void drag(double x, double y, double toX, double toY, Qt::KeyboardModifiers modifiers = {}) {
        ++hands;
        QTest::mousePress(canvas, Qt::LeftButton, modifiers, at(x, y));
        for (int step = 1; step <= 8; ++step) move(x + (toX - x) * step / 8.0, y + (toY - y) * step / 8.0, modifiers);
        QTest::mouseRelease(canvas, Qt::LeftButton, modifiers, at(toX, toY));
    }
    /// With the button down, as a hand that drags.
    void move(double x, double y, Qt::KeyboardModifiers modifiers = {}) {
        const QPoint place = at(x, y);
        QMouseEvent event(QEvent::MouseMove, place, canvas->mapToGlobal(place), Qt::NoButton, Qt::LeftButton,
                          modifiers);
        QCoreApplication::sendEvent(canvas, &event);
    }
    /// What is drawn was made.
    [[nodiscard]] bool ready() {
        return eventually([&] {
            auto* accept = window.findNow<QPushButton>("sheet.accept");
            return accept && accept->isEnabled() && window.studio().jobs.running().empty();
        });
    }
    [[nodiscard]] bool refused() {
        return eventually([&] {
            auto* wrong = window.findNow<QLabel>("sheet.wrong");
            return wrong && !wrong->text().isEmpty();
        });
    }
    [[nodiscard]] QString facts() { return window.text("sheet.facts"); }
    void petal() {
        click("sheet.tool.ellipse");
        drag(-3.0, 0.5, 3.0, -8.5);
        drag(-4.0, -4.0, 4.0, -4.0); // generously: it ends at the edge
    }
    /// The rig that is made.
    std::shared_ptr<const Rig> make(std::size_t actuators) {
        const auto before = window.state().rig.rig;
        click("sheet.accept");
        EXPECT_TRUE(eventually(
            [&] { return window.state().rig.rig != before && window.state().rig.rig->actuatorCount() == actuators; }));
        return window.state().rig.rig;
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session"};
    SheetCanvas* canvas = nullptr;
    int hands = 1; ///< clicks, drags and keys, with the one that opened New device
};

TEST_F(DrawSheet, AFlowerOfFourPetalsTakesFewClicksAndIsAClosedSolid) {
    const StudioState before = window.state();
    petal();
    EXPECT_EQ(window.text("sheet.around"), "Line around");
    key(Qt::Key_Escape);
    EXPECT_EQ(window.text("sheet.around"), "All around");
    click("sheet.around");
    ASSERT_TRUE(eventually([&] { return facts().contains("Servos: 4"); })) << window.text("sheet.wrong").toStdString();
    ASSERT_TRUE(ready());
    window.screenshot("draw_sheet_flower");
    EXPECT_EQ(window.state().rig.rig, before.rig.rig) << "nothing changes before it is accepted";
    const auto rig = make(4);
    RecordProperty("clicks", hands);
    EXPECT_LE(hands, 40);
    EXPECT_LE(hands, 10) << "and it is fewer than that";
    for (const double stroke : {0.0, 0.3, 0.7, 1.0})
        EXPECT_TRUE(checkMesh(deformed(*rig, std::vector<double>(4, stroke))).solid()) << stroke;
    EXPECT_NEAR(static_cast<double>(rig->reach().size().x), 0.17, 0.005) << "17 cm from tip to tip";
    EXPECT_NEAR(static_cast<double>(rig->reach().size().z), 0.17, 0.005);
    // One step of undo, which gives back the very rig from before.
    while (window.state().rig.rig != before.rig.rig && window.studio().document.undoStack().canUndo())
        window.studio().document.undoStack().undo();
    EXPECT_EQ(window.state().rig.rig, before.rig.rig);
    EXPECT_EQ(window.state().field.field, before.field.field);
}

TEST_F(DrawSheet, UndoGivesBackEachDrawingByteForByte) {
    std::vector<std::string> drawings;
    const auto remember = [&] {
        QCoreApplication::processEvents();
        drawings.push_back(writeSheetDevice(canvas->device()));
    };
    remember();
    petal();
    key(Qt::Key_Z, Qt::ControlModifier); // the line is gone, the ellipse is there
    remember();
    drag(-4.0, -4.0, 4.0, -4.0);
    remember();
    window.enter("sheet.line.angle", "60", Qt::Key_Tab);
    remember();
    click("sheet.line.free");
    remember();
    ASSERT_TRUE(ready());
    click("sheet.line.side");
    remember();
    key(Qt::Key_Escape);
    click("sheet.mirror");
    click("sheet.around");
    remember();
    window.enter("sheet.width", "30 cm", Qt::Key_Tab);
    remember();
    key(Qt::Key_V);
    drag(0.0, -4.0, 0.0, -5.0); // the first line
    remember();
    key(Qt::Key_Delete);
    remember();
    for (std::size_t k = 1; k < drawings.size(); ++k) EXPECT_NE(drawings[k], drawings[k - 1]) << k;
    for (std::size_t k = drawings.size() - 1; k-- > 0;) {
        click("sheet.undo");
        EXPECT_EQ(writeSheetDevice(canvas->device()), drawings[k]) << k;
    }
    for (std::size_t k = 1; k < drawings.size(); ++k) {
        key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
        EXPECT_EQ(writeSheetDevice(canvas->device()), drawings[k]) << k;
    }
}

TEST_F(DrawSheet, ALineInTheWayIsToldAndNothingCanBeMadeUntilItIsGone) {
    drag(5.0, -7.5, 5.0, 7.5);
    ASSERT_TRUE(ready());
    drag(5.3, -3.0, 9.0, -3.0, Qt::ControlModifier); // in the flap of the first one
    ASSERT_TRUE(refused());
    EXPECT_TRUE(window.text("sheet.wrong").startsWith("Bend line 'flap 2': "))
        << window.text("sheet.wrong").toStdString();
    EXPECT_TRUE(window.text("sheet.hint").contains("red line"));
    EXPECT_FALSE(window.find<QPushButton>("sheet.accept")->isEnabled());
    EXPECT_TRUE(facts().contains("Servos: 1")) << "the others are seen without it";
    window.screenshot("draw_sheet_refused");
    key(Qt::Key_Delete);
    ASSERT_TRUE(ready());
    EXPECT_FALSE(window.findNow<QLabel>("sheet.wrong"));
}

TEST_F(DrawSheet, AnOutlineIsDrawnByCornersAndTakenFromAFile) {
    key(Qt::Key_P);
    for (const auto& [x, y] : {std::pair(-8.0, 6.0), {8.0, 6.0}, {8.0, -2.0}, {2.0, -7.0}}) press(x, y);
    key(Qt::Key_Backspace);
    press(0.0, -6.0);
    press(-8.0, -2.0);
    key(Qt::Key_Return);
    ASSERT_EQ(canvas->device().outline.size(), 5U);
    EXPECT_NEAR(canvas->device().outline[3].y, -0.06, 1e-9);
    EXPECT_EQ(canvas->tool(), SheetTool::line) << "the next thing to do";
    // A corner that is dragged, and one more.
    key(Qt::Key_V);
    drag(0.0, -6.0, 0.0, -7.0);
    EXPECT_NEAR(canvas->device().outline[3].y, -0.07, 1e-9);
    QTest::mouseDClick(canvas, Qt::LeftButton, {}, at(3.0, 6.0));
    EXPECT_EQ(canvas->device().outline.size(), 6U);

    std::ofstream(folder / "plate.svg")
        << R"(<svg xmlns="http://www.w3.org/2000/svg"><circle cx="50mm" cy="50mm" r="60mm"/></svg>)";
    std::ofstream(folder / "nothing.svg") << R"(<svg xmlns="http://www.w3.org/2000/svg"><line x1="0" x2="9"/></svg>)";
    window.click("sheet.import");
    test::answerFileDialog(window, "dialog.svg", folder / "nothing.svg", "Open");
    ASSERT_TRUE(refused());
    EXPECT_TRUE(window.text("sheet.wrong").contains("nothing.svg")) << window.text("sheet.wrong").toStdString();
    EXPECT_EQ(canvas->device().outline.size(), 6U);
    window.click("sheet.import");
    test::answerFileDialog(window, "dialog.svg", folder / "plate.svg", "Open");
    ASSERT_TRUE(eventually([&] { return canvas->device().outline.size() > 20; }));
    for (const glm::dvec2& p : canvas->device().outline) EXPECT_NEAR(glm::length(p), 0.06, 1e-4);
}

TEST_F(DrawSheet, TheDrawingOfADeviceIsTakenUpAgainWithWhatItsActuatorsWereGiven) {
    drag(5.0, -7.5, 5.0, 7.5);
    drag(-5.0, -7.5, -5.0, 7.5);
    ASSERT_TRUE(eventually([&] { return facts().contains("Servos: 2"); }));
    ASSERT_TRUE(ready());
    const auto rig = make(2);
    auto parts = std::make_shared<RigParts>(rig->parts());
    parts->actuators[0].name = "wing";
    parts->actuators[0].drive.channel = 9;
    window.studio().document.change("Edit", [&](StudioState& state) { state.rig.parts = parts; });
    window.command("Edit the drawing");
    ASSERT_TRUE(ready());
    ASSERT_EQ(canvas->device().bends.size(), 2U);
    EXPECT_EQ(canvas->device().bends[0].name, "wing");
    drag(-10.5, 0.0, -7.0, 0.0); // nothing bends there: it is refused
    key(Qt::Key_Z, Qt::ControlModifier);
    key(Qt::Key_V);
    drag(5.0, 2.0, 4.0, 2.0); // and at once, before the solid is there:
    const auto again = make(2);
    EXPECT_FALSE(canvas->isVisible());
    EXPECT_EQ(again->actuators()[0].drive.channel, 9);
    EXPECT_EQ(again->actuators()[0].name, "wing");
    EXPECT_NE(again->restMesh(), rig->restMesh());
}

// 60 moves a second for two seconds with the solid made beside: the window answers, and the last move counts. Where the
// machine is busy with other things it is tried again.
TEST_F(DrawSheet, DraggingAtSixtyMovesASecondStallsNothingAndLosesNothing) {
    test::setPlaying(window.studio(), true);
    petal();
    key(Qt::Key_Escape);
    click("sheet.around");
    ASSERT_TRUE(ready());
    key(Qt::Key_V);
    constexpr int kMoves = 120;
    double rate = 0.0, longest = 1e9;
    for (int attempt = 0; attempt < 4 && longest > 100.0; ++attempt) {
        ASSERT_TRUE(ready());
        const double start = 100.0 * canvas->device().bends[0].from.y;
        const double way = start < -4.5 ? 1.0 : -1.0;
        test::StallWatch watch;
        (void)watch.takeLongest();
        QElapsedTimer time;
        time.start();
        QTest::mousePress(canvas, Qt::LeftButton, {}, at(0.0, start));
        for (int k = 1; k <= kMoves; ++k) {
            move(0.0, start + way * (0.2 + 1.3 * k / kMoves));
            (void)eventually([&] { return time.elapsed() >= k * 1000 / 60; }, std::chrono::seconds(2));
        }
        rate = kMoves / (1e-3 * static_cast<double>(time.elapsed()));
        QTest::mouseRelease(canvas, Qt::LeftButton, {}, at(0.0, start + way * 1.5));
        longest = watch.takeLongest();
        std::printf("%.1f moves a second, longest wait %.1f ms\n", rate, longest);
        EXPECT_NEAR(100.0 * canvas->device().bends[0].from.y, start + way * 1.5, 1e-6) << "the last move counts";
    }
    EXPECT_GE(rate, 55.0);
    EXPECT_LT(longest, 100.0);
    ASSERT_TRUE(ready());
    const auto rig = make(4);
    const SheetDevice drawing = parseSheetDevice(rig->parts().drawing, "drawing");
    EXPECT_EQ(drawing, canvas->device());
    EXPECT_TRUE(sheetRig(drawing).parts() == rig->parts()) << "taken up again it makes the very same device";
}

TEST(SheetHistory, AStepAfterUndoTakesThePlaceOfThoseUndone) {
    SheetHistory history;
    for (const char* name : {"a", "b", "c"}) {
        SheetDevice device = history.now();
        device.name = name;
        history.push(device, name);
    }
    history.undo();
    history.undo();
    EXPECT_EQ(history.now().name, "a");
    EXPECT_EQ(history.redoText(), "b");
    SheetDevice other = history.now();
    other.name = "d";
    history.push(other, "d");
    EXPECT_FALSE(history.canRedo());
    for (int k = 0; k < 5; ++k) history.undo();
    EXPECT_EQ(history.now(), SheetDevice{});
    EXPECT_FALSE(history.canUndo());
}

} // namespace
} // namespace lumorph::studio
