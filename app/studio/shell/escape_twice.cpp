#include "app/studio/shell/escape_twice.h"

#include <utility>

#include <QCoreApplication>
#include <QKeyEvent>

namespace lumorph::studio {
namespace {

/// The same press passes here several times: as a shortcut, to the window, to the widget and to its parents. They come
/// at once; a release that got lost (a dialog closed on the press) must not swallow the next press.
constexpr Microseconds kSamePress{60'000};

constexpr auto kCloses = "closesByEscape";

bool closesByEscape(const QObject* watched) {
    if (!watched->isWidgetType()) return false;
    const auto* widget = static_cast<const QWidget*>(watched);
    if (widget->property(kCloses).toBool()) return true;
    return widget->isWindow() && (widget->windowType() == Qt::Popup || widget->windowType() == Qt::Dialog);
}

} // namespace

EscapeTwice::EscapeTwice(const Clock& clock, QObject* parent) : QObject(parent), clock_(clock) {
    QCoreApplication::instance()->installEventFilter(this);
}

void EscapeTwice::setCloses(QWidget& widget, bool closes) { widget.setProperty(kCloses, closes); }

bool EscapeTwice::eventFilter(QObject* watched, QEvent* event) {
    const auto type = event->type();
    const bool any = !open_.isEmpty();
    if (type == QEvent::Show && closesByEscape(watched)) open_.insert(watched);
    // By its address: what is being destroyed is no dialog any more.
    if (type == QEvent::Hide && open_.remove(watched)) closed_ = true;
    if (any == open_.isEmpty()) emit openChanged(!any);
    if (type != QEvent::KeyPress && type != QEvent::KeyRelease && type != QEvent::ShortcutOverride)
        return QObject::eventFilter(watched, event);
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->isAutoRepeat()) return false;
    if (key->key() != Qt::Key_Escape) {
        if (type == QEvent::KeyPress) twice_.reset();
        return false;
    }
    if (type == QEvent::KeyRelease)
        down_ = false;
    else if (!down_ || clock_.now() - downAt_ > kSamePress)
        press();
    return false;
}

void EscapeTwice::press() {
    settle(); // the one before
    down_ = true;
    downAt_ = clock_.now();
    closed_ = false;
    unsettled_ = true;
    // What it closes it closes while it is handed around.
    QMetaObject::invokeMethod(this, &EscapeTwice::settle, Qt::QueuedConnection);
}

void EscapeTwice::settle() {
    if (!std::exchange(unsettled_, false)) return;
    if (closed_) {
        twice_.reset();
        emit spent();
    } else if (twice_.press(downAt_)) {
        emit pressed();
    } else {
        emit single();
    }
}

} // namespace lumorph::studio
