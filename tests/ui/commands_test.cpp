#include "app/studio/base/commands.h"

#include <QApplication>
#include <QLineEdit>
#include <QListView>
#include <QMainWindow>
#include <QTest>
#include <gtest/gtest.h>

#include "app/studio/shell/command_palette.h"
#include "app/studio/shell/command_search.h"

namespace lumorph::studio {
namespace {

/// A window with a palette over some commands; what ran last is remembered.
class CommandsTest : public ::testing::Test {
protected:
    void SetUp() override {
        add("file.open", "&Open...", "File", QKeySequence::Open);
        add("target.open", "Open a &target...", "Target", {});
        add("target.autoPlace", "&Auto-place", "Target", {});
        add("view.full", "Full screen", "View", QKeySequence(Qt::Key_F11));
        add("export.picture", "Export a picture...", "File", {});
        window.resize(900, 600);
        window.setCentralWidget(new QLineEdit);
        window.show();
        ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
        window.centralWidget()->setFocus();
    }

    QAction* add(const QString& id, const QString& text, const QString& menu, const QKeySequence& keys) {
        studio::Commands::Options options;
        options.menu = menu;
        options.shortcut = keys;
        return commands.add(id, text, options, [this, id] { ran = id; });
    }
    QStringList found(const QString& typed) {
        QStringList ids;
        for (const auto& entry : searchCommands(commands, typed)) ids << entry.action->objectName();
        return ids;
    }
    QLineEdit* input() { return window.findChild<QLineEdit*>("palette.input"); }
    QListView* list() { return window.findChild<QListView*>("palette.list"); }
    QString shown(int row) { return list()->model()->index(row, 0).data().toString(); }

    studio::Commands commands;
    QMainWindow window;
    QString ran;
};

TEST_F(CommandsTest, AreFoundByTheirId) {
    ASSERT_NE(commands.find("file.open"), nullptr);
    EXPECT_EQ(commands.find("file.open")->shortcut(), QKeySequence(QKeySequence::Open));
    EXPECT_EQ(commands.find("file.nothing"), nullptr);
    commands.find("view.full")->trigger();
    EXPECT_EQ(ran, "view.full");
}

TEST_F(CommandsTest, LettersInOrderFindACommandAndTheBestIsFirst) {
    EXPECT_EQ(found("").size(), 5);
    EXPECT_EQ(found("open").first(), "file.open");
    EXPECT_EQ(found("ot").first(), "target.open");
    EXPECT_EQ(found("fs").first(), "view.full");
    EXPECT_EQ(found("place").first(), "target.autoPlace");
    EXPECT_EQ(found("OPEN A T").first(), "target.open");
    EXPECT_EQ(found("target").first(), "target.open");
    EXPECT_TRUE(found("target").contains("target.autoPlace")) << "the menu's name finds its commands";
    EXPECT_TRUE(found("xyz").isEmpty());
}

TEST_F(CommandsTest, OtherWordsForThemFindThem) {
    add("settings", "&Settings...", "Edit", {});
    add("loop.stop", "STOP: hold every actuator", "Rig", {});
    EXPECT_EQ(found("preferences").first(), "settings");
    EXPECT_EQ(found("panic"), QStringList("loop.stop"));
    EXPECT_EQ(found("screenshot"), QStringList("export.picture"));
    EXPECT_EQ(found("load").first(), "file.open");
    EXPECT_EQ(found("open").first(), "file.open") << "its own name comes first";
    EXPECT_TRUE(found("preferred").isEmpty());
}

TEST_F(CommandsTest, ThePaletteFindsThingsAndChoosesThemInTheirWorkspace) {
    QStringList chosen;
    commands.addFinder([&chosen] {
        return std::vector<Findable>{
            {"Buoy", "Sphere", "sphere", "scene", [&chosen] { chosen << "buoy"; }},
            {"Dunes", "Target", "target", "field", [&chosen] { chosen << "dunes"; }},
        };
    });
    QObject::connect(&commands, &studio::Commands::workspaceWanted, &window,
                     [&chosen](const QString& id) { chosen << "show " + id; });
    toggleCommandPalette(window, commands);
    EXPECT_EQ(list()->model()->rowCount(), 5) << "without words it lists what can be done";
    QTest::keyClicks(input(), "buoy");
    EXPECT_EQ(shown(0), "Buoy");
    QTest::keyClick(input(), Qt::Key_Return);
    EXPECT_EQ(chosen, QStringList({"show scene", "buoy"}));
    EXPECT_TRUE(ran.isEmpty());
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    toggleCommandPalette(window, commands);
    QTest::keyClicks(input(), "target dun"); // by what it is, too
    EXPECT_EQ(shown(0), "Dunes");
}

TEST_F(CommandsTest, OutOfSightAreNotFound) {
    commands.find("view.full")->setVisible(false);
    EXPECT_TRUE(found("full screen").isEmpty());
}

TEST_F(CommandsTest, ThePaletteFiltersAndEnterRuns) {
    toggleCommandPalette(window, commands);
    ASSERT_NE(input(), nullptr);
    EXPECT_TRUE(input()->hasFocus());
    QTest::keyClicks(input(), "open");
    EXPECT_EQ(shown(0), "Open");
    EXPECT_EQ(shown(1), "Open a target");
    QTest::keyClick(input(), Qt::Key_Down);
    QTest::keyClick(input(), Qt::Key_Return);
    EXPECT_EQ(ran, "target.open");
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    EXPECT_EQ(input(), nullptr);
    EXPECT_TRUE(window.centralWidget()->hasFocus());
}

TEST_F(CommandsTest, EscClosesThePaletteAndNothingRuns) {
    toggleCommandPalette(window, commands);
    QTest::keyClicks(input(), "full");
    QTest::keyClick(input(), Qt::Key_Escape);
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    EXPECT_EQ(input(), nullptr);
    EXPECT_TRUE(ran.isEmpty());
}

TEST_F(CommandsTest, WhatIsDisabledIsShownAndDoesNotRun) {
    commands.find("view.full")->setEnabled(false);
    toggleCommandPalette(window, commands);
    QTest::keyClicks(input(), "full screen");
    ASSERT_GE(list()->model()->rowCount(), 1);
    EXPECT_FALSE(list()->model()->index(0, 0).flags().testFlag(Qt::ItemIsEnabled));
    QTest::keyClick(input(), Qt::Key_Return);
    EXPECT_TRUE(ran.isEmpty());
}

} // namespace
} // namespace lumorph::studio
