#include <cmath>
#include <fstream>
#include <memory>

#include <QAccessible>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>
#include <gtest/gtest.h>

#include "app/applications/labyrinth/board.h"
#include "app/workspaces/levels/level_canvas.h"
#include "app/workspaces/levels/level_draft.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

// Levels of the labyrinth, painted: the draft without a window, and the window with mouse and keys.

namespace lumorph::studio {
namespace {

using labyrinth::bundledLevels;
using labyrinth::checkLevel;
using labyrinth::kMaxCells;
using labyrinth::kMaze;
using labyrinth::kMinCells;
using labyrinth::Level;
using labyrinth::levelText;
using labyrinth::PickUp;
using labyrinth::readLevel;
using labyrinth::readLevelFile;
using labyrinth::Tile;
using labyrinth::Way;
using test::eventually;
using Kind = LevelPiece::Kind;

TEST(LevelDraft, BeginsAsARoomThatCanBePlayed) {
    const LevelDraft draft;
    EXPECT_NO_THROW(checkLevel(draft.level()));
    EXPECT_EQ(draft.firstFinding(), nullptr);
    EXPECT_EQ(draft.way().front(), draft.level().start);
    EXPECT_EQ(draft.way().back(), draft.level().goal);
    EXPECT_FALSE(draft.canUndo());
    EXPECT_FALSE(draft.canRedo());
}

TEST(LevelDraft, EveryPieceIsWhatTheTextSaysByItsSign) {
    ASSERT_EQ(offeredPieces().size(), 20U);
    for (const OfferedPiece& offered : offeredPieces()) {
        // A room of five rows with the piece in its middle; the text is written by hand.
        std::string map = "#########\n#@.....X#\n#.......#\n#.......#\n#########\n";
        if (offered.piece.kind == Kind::start) map[10 + 1] = '.';
        if (offered.piece.kind == Kind::goal) map[10 + 7] = '.';
        map[2 * 10 + 4] = offered.sign;
        LevelDraft draft;
        draft.resize(9, 5);
        draft.beginStroke("a");
        draft.put({Kind::start}, {1, 1}, 0);
        draft.put({Kind::goal}, {7, 1}, 0);
        draft.put({Kind::floor}, {7, 3}, 0);
        draft.put(offered.piece, {4, 2}, 0);
        // Ramps and bridges want heights around them, so what is compared is the cell alone.
        const std::string heights = "heights:\n000000000\n000000000\n000000000\n000000000\n000000000\n";
        const bool plain = offered.piece.kind != Kind::ramp && offered.piece.kind != Kind::stairs &&
                           offered.piece.kind != Kind::bridge;
        if (plain) {
            const Level read = readLevel("lumorph labyrinth 1\nmap:\n" + map + heights, offered.name);
            EXPECT_EQ(draft.level().cells, read.cells) << offered.name;
            EXPECT_EQ(draft.level().start, read.start) << offered.name;
            EXPECT_EQ(draft.level().goal, read.goal) << offered.name;
        } else {
            EXPECT_EQ(draft.level().at({4, 2}).way, offered.piece.way) << offered.name;
            ASSERT_NE(draft.firstFinding(), nullptr) << offered.name << " leads nowhere";
            EXPECT_EQ(draft.firstFinding()->cell, glm::ivec2(4, 2)) << offered.name;
            EXPECT_TRUE(draft.firstFinding()->prevents);
        }
    }
}

TEST(LevelDraft, AStrokeIsOneStepOfUndo) {
    LevelDraft draft;
    const Level before = draft.level();
    draft.beginStroke("Wall");
    for (int column = 3; column < 9; ++column) draft.put({Kind::wall}, {column, 4}, 0);
    const Level walls = draft.level();
    draft.beginStroke("Hole");
    draft.put({Kind::hole}, {5, 7}, 2);
    EXPECT_EQ(draft.level().at({5, 7}).height, 2);
    EXPECT_EQ(draft.undoName(), "Hole");
    draft.undo();
    EXPECT_EQ(draft.level(), walls);
    EXPECT_EQ(draft.undoName(), "Wall");
    EXPECT_EQ(draft.redoName(), "Hole");
    draft.undo();
    EXPECT_EQ(draft.level(), before);
    EXPECT_FALSE(draft.canUndo());
    draft.redo();
    EXPECT_EQ(draft.level(), walls);
    draft.beginStroke("Start");
    draft.put({Kind::start}, {2, 2}, 0);
    EXPECT_FALSE(draft.canRedo()) << "what was undone is gone";
}

TEST(LevelDraft, WhatChangesNothingIsNoStep) {
    LevelDraft draft;
    draft.beginStroke("Floor");
    draft.put({Kind::floor}, {4, 4}, 0); // is floor
    draft.put({Kind::floor}, {0, 4}, 0); // the rim
    draft.put({Kind::hole}, {-3, 99}, 0);
    draft.put({Kind::pickUp}, draft.level().start, 0);
    draft.put({Kind::goal}, draft.level().start, 0);
    EXPECT_FALSE(draft.canUndo());
    draft.change(draft.level(), "Nothing");
    draft.change(Level{}, "No level");
    EXPECT_FALSE(draft.canUndo());
}

TEST(LevelDraft, RampsAndBridgesTakeTheirHeightsFromWhatLiesBesideThem) {
    LevelDraft draft;
    draft.beginStroke("A way up");
    // Three ramps one after another from floor of height 0 to floor of height 3.
    for (int column = 4; column <= 6; ++column) draft.put({Kind::ramp, Way::right}, {column, 7}, 0);
    draft.put({Kind::floor}, {7, 7}, 3);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(draft.level().at({4 + k, 7}).height, k);
    EXPECT_EQ(draft.firstFinding(), nullptr) << draft.firstFinding()->text;
    // A bridge between banks of height 6, over a passage of height 0.
    draft.put({Kind::floor}, {10, 4}, 6);
    draft.put({Kind::floor}, {12, 4}, 6);
    draft.put({Kind::bridge, Way::left}, {11, 4}, 7);
    EXPECT_EQ(draft.level().at({11, 4}).height, 0);
    EXPECT_EQ(draft.level().at({11, 4}).way, Way::right) << "as its sign says it";
    EXPECT_EQ(draft.firstFinding(), nullptr);
    EXPECT_EQ(readLevel(levelText(draft.level()), "text"), draft.level());
}

TEST(LevelDraft, SaysWhatCannotBeReached) {
    LevelDraft draft;
    draft.beginStroke("Wall");
    const glm::ivec2 goal = draft.level().goal;
    draft.put({Kind::wall}, goal + glm::ivec2(-1, 0), 0);
    draft.put({Kind::wall}, goal + glm::ivec2(0, -1), 0);
    draft.put({Kind::wall}, goal + glm::ivec2(-1, -1), 0);
    ASSERT_NE(draft.firstFinding(), nullptr);
    EXPECT_NE(draft.firstFinding()->text.find("goal cannot be reached"), std::string::npos);
    EXPECT_FALSE(draft.firstFinding()->prevents) << "one may play it and see";
    EXPECT_TRUE(draft.way().empty());
    draft.undo();
    EXPECT_EQ(draft.firstFinding(), nullptr);
    draft.beginStroke("A closed room with a pick-up");
    for (const glm::ivec2 cell : {glm::ivec2(9, 6), {9, 7}, {9, 8}, {10, 6}, {10, 8}, {11, 6}, {11, 7}, {11, 8}})
        draft.put({Kind::wall}, cell, 0);
    draft.put({Kind::pickUp, Way::right, PickUp::blue}, {10, 7}, 0);
    ASSERT_NE(draft.firstFinding(), nullptr);
    EXPECT_EQ(draft.firstFinding()->cell, glm::ivec2(10, 7));
    EXPECT_FALSE(draft.way().empty()) << "the goal is reached all the same";
    draft.put({Kind::wall}, draft.level().start, 0);
    ASSERT_NE(draft.firstFinding(), nullptr);
    EXPECT_TRUE(draft.firstFinding()->prevents);
    EXPECT_EQ(draft.firstFinding()->cell, draft.level().start);
}

TEST(LevelDraft, AnotherSizeKeepsWhatIsInside) {
    LevelDraft draft;
    draft.beginStroke("Hole");
    draft.put({Kind::hole}, {3, 3}, 1);
    draft.put({Kind::goal}, {18, 12}, 0);
    draft.resize(10, 8);
    EXPECT_EQ(draft.level().at({3, 3}).tile, Tile::hole);
    EXPECT_EQ(draft.level().goal, glm::ivec2(8, 6)) << "the goal stays inside";
    EXPECT_EQ(draft.firstFinding(), nullptr);
    draft.resize(48, 48);
    EXPECT_EQ(draft.level().at({3, 3}).tile, Tile::hole);
    EXPECT_EQ(draft.level().at({9, 5}).tile, Tile::floor) << "what was rim is room now";
    EXPECT_NO_THROW(checkLevel(draft.level()));
    draft.resize(500, -1);
    EXPECT_EQ(draft.level().columns, kMaxCells);
    EXPECT_EQ(draft.level().rows, kMinCells);
}

/// A maker before the window.
class LevelEditorWindow : public ::testing::Test {
protected:
    void SetUp() override {
        window.command("Levels of the labyrinth");
        canvas = window.find<LevelCanvas>("levels.canvas");
        ASSERT_NE(canvas, nullptr);
        ASSERT_TRUE(eventually([&] { return canvas->window()->isActiveWindow() && canvas->hasFocus(); }));
    }
    [[nodiscard]] QPoint at(int column, int row) const {
        return canvas->view().boxOf({column, row}).center().toPoint();
    }
    void drag(glm::ivec2 from, glm::ivec2 to) {
        QTest::mousePress(canvas, Qt::LeftButton, {}, at(from.x, from.y));
        const QPoint place = at(to.x, to.y);
        QMouseEvent event(QEvent::MouseMove, place, canvas->mapToGlobal(place), Qt::NoButton, Qt::LeftButton, {});
        QCoreApplication::sendEvent(canvas, &event);
        QTest::mouseRelease(canvas, Qt::LeftButton, {}, place);
    }
    /// As it is saved.
    [[nodiscard]] Level saved(const char* name) {
        const std::filesystem::path file = folder / name;
        window.click("levels.save");
        test::answerFileDialog(window, "dialog.levels.save", file);
        EXPECT_TRUE(eventually([&] { return std::filesystem::exists(file); }));
        return readLevelFile(file);
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session", "scene"};
    LevelCanvas* canvas = nullptr;
};

TEST_F(LevelEditorWindow, ALevelIsPaintedByMousePlayedAndSaved) {
    window.click("levels.piece.wall");
    drag({6, 1}, {6, 9}); // one fast move: all cells between
    drag({13, 13}, {13, 5});
    window.click("levels.piece.hole");
    QTest::mouseClick(canvas, Qt::LeftButton, {}, at(9, 7));
    window.click("levels.piece.yellow-pick-up");
    QTest::mouseClick(canvas, Qt::LeftButton, {}, at(10, 3));
    window.enter("levels.name", "Painted", Qt::Key_Tab);
    window.screenshot("level_editor");
    EXPECT_TRUE(window.text("levels.finding").contains("can be solved")) << window.text("levels.finding").toStdString();
    const Level level = saved("painted.txt");
    EXPECT_EQ(level.name, "Painted");
    for (int row = 1; row <= 9; ++row) EXPECT_EQ(level.at({6, row}).tile, Tile::wall) << row;
    EXPECT_EQ(level.at({6, 10}).tile, Tile::floor);
    EXPECT_EQ(level.at({9, 7}).tile, Tile::hole);
    EXPECT_EQ(level.at({10, 3}).pickUp, PickUp::yellow);
    window.click("levels.play");
    EXPECT_TRUE(eventually(
        [&] {
            const auto& frame = window.studio().loop.frame();
            const SceneItem* maze = frame && frame->scene ? findItem(*frame->scene, kMaze) : nullptr;
            return maze && maze->name == "Painted";
        },
        std::chrono::seconds(60)));
    EXPECT_EQ(window.studio().loop.driver(), Driver::program);
    EXPECT_EQ(window.window().workspace(), "scene");
    window.command("Levels of the labyrinth");
    EXPECT_EQ(saved("again.txt"), level) << "it is as it was";
}

TEST_F(LevelEditorWindow, KeysPutPiecesAndTakeThemBack) {
    canvas->setFocus();
    ASSERT_EQ(canvas->cursor(), glm::ivec2(1, 1));
    for (int k = 0; k < 3; ++k) QTest::keyClick(canvas, Qt::Key_Right);
    QTest::keyClick(canvas, '#');
    QTest::keyClick(canvas, Qt::Key_Space);
    for (int k = 0; k < 4; ++k) QTest::keyClick(canvas, Qt::Key_Down, Qt::ShiftModifier);
    EXPECT_EQ(canvas->cursor(), glm::ivec2(4, 5));
    EXPECT_TRUE(canvas->cursorText().contains("wall")) << canvas->cursorText().toStdString();
    QTest::keyClicks(canvas, "3");
    EXPECT_EQ(window.find<QSpinBox>("levels.height")->value(), 3);
    QTest::keyClicks(canvas, "]");
    EXPECT_EQ(window.find<QSpinBox>("levels.height")->value(), 4);
    QTest::keyClick(canvas, Qt::Key_Right);
    QTest::keyClicks(canvas, ".");
    QTest::keyClick(canvas, Qt::Key_Return);
    EXPECT_TRUE(canvas->cursorText().contains("4 steps")) << canvas->cursorText().toStdString();
    QTest::keyClick(canvas, Qt::Key_Left);
    QTest::keyClick(canvas, Qt::Key_Delete);
    EXPECT_FALSE(canvas->cursorText().contains("wall"));
    QTest::keyClick(canvas, Qt::Key_Z, Qt::ControlModifier);
    EXPECT_TRUE(canvas->cursorText().contains("wall"));
    QTest::keyClick(canvas, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_FALSE(canvas->cursorText().contains("wall"));
}

TEST_F(LevelEditorWindow, SaysWhatIsWrongAndPlaysNothingThatIsNoLevel) {
    window.click("levels.piece.ramp-up-to-the-right");
    QTest::mouseClick(canvas, Qt::LeftButton, {}, at(9, 7));
    EXPECT_TRUE(window.text("levels.finding").contains("column 10, row 8"))
        << window.text("levels.finding").toStdString();
    EXPECT_FALSE(window.find<QPushButton>("levels.play")->isEnabled());
    window.screenshot("level_editor_wrong");
    window.click("levels.undo");
    EXPECT_TRUE(window.find<QPushButton>("levels.play")->isEnabled());
    std::ofstream(folder / "no.txt") << "not a level";
    window.click("levels.open");
    test::answerFileDialog(window, "dialog.levels.open", folder / "no.txt", "Open");
    EXPECT_TRUE(eventually([&] { return window.text("levels.finding").contains("line 1"); }))
        << window.text("levels.finding").toStdString();
}

TEST_F(LevelEditorWindow, KeepsWhatIsNotFinishedYet) {
    window.click("levels.piece.ramp-up-to-the-right");
    QTest::mouseClick(canvas, Qt::LeftButton, {}, at(9, 7));
    ASSERT_FALSE(window.find<QPushButton>("levels.play")->isEnabled());
    const std::filesystem::path file = folder / "half.txt";
    window.click("levels.save");
    test::answerFileDialog(window, "dialog.levels.save", file);
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(file); }));
    EXPECT_TRUE(window.text("levels.finding").contains("cannot be played yet"))
        << window.text("levels.finding").toStdString();
    EXPECT_THROW((void)readLevelFile(file), DataError) << "the labyrinth itself does not take it";
    window.click("levels.undo");
    ASSERT_TRUE(window.find<QPushButton>("levels.play")->isEnabled());
    window.click("levels.open");
    test::answerFileDialog(window, "dialog.levels.open", file, "Open");
    EXPECT_TRUE(eventually([&] { return window.text("levels.finding").contains("column 10, row 8"); }))
        << window.text("levels.finding").toStdString();
    EXPECT_FALSE(window.find<QPushButton>("levels.play")->isEnabled());
}

TEST_F(LevelEditorWindow, OpensEveryLevelThatComesWithIt) {
    const auto* fresh = window.find<QToolButton>("levels.new");
    const std::vector<Level> levels = bundledLevels();
    const QList<QAction*> actions = fresh->menu()->actions();
    ASSERT_EQ(actions.size(), static_cast<qsizetype>(levels.size()) + 2);
    for (std::size_t k = 0; k < levels.size(); ++k) {
        actions[static_cast<qsizetype>(k) + 2]->trigger();
        EXPECT_TRUE(window.text("levels.finding").contains("can be solved"))
            << levels[k].name << ": " << window.text("levels.finding").toStdString();
        if (k == 7) window.screenshot("level_editor_bundled");
    }
    EXPECT_EQ(saved("last.txt"), levels.back());
}

TEST_F(LevelEditorWindow, EveryControlHasANameForWhoListens) {
    QWidget* dialog = canvas->window();
    int controls = 0;
    for (QWidget* widget : dialog->findChildren<QWidget*>()) {
        const bool isControl =
            qobject_cast<QAbstractButton*>(widget) || qobject_cast<QAbstractSpinBox*>(widget) ||
            qobject_cast<QComboBox*>(widget) || widget == canvas ||
            (qobject_cast<QLineEdit*>(widget) && !qobject_cast<QAbstractSpinBox*>(widget->parentWidget()));
        if (!isControl || !widget->isVisible()) continue;
        ++controls;
        QAccessibleInterface* told = QAccessible::queryAccessibleInterface(widget);
        ASSERT_NE(told, nullptr);
        EXPECT_FALSE(told->text(QAccessible::Name).isEmpty()) << widget->objectName().toStdString();
    }
    EXPECT_GT(controls, 30);
    // Tab goes from the tools over pieces and canvas to the numbers and the buttons below.
    QStringList order;
    canvas->setFocus();
    for (int k = 0; k < 60; ++k) {
        QTest::keyClick(dialog->focusWidget(), Qt::Key_Tab);
        order << dialog->focusWidget()->objectName();
    }
    EXPECT_LT(order.indexOf("levels.name"), order.indexOf("levels.close"));
    EXPECT_LT(order.indexOf("levels.close"), order.indexOf("levels.new"));
    EXPECT_TRUE(order.contains("levels.canvas"));
}

} // namespace
} // namespace lumorph::studio
