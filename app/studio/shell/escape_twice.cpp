#include "app/studio/shell/escape_twice.h"

#include <QCoreApplication>
#include <QKeyEvent>

namespace lumorph::studio {
namespace {

/// The same press passes here several times: as a shortcut, to the window, to the widget and to its parents. They come
/// at once; a release that got lost (a dialog closed on the press) must not swallow the next press.
constexpr Microseconds kSamePress{60'000};

} // namespace

EscapeTwice::EscapeTwice(const Clock& clock, QObject* parent) : QObject(parent), clock_(clock) {
    QCoreApplication::instance()->installEventFilter(this);
}

bool EscapeTwice::eventFilter(QObject* watched, QEvent* event) {
    const auto type = event->type();
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
    const Microseconds now = clock_.now();
    down_ = true;
    downAt_ = now;
    if (twice_.press(now)) emit pressed();
}

} // namespace lumorph::studio
