#include "app/studio/shell/escape_twice.h"

#include <QDialog>
#include <QLineEdit>
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
    }

    ManualClock clock;
    studio::EscapeTwice keys{clock};
    QSignalSpy pressed{&keys, &studio::EscapeTwice::pressed};
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

TEST_F(EscapeTwiceTest, WorksWhileADialogIsOpenAndClosesByTheFirst) {
    QDialog dialog(&window);
    dialog.setModal(true);
    dialog.show();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&dialog));
    press(dialog, 1000);
    EXPECT_FALSE(dialog.isVisible());
    press(*edit, 200);
    EXPECT_EQ(pressed.count(), 1);
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
