#include "app/studio/widgets/value_field.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QStyle>
#include <QTimer>
#include <QToolTip>
#include <QWheelEvent>

namespace lumorph::studio {
namespace {

constexpr int kToldMilliseconds = 6000;
constexpr int kScrubDistance = 3; ///< pixels before a press is a drag

double pace(Qt::KeyboardModifiers modifiers) {
    if (modifiers.testFlag(Qt::ShiftModifier)) return 0.1;
    return modifiers.testFlag(Qt::ControlModifier) ? 10.0 : 1.0;
}

} // namespace

ValueField::ValueField(Quantity quantity, double minimum, double maximum, double resetTo, QWidget* parent)
    : QLineEdit(parent), quantity_(quantity), minimum_(minimum), maximum_(maximum), resetTo_(resetTo),
      step_(usualStep(quantity)), value_(std::clamp(resetTo, minimum, maximum)) {
    setFocusPolicy(Qt::TabFocus); // a click gives it the keyboard when the button is released, a drag does not
    setCursor(Qt::SizeHorCursor);
    setContextMenuPolicy(Qt::NoContextMenu);
    setAlignment(Qt::AlignRight);
    const QString accepted = unitsOf(quantity);
    setToolTip("Drag sideways to change, click to type, double click to reset to " + formatQuantity(resetTo, quantity) +
               ".\nIt calculates: 90+45, 2*3." + (accepted.isEmpty() ? QString() : "\nUnits: " + accepted));
    connect(this, &QLineEdit::returnPressed, this, &ValueField::enter);
    connect(this, &QLineEdit::textEdited, this, [this] {
        tell({});
        mark(!parseQuantity(text(), quantity_));
    });
    show(value_);
}

void ValueField::setValue(double value) {
    const double held = std::clamp(value, minimum_, maximum_);
    if (scrubbing_) return;
    value_ = held;
    if (!(hasFocus() && isModified())) show(held);
}

void ValueField::setRange(double minimum, double maximum) {
    minimum_ = minimum;
    maximum_ = std::max(minimum, maximum);
    setValue(value_);
}

void ValueField::setRefusing(bool refusing) { refusing_ = refusing; }

void ValueField::setStep(double step) { step_ = step; }

QSize ValueField::sizeHint() const { return {88, QLineEdit::sizeHint().height()}; }

void ValueField::show(double value) {
    const QString shown = formatQuantity(value, quantity_);
    if (shown != text()) setText(shown);
    setModified(false);
    mark(false);
}

void ValueField::mark(bool wrong) {
    if (property("wrong").toBool() == wrong) return;
    setProperty("wrong", wrong);
    style()->unpolish(this);
    style()->polish(this);
}

/// Beside the field, and once more where the pointer asks; not while one is typing, since half a sum is no number yet.
void ValueField::tell(const QString& why) {
    const bool silent = why_.isEmpty() && why.isEmpty();
    why_ = why;
    setAccessibleDescription(why);
    if (silent || !isVisible()) return;
    if (why.isEmpty()) return QToolTip::hideText();
    QTimer::singleShot(0, this, [this, why] { // the keyboard may be on its way elsewhere, which hides all tips
        if (why != why_ || !isVisible()) return;
        QToolTip::showText(mapToGlobal(QPoint(0, height() - 12)), why, this, {}, kToldMilliseconds);
    });
}

void ValueField::commit(double value) {
    value = std::clamp(value, minimum_, maximum_);
    const bool other = value != value_;
    value_ = value;
    show(value);
    if (other) emit committed(value);
}

/// A text that was not touched keeps the value's hidden digits.
void ValueField::enter() {
    if (!isModified()) return;
    const TypedQuantity typed = readQuantity(text(), quantity_);
    if (!typed.value) {
        mark(true);
        tell(typed.why);
        return;
    }
    if (refusing_ && (*typed.value < minimum_ || *typed.value > maximum_)) {
        mark(true);
        emit refused(formatQuantity(*typed.value, quantity_) + " is not from " + formatQuantity(minimum_, quantity_) +
                     " to " + formatQuantity(maximum_, quantity_) + "; it stays " + formatQuantity(value_, quantity_));
        return;
    }
    if (*typed.value > maximum_) tell("At most " + formatQuantity(maximum_, quantity_) + " here.");
    if (*typed.value < minimum_) tell("At least " + formatQuantity(minimum_, quantity_) + " here.");
    commit(*typed.value);
    if (hasFocus()) selectAll();
}

void ValueField::step(double steps, Qt::KeyboardModifiers modifiers) {
    const double from = isModified() ? parseQuantity(text(), quantity_).value_or(value_) : value_;
    commit(from + steps * step_ * pace(modifiers));
    if (hasFocus()) selectAll();
}

void ValueField::mousePressEvent(QMouseEvent* event) {
    if (hasFocus() || event->button() != Qt::LeftButton) {
        QLineEdit::mousePressEvent(event);
        return;
    }
    pressed_ = true;
    pressX_ = lastX_ = event->position().toPoint().x();
    scrubStart_ = scrubbed_ = value_;
    event->accept();
}

void ValueField::mouseMoveEvent(QMouseEvent* event) {
    if (!pressed_) {
        QLineEdit::mouseMoveEvent(event);
        return;
    }
    const int x = event->position().toPoint().x();
    if (!scrubbing_ && std::abs(x - pressX_) < kScrubDistance) return;
    if (!scrubbing_) {
        scrubbing_ = true;
        grabKeyboard(); // for Esc, without taking the keyboard from the field being edited elsewhere
    }
    scrubbed_ += 0.5 * (x - lastX_) * step_ * pace(event->modifiers());
    lastX_ = x;
    value_ = std::clamp(scrubbed_, minimum_, maximum_);
    show(value_);
    emit previewed(value_);
}

void ValueField::endScrub() {
    if (scrubbing_) releaseKeyboard();
    pressed_ = scrubbing_ = false;
}

void ValueField::mouseReleaseEvent(QMouseEvent* event) {
    if (!pressed_) {
        QLineEdit::mouseReleaseEvent(event);
        return;
    }
    const bool moved = scrubbing_;
    endScrub();
    if (moved)
        emit committed(value_);
    else if (event->button() == Qt::LeftButton)
        setFocus(Qt::MouseFocusReason);
}

void ValueField::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    setModified(false);
    commit(resetTo_);
    if (hasFocus()) selectAll();
}

void ValueField::keyPressEvent(QKeyEvent* event) {
    switch (event->key()) {
    case Qt::Key_Up:
        step(1.0, event->modifiers());
        return;
    case Qt::Key_Down:
        step(-1.0, event->modifiers());
        return;
    case Qt::Key_PageUp:
        step(10.0, event->modifiers());
        return;
    case Qt::Key_PageDown:
        step(-10.0, event->modifiers());
        return;
    case Qt::Key_Escape:
        if (scrubbing_) {
            endScrub();
            value_ = scrubStart_;
            show(value_);
            emit reverted();
            return;
        }
        if (isModified()) {
            show(value_);
            selectAll();
            return;
        }
        break;
    default:
        break;
    }
    QLineEdit::keyPressEvent(event);
}

/// Only while it has the keyboard: else a wheel that scrolls a column would change what passes under the pointer.
void ValueField::wheelEvent(QWheelEvent* event) {
    if (!hasFocus() || event->angleDelta().y() == 0) {
        event->ignore();
        return;
    }
    step(event->angleDelta().y() / 120.0, event->modifiers());
    event->accept();
}

void ValueField::focusOutEvent(QFocusEvent* event) {
    if (isModified()) {
        enter();
        if (isModified()) tell(why_ + ' ' + text().trimmed() + " was taken back.");
    }
    show(value_);
    deselect();
    setCursor(Qt::SizeHorCursor);
    QLineEdit::focusOutEvent(event);
}

void ValueField::focusInEvent(QFocusEvent* event) {
    tell({});
    QLineEdit::focusInEvent(event);
    setCursor(Qt::IBeamCursor);
    selectAll();
}

bool ValueField::event(QEvent* event) {
    // Esc in a field takes back what is typed; it must not close the dialog around it before.
    if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape &&
        (scrubbing_ || isModified()))
        event->accept();
    if (event->type() == QEvent::ToolTip && !why_.isEmpty()) {
        QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(), why_, this);
        return true;
    }
    // What was entered is a step of the window's undo; only what is being typed is the field's own.
    if (event->type() == QEvent::ShortcutOverride && !isModified()) {
        const auto* key = static_cast<QKeyEvent*>(event);
        if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo)) {
            event->ignore();
            return true;
        }
    }
    return QLineEdit::event(event);
}

} // namespace lumorph::studio
