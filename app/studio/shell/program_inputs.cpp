#include "app/studio/shell/program_inputs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <QKeyEvent>
#include <QPointingDevice>
#include <QWheelEvent>

namespace lumorph::studio {
namespace {

constexpr double kWholeLean = 0.35; ///< of the view's shorter side, from its middle
constexpr double kRests = 0.06;     ///< of the whole: a pointer in the middle asks for nothing

constexpr auto kTakes = "takesProgramInputs";

struct KeyInput {
    int key;
    const char* input;
};
constexpr KeyInput kKeys[] = {
    {Qt::Key_Left, "key.left"},
    {Qt::Key_Right, "key.right"},
    {Qt::Key_Up, "key.up"},
    {Qt::Key_Down, "key.down"},
    {Qt::Key_R, "key.restart"},
    {Qt::Key_N, "key.next"},
    {Qt::Key_A, "key.attract"},
    {Qt::Key_O, "key.off"},
    {Qt::Key_0, "key.0"},
    {Qt::Key_1, "key.1"},
    {Qt::Key_2, "key.2"},
    {Qt::Key_3, "key.3"},
    {Qt::Key_4, "key.4"},
    {Qt::Key_5, "key.5"},
    {Qt::Key_6, "key.6"},
    {Qt::Key_7, "key.7"},
    {Qt::Key_8, "key.8"},
    {Qt::Key_9, "key.9"},
    {Qt::Key_Plus, "key.in"},
    {Qt::Key_Equal, "key.in"}, // the same key, without Shift
    {Qt::Key_Minus, "key.out"},
    {Qt::Key_Comma, "key.turnLeft"},
    {Qt::Key_Period, "key.turnRight"},
    {Qt::Key_W, "key.rain"},
    {Qt::Key_V, "key.bend"},
};

const char* inputOf(int key) {
    const auto found = std::ranges::find(kKeys, key, &KeyInput::key);
    return found == std::end(kKeys) ? nullptr : found->input;
}

bool isByTouch(const QMouseEvent& mouse) {
    const QPointingDevice* device = mouse.pointingDevice();
    return device != nullptr && device->type() == QInputDevice::DeviceType::TouchScreen;
}

double share(double from, double whole) {
    const double value = std::clamp(from / whole, -1.0, 1.0);
    return std::abs(value) < kRests ? 0.0 : value;
}

} // namespace

ProgramInputs::ProgramInputs(StudioLoop& loop, QWidget& view) : QObject(&view), loop_(loop), view_(view) {
    view.setMouseTracking(true);
    view.setProperty(kTakes, true);
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
        if (forVisitors_ || mouse->buttons() == Qt::NoButton) point(mouse->position());
        if (forVisitors_) return true;
        break;
    }
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::Wheel:
        if (forVisitors_) return pointByPress(*event);
        break;
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

/// A finger points as long as it lies there, a mouse anyway.
bool ProgramInputs::pointByPress(const QEvent& event) {
    if (event.type() == QEvent::Wheel) {
        const double notches = static_cast<const QWheelEvent&>(event).angleDelta().y() / 120.0;
        if (notches != 0.0) loop_.input("wheel", notches);
        return true;
    }
    const auto& mouse = static_cast<const QMouseEvent&>(event);
    loop_.input("pointer.held", event.type() == QEvent::MouseButtonRelease ? 0.0 : 1.0);
    if (event.type() != QEvent::MouseButtonRelease)
        point(mouse.position());
    else if (isByTouch(mouse))
        letGo();
    return true;
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
        loop_.input("pointer.held", 0.0);
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

bool isViewKey(int key) { return key == Qt::Key_B || key == Qt::Key_L; }

bool isProgramKey(int key) { return inputOf(key) != nullptr; }

bool takesProgramInputs(const QObject& view) { return view.property(kTakes).toBool(); }

} // namespace lumorph::studio
