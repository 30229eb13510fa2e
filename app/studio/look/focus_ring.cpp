#include "app/studio/look/focus_ring.h"

#include <QApplication>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>

namespace lumorph::studio {
namespace {

bool movesFocus(int key) { return key == Qt::Key_Tab || key == Qt::Key_Backtab; }

/// Those that show the keyboard themselves, or are so large that a ring around them says nothing.
bool ringSuits(const QWidget* widget) {
    return qobject_cast<const QLineEdit*>(widget) == nullptr && qobject_cast<const QMenu*>(widget) == nullptr &&
           qobject_cast<const QMenuBar*>(widget) == nullptr && qobject_cast<const QMainWindow*>(widget) == nullptr &&
           !widget->isWindow() && !widget->property("noFocusRing").toBool();
}

} // namespace

FocusRing::FocusRing(QObject* parent) : QObject(parent) {
    setObjectName("focus ring");
    qApp->installEventFilter(this);
    // The application's other children outlive its widgets; the frame must not.
    connect(qApp, &QCoreApplication::aboutToQuit, this, [this] { delete frame_; });
    connect(qApp, &QApplication::focusChanged, this, [this](QWidget*, QWidget* now) { follow(now); });
}

bool FocusRing::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::KeyPress) {
        if (movesFocus(static_cast<QKeyEvent*>(event)->key())) byKeyboard_ = true;
    } else if (event->type() == QEvent::MouseButtonPress) {
        byKeyboard_ = false;
        if (frame_) frame_->setWidget(nullptr);
    }
    return QObject::eventFilter(watched, event);
}

void FocusRing::follow(QWidget* widget) {
    const bool shown = byKeyboard_ && widget != nullptr && widget->isVisible() && ringSuits(widget);
    if (!shown && !frame_) return;
    if (!frame_) frame_ = new QFocusFrame; // the frame is a sibling of what it rings, and may die with its window
    frame_->setWidget(shown ? widget : nullptr);
}

} // namespace lumorph::studio
