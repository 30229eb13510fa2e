#include "app/studio/shell/escape_twice.h"

#include <QDialog>
#include <QLineEdit>
#include <QMenu>
#include <QSignalSpy>
#include <QTest>
#include <QVBoxLayout>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

using std::chrono::milliseconds;

class EscapeTwiceTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto* column = new QVBoxLayout(&window);
        column->addWidget(edit = new QLineEdit(&window));
        window.show();
        ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
    }
    void press(QWidget& widget, int afterMilliseconds, Qt::Key key = Qt::Key_Escape) {
        clock.advance(milliseconds(afterMilliseconds));
        QTest::keyClick(&widget, key);
        QCoreApplication::processEvents(); // what it closes is seen by then
    }

    ManualClock clock;
    studio::EscapeTwice keys{clock};
    QSignalSpy pressed{&keys, &studio::EscapeTwice::pressed};
    QSignalSpy spent{&keys, &studio::EscapeTwice::spent};
    QSignalSpy open{&keys, &studio::EscapeTwice::openChanged};
    QWidget window;
    QLineEdit* edit = nullptr;
};

TEST_F(EscapeTwiceTest, OncePassesByAllParentsAndCountsOnce) {
    press(*edit, 1000);
    EXPECT_EQ(pressed.count(), 0);
}

TEST_F(EscapeTwiceTest, WithinSixTenthsOfASecond) {
    press(*edit, 1000);
    press(*edit, 590);
    EXPECT_EQ(pressed.count(), 1);
}

TEST_F(EscapeTwiceTest, SlowerIsNot) {
    press(*edit, 1000);
    press(*edit, 610);
    EXPECT_EQ(pressed.count(), 0);
    press(*edit, 300); // but the second begins anew
    EXPECT_EQ(pressed.count(), 1);
}

TEST_F(EscapeTwiceTest, ThreeTimesIsOnce) {
    for (int i = 0; i < 3; ++i) press(*edit, 100);
    EXPECT_EQ(pressed.count(), 1);
}

TEST_F(EscapeTwiceTest, AnotherKeyBetweenIsNot) {
    press(*edit, 1000);
    press(*edit, 100, Qt::Key_A);
    press(*edit, 100);
    EXPECT_EQ(pressed.count(), 0);
}

TEST_F(EscapeTwiceTest, APressThatClosesADialogDoesNotCount) {
    QDialog dialog(&window);
    dialog.setModal(true);
    dialog.show();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&dialog));
    press(dialog, 1000);
    EXPECT_FALSE(dialog.isVisible());
    EXPECT_EQ(spent.count(), 1);
    press(*edit, 200);
    EXPECT_EQ(pressed.count(), 0) << "one closed the dialog, the other is a slip";
    press(*edit, 200);
    EXPECT_EQ(pressed.count(), 1) << "who goes on means it";
}

TEST_F(EscapeTwiceTest, ASecondPressThatClosesSomethingDoesNotCount) {
    press(*edit, 1000);
    QMenu menu(&window);
    menu.addAction("Open");
    menu.popup(window.mapToGlobal(QPoint(10, 10)));
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&menu));
    EXPECT_EQ(open.takeLast().front().toBool(), true);
    press(menu, 200);
    ASSERT_FALSE(menu.isVisible());
    EXPECT_EQ(pressed.count(), 0);
    EXPECT_EQ(open.takeLast().front().toBool(), false);
}

TEST_F(EscapeTwiceTest, SubmenusCloseOneByOneAndNothingStops) {
    QMenu menu(&window);
    QMenu* sub = menu.addMenu("More");
    sub->addAction("Open");
    menu.popup(window.mapToGlobal(QPoint(10, 10)));
    sub->popup(window.mapToGlobal(QPoint(60, 30)));
    ASSERT_TRUE(QTest::qWaitForWindowExposed(sub));
    press(*sub, 1000);
    press(menu, 100);
    EXPECT_FALSE(menu.isVisible());
    EXPECT_EQ(pressed.count(), 0);
}

TEST_F(EscapeTwiceTest, ADialogThatStaysOpenHidesNoStop) {
    class Stays : public QDialog {
        using QDialog::QDialog;
        void reject() override {}
    } dialog(&window);
    dialog.show();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&dialog));
    press(dialog, 1000);
    press(dialog, 200);
    EXPECT_EQ(pressed.count(), 1);
}

TEST_F(EscapeTwiceTest, ASheetOverTheWindowCountsAsADialog) {
    class Sheet : public QWidget {
        using QWidget::QWidget;
        void keyPressEvent(QKeyEvent*) override { hide(); }
    } sheet(&window);
    EscapeTwice::setCloses(sheet);
    sheet.show();
    press(sheet, 1000);
    ASSERT_FALSE(sheet.isVisible());
    press(*edit, 200);
    EXPECT_EQ(pressed.count(), 0);
}

TEST_F(EscapeTwiceTest, AKeyHeldDownIsOnePress) {
    clock.advance(milliseconds(1000));
    QTest::keyPress(edit, Qt::Key_Escape);
    for (int i = 0; i < 5; ++i) {
        clock.advance(milliseconds(100));
        QKeyEvent again(QEvent::KeyPress, Qt::Key_Escape, Qt::NoModifier, {}, true);
        QApplication::sendEvent(edit, &again);
    }
    EXPECT_EQ(pressed.count(), 0);
}

} // namespace
} // namespace lumorph::studio
