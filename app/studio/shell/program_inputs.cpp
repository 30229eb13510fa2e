#include "app/studio/shell/program_inputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>

namespace lumorph::studio {
namespace {

constexpr double kWholeLean = 0.35; ///< of the view's shorter side, from its middle
constexpr double kRests = 0.06;     ///< of the whole: a pointer in the middle asks for nothing

const char* inputOf(int key) {
    switch (key) {
    case Qt::Key_Left:
        return "key.left";
    case Qt::Key_Right:
        return "key.right";
    case Qt::Key_Up:
        return "key.up";
    case Qt::Key_Down:
        return "key.down";
    case Qt::Key_R:
        return "key.restart";
    case Qt::Key_N:
        return "key.next";
    case Qt::Key_A:
        return "key.attract";
    case Qt::Key_Plus:
    case Qt::Key_Equal: // the same key, without Shift
        return "key.in";
    case Qt::Key_Minus:
        return "key.out";
    case Qt::Key_Comma:
        return "key.turnLeft";
    case Qt::Key_Period:
        return "key.turnRight";
    case Qt::Key_W:
        return "key.rain";
    case Qt::Key_V:
        return "key.bend";
    default:
        return nullptr;
    }
}

double share(double from, double whole) {
    const double value = std::clamp(from / whole, -1.0, 1.0);
    return std::abs(value) < kRests ? 0.0 : value;
}

} // namespace

ProgramInputs::ProgramInputs(StudioLoop& loop, QWidget& view) : QObject(&view), loop_(loop), view_(view) {
    view.setMouseTracking(true);
    view.installEventFilter(this);
}

bool ProgramInputs::eventFilter(QObject* watched, QEvent* event) {
    if (!loop_.program()) {
        held_.clear();
        pointed_ = false;
        return QObject::eventFilter(watched, event);
    }
    switch (event->type()) {
    case QEvent::ShortcutOverride: {
        const auto* key = static_cast<QKeyEvent*>(event);
        if (!inputOf(key->key()) || (key->modifiers() & ~Qt::KeypadModifier)) break;
        event->accept();
        return true;
    }
    case QEvent::KeyPress:
    case QEvent::KeyRelease: {
        const auto* key = static_cast<QKeyEvent*>(event);
        if (event->type() == QEvent::KeyPress && (key->modifiers() & ~Qt::KeypadModifier)) break;
        if (!inputOf(key->key())) break;
        return key->isAutoRepeat() || press(key->key(), event->type() == QEvent::KeyPress);
    }
    case QEvent::Enter:
        view_.setFocus(Qt::MouseFocusReason); // so that its keys work, too
        break;
    case QEvent::MouseMove: { // a drag leads the eye around
        const auto* mouse = static_cast<QMouseEvent*>(event);
        if (mouse->buttons() == Qt::NoButton) point(mouse->position());
        break;
    }
    case QEvent::Leave:
    case QEvent::FocusOut:
    case QEvent::Hide:
        letGo();
        break;
    default:
        break;
    }
    return QObject::eventFilter(watched, event);
}

void ProgramInputs::point(const QPointF& at) {
    const double whole = std::max(1.0, kWholeLean * std::min(view_.width(), view_.height()));
    pointed_ = true;
    loop_.input("pointer.x", share(at.x() - 0.5 * view_.width(), whole));
    loop_.input("pointer.y", share(at.y() - 0.5 * view_.height(), whole));
}

/// Nothing stays pressed behind somebody who has gone.
void ProgramInputs::letGo() {
    if (std::exchange(pointed_, false)) {
        loop_.input("pointer.x", 0.0);
        loop_.input("pointer.y", 0.0);
        loop_.input("pointer.over", 0.0);
    }
    for (const int key : std::exchange(held_, {})) loop_.input(inputOf(key), 0.0);
}

bool ProgramInputs::press(int key, bool down) {
    if (down)
        held_.insert(key);
    else if (!held_.remove(key))
        return true; // pressed elsewhere
    loop_.input(inputOf(key), down ? 1.0 : 0.0);
    return true;
}

} // namespace lumorph::studio
