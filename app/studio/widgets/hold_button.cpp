#include "app/studio/widgets/hold_button.h"

#include <algorithm>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kFrameMilliseconds = 16;
/// A window that was stuck sees a click's release late: what passed meanwhile was not held.
constexpr qint64 kLongestTick = 100;

bool isHoldKey(int key) { return key == Qt::Key_Space || key == Qt::Key_Return || key == Qt::Key_Enter; }

} // namespace

HoldButton::HoldButton(const QString& text, QWidget* parent) : QPushButton(text, parent) {
    setProperty("look", "hold");
    setAutoDefault(false); // Enter in a field beside it is not meant for it
    setAccessibleDescription(tr("Hold it for a second, with the mouse, Space or Enter"));
    setToolTip(tr("Hold it for a second: with the mouse, or with Space or Enter"));
    ticks_.setInterval(kFrameMilliseconds);
    connect(&ticks_, &QTimer::timeout, this, &HoldButton::tick);
}

double HoldButton::progress() const {
    if (!ticks_.isActive()) return 0.0;
    return std::min(1.0, static_cast<double>(held_) / kHoldMilliseconds);
}

void HoldButton::begin() {
    if (ticks_.isActive() || !isEnabled()) return;
    held_ = 0;
    last_.start();
    ticks_.start();
    setDown(true);
}

void HoldButton::cancel() {
    key_ = 0;
    ticks_.stop();
    setDown(false);
    update();
}

void HoldButton::tick() {
    held_ += std::min(last_.restart(), kLongestTick);
    update();
    if (held_ < kHoldMilliseconds) return;
    cancel();
    emit held();
}

bool HoldButton::event(QEvent* event) {
    // Else Enter in a dialog is its default button's.
    if (event->type() == QEvent::ShortcutOverride && isHoldKey(static_cast<QKeyEvent*>(event)->key())) event->accept();
    return QPushButton::event(event);
}

void HoldButton::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    if (!ticks_.isActive()) key_ = 0;
    begin();
}

void HoldButton::mouseDoubleClickEvent(QMouseEvent* event) { mousePressEvent(event); }

void HoldButton::mouseMoveEvent(QMouseEvent* event) {
    if (ticks_.isActive() && key_ == 0 && !rect().contains(event->position().toPoint())) cancel();
}

void HoldButton::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton && key_ == 0) cancel();
}

void HoldButton::keyPressEvent(QKeyEvent* event) {
    if (!isHoldKey(event->key())) {
        cancel();
        return QPushButton::keyPressEvent(event);
    }
    if (event->isAutoRepeat() || ticks_.isActive()) return;
    key_ = event->key();
    begin();
}

void HoldButton::keyReleaseEvent(QKeyEvent* event) {
    if (!isHoldKey(event->key())) return QPushButton::keyReleaseEvent(event);
    if (!event->isAutoRepeat() && event->key() == key_) cancel();
}

void HoldButton::focusOutEvent(QFocusEvent* event) {
    cancel();
    QPushButton::focusOutEvent(event);
}

void HoldButton::hideEvent(QHideEvent* event) {
    cancel();
    QPushButton::hideEvent(event);
}

void HoldButton::changeEvent(QEvent* event) {
    if (event->type() == QEvent::EnabledChange && !isEnabled()) cancel();
    QPushButton::changeEvent(event);
}

void HoldButton::paintEvent(QPaintEvent* event) {
    QPushButton::paintEvent(event);
    const double share = progress();
    if (share <= 0.0) return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QPainterPath shape;
    shape.addRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), 5.0, 5.0);
    painter.setClipPath(shape);
    painter.fillRect(QRectF(0, 0, share * width(), height()), currentPalette().accent);
    painter.setPen(currentPalette().onAccent);
    painter.setClipRect(QRectF(0, 0, share * width(), height()), Qt::IntersectClip);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextShowMnemonic, text());
}

} // namespace lumorph::studio
