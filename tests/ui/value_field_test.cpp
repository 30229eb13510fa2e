#include "app/studio/widgets/value_field.h"

#include <memory>
#include <numbers>

#include <QAction>
#include <QPushButton>
#include <QSignalSpy>
#include <QTest>
#include <QToolTip>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

/// A field of a length from -10 cm to 10 cm, reset to 2 cm, in a window with another control.
class ValueField : public ::testing::Test {
protected:
    void SetUp() override {
        auto* column = new QVBoxLayout(&window);
        field = new studio::ValueField(Quantity::length, -0.1, 0.1, 0.02, &window);
        other = new QPushButton("Other", &window);
        column->addWidget(field);
        column->addWidget(other);
        window.show();
        ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
        other->setFocus();
        committed = std::make_unique<QSignalSpy>(field, &studio::ValueField::committed);
        previewed = std::make_unique<QSignalSpy>(field, &studio::ValueField::previewed);
        reverted = std::make_unique<QSignalSpy>(field, &studio::ValueField::reverted);
    }

    void drag(int pixels, Qt::KeyboardModifiers modifiers = {}) {
        const QPoint start = field->rect().center();
        QTest::mousePress(field, Qt::LeftButton, modifiers, start);
        for (int moved = 1; moved <= pixels; ++moved) move(start + QPoint(moved, 0), modifiers);
    }
    void move(const QPoint& to, Qt::KeyboardModifiers modifiers) {
        QMouseEvent event(QEvent::MouseMove, to, field->mapToGlobal(to), Qt::NoButton, Qt::LeftButton, modifiers);
        QApplication::sendEvent(field, &event);
    }
    void release(int pixels) {
        QTest::mouseRelease(field, Qt::LeftButton, {}, field->rect().center() + QPoint(pixels, 0));
    }
    void click() { QTest::mouseClick(field, Qt::LeftButton, {}, field->rect().center()); }
    double last(const QSignalSpy& spy) { return spy.last().first().toDouble(); }

    QWidget window;
    studio::ValueField* field = nullptr;
    QPushButton* other = nullptr;
    std::unique_ptr<QSignalSpy> committed, previewed, reverted;
};

TEST_F(ValueField, UndoIsTheWindowsUnlessSomethingIsBeingTyped) {
    QAction undo;
    undo.setShortcut(QKeySequence::Undo);
    window.addAction(&undo);
    QSignalSpy undone(&undo, &QAction::triggered);
    click();
    QTest::keyClicks(field, "3");
    QTest::keyClick(field, Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(undone.count(), 0) << "it is the text's";
    QTest::keyClicks(field, "4");
    QTest::keyClick(field, Qt::Key_Return);
    ASSERT_EQ(committed->count(), 1);
    QTest::keyClick(field, Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(undone.count(), 1);
}

TEST_F(ValueField, ARefusingOneTakesNoOtherValueThanTheOneThatWasMeant) {
    field->setRefusing(true);
    QSignalSpy refused(field, &studio::ValueField::refused);
    for (const char* text : {"11 cm", "-0.2 m"}) {
        click();
        QTest::keyClicks(field, text);
        QTest::keyClick(field, Qt::Key_Return);
        EXPECT_NEAR(field->value(), 0.02, 1e-12) << text;
        other->setFocus();
    }
    EXPECT_EQ(committed->count(), 0);
    ASSERT_GE(refused.count(), 2);
    EXPECT_EQ(refused.first().first().toString(), "11.00 cm is not from -10.00 cm to 10.00 cm; it stays 2.00 cm");
    EXPECT_EQ(field->text(), "2.00 cm");
}

TEST_F(ValueField, AClickAndTypingEntersAValueInAnyUnit) {
    click();
    EXPECT_TRUE(field->hasFocus());
    QTest::keyClicks(field, "3 in");
    QTest::keyClick(field, Qt::Key_Return);
    ASSERT_EQ(committed->count(), 1);
    EXPECT_NEAR(last(*committed), 0.0762, 1e-12);
    EXPECT_EQ(field->text().toStdString(), "7.62 cm");
}

TEST_F(ValueField, LeavingEntersWhatWasTyped) {
    click();
    QTest::keyClicks(field, "5");
    QTest::keyClick(field, Qt::Key_Tab);
    ASSERT_EQ(committed->count(), 1);
    EXPECT_NEAR(last(*committed), 0.05, 1e-12);
}

TEST_F(ValueField, LookingAtItChangesNothing) {
    field->setValue(0.0123456);
    click();
    QTest::keyClick(field, Qt::Key_Return);
    QTest::keyClick(field, Qt::Key_Tab);
    EXPECT_EQ(committed->count(), 0);
    EXPECT_DOUBLE_EQ(field->value(), 0.0123456);
}

TEST_F(ValueField, WrongInputIsMarkedAndTakenBack) {
    click();
    QTest::keyClicks(field, "2 apples");
    EXPECT_TRUE(field->property("wrong").toBool());
    QTest::keyClick(field, Qt::Key_Return);
    EXPECT_TRUE(field->property("wrong").toBool());
    QTest::keyClick(field, Qt::Key_Tab);
    EXPECT_EQ(field->text().toStdString(), "2.00 cm");
    EXPECT_FALSE(field->property("wrong").toBool());
    EXPECT_EQ(committed->count(), 0);
}

TEST_F(ValueField, EntersTheNearestValueOfItsRange) {
    click();
    QTest::keyClicks(field, "3 m");
    QTest::keyClick(field, Qt::Key_Return);
    ASSERT_EQ(committed->count(), 1);
    EXPECT_DOUBLE_EQ(last(*committed), 0.1);
}

TEST_F(ValueField, CalculatesAndSaysWhatItCannot) {
    click();
    QTest::keyClicks(field, "2cm+5mm");
    EXPECT_FALSE(field->property("wrong").toBool());
    QTest::keyClick(field, Qt::Key_Return);
    ASSERT_EQ(committed->count(), 1);
    EXPECT_NEAR(last(*committed), 0.025, 1e-12);
    EXPECT_EQ(field->text().toStdString(), "2.50 cm");
    EXPECT_TRUE(field->why().isEmpty());

    QTest::keyClicks(field, "2cm+5 apples");
    EXPECT_TRUE(field->why().isEmpty()) << "while one is typing it says nothing";
    QTest::keyClick(field, Qt::Key_Return);
    EXPECT_TRUE(field->why().contains("\"apples\" is not a unit")) << field->why().toStdString();
    EXPECT_EQ(field->text().toStdString(), "2cm+5 apples") << "it can be mended";
    EXPECT_TRUE(QTest::qWaitFor([&] { return QToolTip::text() == field->why(); }, 2000));
    QTest::keyClick(field, Qt::Key_Tab);
    EXPECT_EQ(field->text().toStdString(), "2.50 cm");
    EXPECT_TRUE(field->why().endsWith("2cm+5 apples was taken back.")) << field->why().toStdString();

    click();
    EXPECT_TRUE(field->why().isEmpty());
    QTest::keyClicks(field, "3 m"); // a number beyond the range does not become another in silence
    QTest::keyClick(field, Qt::Key_Return);
    EXPECT_EQ(field->why().toStdString(), "At most 10.00 cm here.");
    QTest::keyClicks(field, "-1 m");
    QTest::keyClick(field, Qt::Key_Return);
    EXPECT_TRUE(field->why().startsWith("At least ")) << field->why().toStdString();
}

TEST_F(ValueField, DraggingPreviewsAndTheReleaseCommitsOnce) {
    drag(40);
    EXPECT_GE(previewed->count(), 30);
    EXPECT_EQ(committed->count(), 0);
    EXPECT_NEAR(field->value(), 0.02 + 0.5e-3 * 40, 2e-3); // half a millimetre a pixel, but for the first few
    release(40);
    ASSERT_EQ(committed->count(), 1);
    EXPECT_DOUBLE_EQ(last(*committed), field->value());
    EXPECT_FALSE(field->hasFocus());
}

TEST_F(ValueField, ShiftIsFineAndCtrlIsCoarse) {
    const double start = field->value();
    drag(20);
    const double usual = field->value() - start;
    release(20);
    field->setValue(start);
    drag(20, Qt::ShiftModifier);
    EXPECT_NEAR(field->value() - start, usual / 10, 1e-9);
    release(20);
    field->setValue(-0.1);
    drag(20, Qt::ControlModifier);
    EXPECT_NEAR(field->value() + 0.1, usual * 10, 1e-9);
    release(20);
}

TEST_F(ValueField, EscTakesADragBack) {
    drag(30);
    QTest::keyClick(field, Qt::Key_Escape);
    EXPECT_EQ(reverted->count(), 1);
    EXPECT_DOUBLE_EQ(field->value(), 0.02);
    release(30);
    EXPECT_EQ(committed->count(), 0);
}

TEST_F(ValueField, EscTakesTypingBack) {
    click();
    QTest::keyClicks(field, "9");
    QTest::keyClick(field, Qt::Key_Escape);
    EXPECT_EQ(field->text().toStdString(), "2.00 cm");
    QTest::keyClick(field, Qt::Key_Tab);
    EXPECT_EQ(committed->count(), 0);
}

TEST_F(ValueField, ArrowsAndWheelStepIt) {
    click();
    QTest::keyClick(field, Qt::Key_Up);
    EXPECT_NEAR(field->value(), 0.021, 1e-12);
    QTest::keyClick(field, Qt::Key_Down, Qt::ControlModifier);
    EXPECT_NEAR(field->value(), 0.011, 1e-12);
    QWheelEvent wheel(QPointF(5, 5), field->mapToGlobal(QPointF(5, 5)), {}, {0, 120}, Qt::NoButton, {},
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(field, &wheel);
    EXPECT_NEAR(field->value(), 0.012, 1e-12);
    EXPECT_EQ(committed->count(), 3);
    other->setFocus();
    QApplication::sendEvent(field, &wheel);
    EXPECT_EQ(committed->count(), 3) << "a column that is scrolled must not change what passes under the pointer";
}

TEST_F(ValueField, ADoubleClickResetsIt) {
    field->setValue(0.07);
    QTest::mouseDClick(field, Qt::LeftButton, {}, field->rect().center());
    ASSERT_EQ(committed->count(), 1);
    EXPECT_DOUBLE_EQ(last(*committed), 0.02);
    EXPECT_EQ(field->text().toStdString(), "2.00 cm");
}

TEST_F(ValueField, SettingItTellsNobodyAndLeavesTypingAlone) {
    field->setValue(0.03);
    EXPECT_EQ(field->text().toStdString(), "3.00 cm");
    click();
    QTest::keyClicks(field, "4");
    field->setValue(0.05); // the loop goes on meanwhile
    EXPECT_EQ(field->text().toStdString(), "4");
    EXPECT_EQ(committed->count() + previewed->count(), 0);
}

} // namespace
} // namespace lumorph::studio
