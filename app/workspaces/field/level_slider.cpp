#include "app/workspaces/field/level_slider.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <QWheelEvent>

#include "app/studio/look/palette.h"
#include "app/workspaces/field/actuator_scale.h"

namespace lumorph::studio {

namespace {

constexpr double kSliderMargin = 8.0; ///< so that the handle is whole at both ends
constexpr int kMostTicks = 41;

} // namespace

LevelSlider::LevelSlider(QWidget* parent) : QAbstractSlider(parent) {
    setOrientation(Qt::Horizontal);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    setCursor(Qt::PointingHandCursor);
    setLevels(2);
}

void LevelSlider::setLevels(int levels) {
    const QSignalBlocker quiet(this);
    setRange(0, std::max(levels, 2) - 1);
    setSingleStep(1);
    setPageStep(std::max(1, (levels - 1) / 8));
    update();
}

void LevelSlider::show(double wanted, double estimated) {
    if (dragging_) wanted = wanted_;
    if (wanted == wanted_ && estimated == estimated_) return;
    wanted_ = wanted;
    estimated_ = estimated;
    const QSignalBlocker quiet(this);
    if (!dragging_) setValue(nearestLevel(wanted, maximum() + 1));
    update();
}

void LevelSlider::setLive(bool live) {
    if (live == live_) return;
    live_ = live;
    update();
}

double LevelSlider::xOf(double stroke) const { return kSliderMargin + stroke * (width() - 2.0 * kSliderMargin); }

QSize LevelSlider::sizeHint() const { return {160, 24}; }
QSize LevelSlider::minimumSizeHint() const { return {80, 24}; }

void LevelSlider::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const double middle = 0.5 * height();
    const double from = xOf(0.0), to = xOf(1.0);
    painter.setPen(Qt::NoPen);
    painter.setBrush(blend(colors.panel, colors.border, 0.4));
    painter.drawRoundedRect(QRectF(from - 2.0, middle - 3.0, to - from + 4.0, 6.0), 3.0, 3.0);
    if (maximum() < kMostTicks) {
        painter.setBrush(colors.border);
        for (int level = 0; level <= maximum(); ++level)
            painter.drawRect(QRectF(xOf(static_cast<double>(level) / maximum()) - 0.5, height() - 3.0, 1.0, 2.0));
    }
    const QColor fill = live_ ? colors.accent : colors.textMuted;
    QColor ahead = fill;
    ahead.setAlphaF(0.35F);
    const double handle = xOf(wanted_), mark = xOf(estimated_);
    painter.setBrush(fill);
    painter.drawRoundedRect(QRectF(from - 2.0, middle - 3.0, std::min(handle, mark) - from + 2.0, 6.0), 3.0, 3.0);
    painter.setBrush(ahead);
    painter.drawRect(QRectF(std::min(handle, mark), middle - 3.0, std::abs(handle - mark), 6.0));
    painter.setBrush(isEnabled() ? colors.text : colors.border);
    painter.drawRoundedRect(QRectF(mark - 1.0, middle - 8.0, 2.0, 16.0), 1.0, 1.0);
    painter.setPen(QPen(hasFocus() ? colors.text : fill, hasFocus() ? 2.0 : 1.5));
    painter.setBrush(underMouse() || dragging_ ? fill : colors.raised);
    painter.drawEllipse(QPointF(handle, middle), 6.0, 6.0);
}

void LevelSlider::dragTo(double x) {
    const double room = std::max(width() - 2.0 * kSliderMargin, 1.0);
    const int level = nearestLevel(std::clamp((x - kSliderMargin) / room, 0.0, 1.0), maximum() + 1);
    wanted_ = static_cast<double>(level) / maximum();
    if (level != value()) setValue(level);
    update();
    emit previewed(level);
}

void LevelSlider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    dragging_ = true;
    setSliderDown(true);
    dragTo(event->position().x());
}

void LevelSlider::mouseMoveEvent(QMouseEvent* event) {
    if (dragging_) dragTo(event->position().x());
}

void LevelSlider::mouseReleaseEvent(QMouseEvent* event) {
    if (!dragging_ || event->button() != Qt::LeftButton) return;
    dragging_ = false;
    setSliderDown(false);
    emit committed(value());
    update();
}

void LevelSlider::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape && dragging_) {
        dragging_ = false;
        setSliderDown(false);
        emit reverted();
        return;
    }
    const int before = value();
    QAbstractSlider::keyPressEvent(event);
    if (value() != before) emit committed(value());
}

void LevelSlider::wheelEvent(QWheelEvent* event) {
    // Without the focus the wheel scrolls the dock: it must not move a servo in passing.
    if (!hasFocus()) return event->ignore();
    const int before = value();
    QAbstractSlider::wheelEvent(event);
    if (value() != before) emit committed(value());
}

} // namespace lumorph::studio
