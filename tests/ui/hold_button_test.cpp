#include "app/studio/widgets/hold_button.h"

#include <thread>

#include <QLineEdit>
#include <QSignalSpy>
#include <QTest>
#include <QVBoxLayout>
#include <gtest/gtest.h>

#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using test::eventually;
using test::pass;

class HoldButtonTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto* column = new QVBoxLayout(&window);
        column->addWidget(edit = new QLineEdit(&window));
        column->addWidget(button = new HoldButton("Hold to start", &window));
        window.show();
        ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
        held = std::make_unique<QSignalSpy>(button, &HoldButton::held);
        clicked = std::make_unique<QSignalSpy>(button, &QPushButton::clicked);
    }
    void expectNothing() {
        EXPECT_EQ(button->progress(), 0.0);
        pass(1200ms);
        EXPECT_EQ(held->count(), 0);
        EXPECT_EQ(clicked->count(), 0);
    }
    [[nodiscard]] bool fills() {
        return eventually([&] { return held->count() == 1; }, 5s);
    }

    QWidget window;
    QLineEdit* edit = nullptr;
    HoldButton* button = nullptr;
    std::unique_ptr<QSignalSpy> held, clicked;
};

TEST_F(HoldButtonTest, ClicksAndDoubleClicksDoNothing) {
    for (int k = 0; k < 5; ++k) {
        QTest::mouseClick(button, Qt::LeftButton);
        QTest::mouseDClick(button, Qt::LeftButton);
        QTest::mouseRelease(button, Qt::LeftButton);
        QTest::keyClick(button, Qt::Key_Space);
        QTest::keyClick(button, Qt::Key_Return);
    }
    QTest::mousePress(button, Qt::RightButton);
    expectNothing();
}

TEST_F(HoldButtonTest, ASecondOfTheMouseIsMeantAndOnlyOnce) {
    QElapsedTimer since;
    since.start();
    QTest::mousePress(button, Qt::LeftButton);
    ASSERT_TRUE(eventually([&] { return button->progress() > 0.4; }, 5s)) << "it fills";
    EXPECT_EQ(held->count(), 0);
    ASSERT_TRUE(fills());
    EXPECT_GE(since.elapsed(), 990);
    pass(1200ms);
    EXPECT_EQ(held->count(), 1) << "it must be let go of first";
    QTest::mouseRelease(button, Qt::LeftButton);
    EXPECT_EQ(clicked->count(), 0);
}

TEST_F(HoldButtonTest, SpaceAndEnterHoldItToo) {
    for (const Qt::Key key : {Qt::Key_Space, Qt::Key_Return}) {
        held->clear();
        button->setFocus();
        QTest::keyPress(button, key);
        for (int k = 0; k < 10; ++k) { // as a keyboard repeats
            pass(30ms);
            QKeyEvent again(QEvent::KeyPress, key, Qt::NoModifier, {}, true);
            QApplication::sendEvent(button, &again);
        }
        EXPECT_TRUE(fills());
        QTest::keyRelease(button, key);
    }
    held->clear();
    QTest::keyPress(button, Qt::Key_Space);
    pass(500ms);
    QTest::keyRelease(button, Qt::Key_Space);
    expectNothing();
}

TEST_F(HoldButtonTest, LeavingItTakesItBack) {
    QTest::mousePress(button, Qt::LeftButton);
    pass(500ms);
    QTest::mouseRelease(button, Qt::LeftButton);
    expectNothing();
    QTest::mousePress(button, Qt::LeftButton);
    pass(300ms);
    QMouseEvent away(QEvent::MouseMove, QPointF(-20, -20), QPointF(-20, -20), Qt::NoButton, Qt::LeftButton, {});
    QApplication::sendEvent(button, &away);
    expectNothing();
    QTest::keyPress(button, Qt::Key_Space);
    pass(300ms);
    edit->setFocus();
    button->setFocus();
    expectNothing();
    QTest::keyPress(button, Qt::Key_Space);
    button->setEnabled(false);
    button->setEnabled(true);
    expectNothing();
    QTest::mousePress(button, Qt::LeftButton);
    button->hide();
    button->show();
    expectNothing();
}

TEST_F(HoldButtonTest, AClickThatAStuckWindowSeesLateIsNoHold) {
    QTest::mousePress(button, Qt::LeftButton);
    std::this_thread::sleep_for(2s);
    pass(50ms);
    QTest::mouseRelease(button, Qt::LeftButton);
    expectNothing();
}

TEST_F(HoldButtonTest, EnterInAFieldBesideItIsNotMeantForIt) {
    edit->setFocus();
    QTest::keyPress(edit, Qt::Key_Return);
    expectNothing();
    EXPECT_FALSE(button->accessibleDescription().isEmpty());
}

} // namespace
} // namespace lumorph::studio
