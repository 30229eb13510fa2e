#include "app/studio/widgets/range_slider.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kRadius = 7;
constexpr int kEdge = kRadius + 2; ///< room for the ring around a handle that has the focus

} // namespace

RangeSlider::RangeSlider(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    setCursor(Qt::PointingHandCursor);
    setProperty("noFocusRing", true); // the handle in use shows it
}

QSize RangeSlider::sizeHint() const { return {120, 24}; }

QSize RangeSlider::minimumSizeHint() const { return {56, 24}; }

void RangeSlider::setLimits(int lowest, int highest) {
    lowest_ = lowest;
    highest_ = std::max(lowest, highest);
    setRange(from_, to_);
}

void RangeSlider::setRange(int from, int to) {
    from_ = std::clamp(from, lowest_, highest_);
    to_ = std::clamp(to, from_, highest_);
    update();
}

QPoint RangeSlider::handleAt(int value) const {
    const double share = highest_ == lowest_ ? 0.0 : static_cast<double>(value - lowest_) / (highest_ - lowest_);
    return {static_cast<int>(std::lround(kEdge + share * (width() - 2 * kEdge))), height() / 2};
}

double RangeSlider::valueAt(double x) const {
    return lowest_ + (x - kEdge) / std::max(1, width() - 2 * kEdge) * (highest_ - lowest_);
}

void RangeSlider::move(Part part, int from, int to) {
    if (part == Part::both) {
        const int shift = std::clamp(from, lowest_, highest_ - (to - from)) - from;
        from += shift;
        to += shift;
    } else if (part == Part::from) {
        from = std::clamp(from, lowest_, to);
    } else {
        to = std::clamp(to, from, highest_);
    }
    if (from == from_ && to == to_) return;
    from_ = from;
    to_ = to;
    update();
    emit changed(from_, to_);
}

void RangeSlider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return QWidget::mousePressEvent(event);
    const double x = event->position().x();
    const double toFrom = std::abs(x - handleAt(from_).x());
    const double toTo = std::abs(x - handleAt(to_).x());
    // Where both handles lie on one another, the one that can still go to that side is meant.
    const bool upper = toTo < toFrom || (toTo == toFrom && (x > handleAt(to_).x() || from_ == highest_));
    const bool between = x > handleAt(from_).x() + kRadius && x < handleAt(to_).x() - kRadius;
    const bool whole = from_ == lowest_ && to_ == highest_;
    dragged_ = between && !whole ? Part::both : upper ? Part::to : Part::from;
    if (from_ == to_ && from_ == lowest_) dragged_ = Part::to;
    used_ = dragged_ == Part::both ? used_ : dragged_;
    pressedAt_ = valueAt(x);
    pressedFrom_ = from_;
    pressedTo_ = to_;
    const bool onHandle = std::min(toFrom, toTo) <= kRadius + 2;
    if (dragged_ != Part::both && !onHandle) {
        const int value = static_cast<int>(std::lround(pressedAt_));
        dragged_ == Part::from ? move(Part::from, value, to_) : move(Part::to, from_, value);
        pressedFrom_ = from_;
        pressedTo_ = to_;
    }
    update();
}

void RangeSlider::mouseMoveEvent(QMouseEvent* event) {
    if (dragged_ == Part::none) return;
    const int shift = static_cast<int>(std::lround(valueAt(event->position().x()) - pressedAt_));
    move(dragged_, dragged_ == Part::to ? from_ : pressedFrom_ + shift,
         dragged_ == Part::from ? to_ : pressedTo_ + shift);
}

void RangeSlider::mouseReleaseEvent(QMouseEvent*) {
    dragged_ = Part::none;
    update();
}

void RangeSlider::keyPressEvent(QKeyEvent* event) {
    const Part part = event->modifiers().testFlag(Qt::ShiftModifier) ? Part::both : used_;
    const auto shift = [&](int by) {
        move(part, from_ + (part == Part::to ? 0 : by), to_ + (part == Part::from ? 0 : by));
    };
    switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Down:
        return shift(-1);
    case Qt::Key_Right:
    case Qt::Key_Up:
        return shift(1);
    case Qt::Key_PageDown:
        return shift(-std::max(1, (highest_ - lowest_) / 10));
    case Qt::Key_PageUp:
        return shift(std::max(1, (highest_ - lowest_) / 10));
    case Qt::Key_Home:
        return used_ == Part::to ? move(Part::to, from_, from_) : move(Part::from, lowest_, to_);
    case Qt::Key_End:
        return used_ == Part::to ? move(Part::to, from_, highest_) : move(Part::from, to_, to_);
    case Qt::Key_Space:
        used_ = used_ == Part::from ? Part::to : Part::from;
        return update();
    default:
        QWidget::keyPressEvent(event);
    }
}

void RangeSlider::enterEvent(QEnterEvent* event) {
    QWidget::enterEvent(event);
    update();
}

void RangeSlider::leaveEvent(QEvent* event) {
    QWidget::leaveEvent(event);
    update();
}

void RangeSlider::drawHandle(QPainter& painter, Part part, int value) const {
    const Palette& colors = currentPalette();
    const QPoint middle = handleAt(value);
    const bool held = dragged_ == part || dragged_ == Part::both;
    if (hasFocus() && used_ == part) {
        painter.setPen(QPen(colors.accent, 2.0));
        painter.setBrush(Qt::NoBrush);
        painter.drawEllipse(middle, kRadius + 1, kRadius + 1);
    }
    painter.setPen(QPen(colors.border, 1.0));
    painter.setBrush(held || underMouse() ? colors.hovered : colors.raised);
    painter.drawEllipse(middle, kRadius - 1, kRadius - 1);
    painter.setPen(Qt::NoPen);
    painter.setBrush(isEnabled() ? colors.text : colors.border);
    painter.drawEllipse(middle, 2, 2);
}

void RangeSlider::paintEvent(QPaintEvent*) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPoint low = handleAt(lowest_);
    const QPoint high = handleAt(highest_);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colors.line);
    painter.drawRoundedRect(QRectF(low.x(), low.y() - 2, high.x() - low.x(), 4), 2, 2);
    const bool whole = from_ == lowest_ && to_ == highest_;
    painter.setBrush(isEnabled() && !whole ? colors.textMuted : colors.border);
    painter.drawRoundedRect(QRectF(handleAt(from_).x(), low.y() - 2, handleAt(to_).x() - handleAt(from_).x(), 4), 2, 2);
    drawHandle(painter, Part::from, from_);
    drawHandle(painter, Part::to, to_);
}

} // namespace lumorph::studio
