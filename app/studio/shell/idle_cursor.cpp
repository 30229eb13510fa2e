#include "app/studio/shell/idle_cursor.h"

#include <QEvent>
#include <QGuiApplication>

namespace lumorph::studio {
namespace {

constexpr int kIdleMilliseconds = 3000;

} // namespace

IdleCursor::IdleCursor(QObject* parent) : QObject(parent) {
    idle_.setSingleShot(true);
    connect(&idle_, &QTimer::timeout, this, [this] { setHidden(true); });
    idle_.start(kIdleMilliseconds);
    QCoreApplication::instance()->installEventFilter(this);
}

IdleCursor::~IdleCursor() { setHidden(false); }

bool IdleCursor::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::MouseMove || event->type() == QEvent::MouseButtonPress) {
        setHidden(false);
        idle_.start(kIdleMilliseconds);
    }
    return QObject::eventFilter(watched, event);
}

void IdleCursor::setHidden(bool hidden) {
    if (hidden == hidden_) return;
    hidden_ = hidden;
    hidden ? QGuiApplication::setOverrideCursor(Qt::BlankCursor) : QGuiApplication::restoreOverrideCursor();
}

} // namespace lumorph::studio
