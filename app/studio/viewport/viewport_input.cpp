#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QNativeGestureEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/studio/viewport/view_marks.h"
#include "app/studio/viewport/viewport_data.h"

namespace lumorph::studio {
namespace {

constexpr double kClickReach = 4.0;  // pixels that a click may wander
constexpr double kWheelNotch = 1.18; // nearer by this a notch
constexpr double kPinchLimit = 0.5;

const char* verbOf(GizmoHandle handle) {
    switch (handle) {
    case GizmoHandle::turn:
        return QT_TR_NOOP("Turn %1");
    case GizmoHandle::size:
        return QT_TR_NOOP("Scale to %1");
    default:
        return QT_TR_NOOP("Move %1");
    }
}

// Keys that the view uses when it has the focus, before any shortcut of the window.
bool isOurs(int key) {
    switch (key) {
    case Qt::Key_F:
    case Qt::Key_Home:
    case Qt::Key_1:
    case Qt::Key_3:
    case Qt::Key_5:
    case Qt::Key_7:
    case Qt::Key_Left:
    case Qt::Key_Right:
    case Qt::Key_Up:
    case Qt::Key_Down:
    case Qt::Key_Plus:
    case Qt::Key_Equal:
    case Qt::Key_Minus:
        return true;
    default:
        return false;
    }
}

std::optional<glm::vec2> arrowOf(int key) {
    switch (key) {
    case Qt::Key_Left:
        return glm::vec2(-1.0F, 0.0F);
    case Qt::Key_Right:
        return glm::vec2(1.0F, 0.0F);
    case Qt::Key_Up:
        return glm::vec2(0.0F, -1.0F);
    case Qt::Key_Down:
        return glm::vec2(0.0F, 1.0F);
    default:
        return std::nullopt;
    }
}

} // namespace

std::optional<CubeSide> ViewportWidget::Data::cubeAt(const QPointF& at) const {
    return viewCubeAt(viewCubeBox(self.size()), motion.camera(), at);
}

void ViewportWidget::Data::glideTo(const ViewCamera& camera) {
    cameraGiven = true;
    motion.glideTo(camera, Clock::now());
    startTicking();
}

void ViewportWidget::Data::turnBy(const glm::vec2& by) {
    motion.set(orbited(motion.camera(), by, size()));
    cameraMoved();
}

void ViewportWidget::Data::panBy(const glm::vec2& by) {
    motion.set(panned(motion.camera(), by, size()));
    cameraMoved();
}

void ViewportWidget::Data::zoomBy(double factor, const QPointF& at) {
    cameraGiven = true;
    motion.zoomBy(factor, toVec(at), size(), Clock::now());
    startTicking();
}

void ViewportWidget::Data::setHot(std::optional<GizmoHandle> handle, std::optional<CubeSide> side) {
    if (handle == hotHandle && side == hotSide) return;
    const bool gizmoChanged = handle != hotHandle;
    hotHandle = handle;
    hotSide = side;
    if (gizmoChanged) changed();
    self.update();
}

void ViewportWidget::Data::showCursor() {
    const auto shape = [&] {
        switch (dragging) {
        case Drag::orbit:
        case Drag::cube:
        case Drag::gizmo:
            return Qt::ClosedHandCursor;
        case Drag::pan:
            return Qt::SizeAllCursor;
        default:
            break;
        }
        if (hotSide) return Qt::PointingHandCursor;
        return hotHandle ? Qt::OpenHandCursor : Qt::ArrowCursor;
    }();
    if (self.cursor().shape() != shape) self.setCursor(shape);
}

void ViewportWidget::Data::hover(const QPointF& at) {
    if (dragging != Drag::none) return;
    const bool inside = QRectF(self.rect()).contains(at);
    const auto side = inside ? cubeAt(at) : std::nullopt;
    std::optional<GizmoHandle> handle;
    if (inside && gizmo && !side) handle = gizmoAt(*gizmo, motion.camera(), toVec(at), size(), 1.0);
    setHot(handle, side);
    showCursor();
}

void ViewportWidget::Data::press(const QPointF& at, Qt::MouseButton with, Qt::KeyboardModifiers modifiers) {
    // A second button during a drag changes nothing.
    if (dragging != Drag::none) return;
    pointer = at;
    hover(at);
    button = with;
    pressedAt = at;
    const bool shift = modifiers.testFlag(Qt::ShiftModifier);
    if (with == Qt::RightButton || (with == Qt::MiddleButton && shift)) {
        dragging = Drag::pan;
    } else if (with == Qt::MiddleButton) {
        dragging = Drag::orbit;
    } else if (with == Qt::LeftButton && hotSide) {
        dragging = Drag::cube;
    } else if (with == Qt::LeftButton && hotHandle) {
        dragging = Drag::gizmo;
        grip = Grip{*gizmo, *hotHandle, at, modifiers.testFlag(Qt::ControlModifier), false, {}};
    } else if (with == Qt::LeftButton) {
        dragging = Drag::undecided;
    }
    showCursor();
}

void ViewportWidget::Data::drag(const QPointF& to, Qt::KeyboardModifiers modifiers) {
    const glm::vec2 by = toVec(to - pointer);
    const bool wandered = QLineF(pressedAt, to).length() >= kClickReach;
    if (dragging == Drag::undecided && wandered) {
        dragging = modifiers.testFlag(Qt::ShiftModifier) ? Drag::pan : Drag::orbit;
        // What was held back until now.
        pointer = pressedAt;
        drag(to, modifiers);
        showCursor();
        return;
    }
    pointer = to;
    switch (dragging) {
    case Drag::orbit:
        turnBy(by);
        break;
    case Drag::cube:
        if (!wandered) break;
        // From now on it is no click.
        setHot(std::nullopt, std::nullopt);
        dragging = Drag::orbit;
        turnBy(by);
        break;
    case Drag::pan:
        panBy(by);
        break;
    case Drag::gizmo:
        if (grip->moved || wandered) dragGrip(to, modifiers.testFlag(Qt::ControlModifier));
        break;
    default:
        break;
    }
}

void ViewportWidget::Data::release(const QPointF& at) {
    const Drag ended = std::exchange(dragging, Drag::none);
    button = Qt::NoButton;
    if (ended == Drag::cube && hotSide) self.viewFrom(glm::vec3(*hotSide));
    if (ended == Drag::gizmo) dropGrip();
    if (ended == Drag::undecided) click(at);
    hover(at);
}

void ViewportWidget::Data::dragGrip(const QPointF& to, bool coarse) {
    const GizmoDrag now =
        dragGizmo(grip->start, grip->handle, motion.camera(), toVec(grip->from), toVec(to), size(), coarse);
    grip->moved = true;
    grip->coarse = coarse;
    grip->label = QString::fromStdString(now.label);
    gizmo = Gizmo{now.placement, now.centre};
    changed();
    self.update();
    emit self.gizmoDragged(now.placement);
}

void ViewportWidget::Data::cancelGrip(bool tell) {
    const bool moved = grip->moved;
    gizmo = grip->start;
    grip.reset();
    dragging = Drag::none;
    changed();
    self.update();
    showCursor();
    if (moved && tell) emit self.gizmoCancelled();
}

void ViewportWidget::Data::dropGrip() {
    if (!grip) return;
    const Grip ended = *std::exchange(grip, std::nullopt);
    changed();
    self.update();
    if (ended.moved) emit self.gizmoDropped(tr(verbOf(ended.handle)).arg(ended.label));
}

void ViewportWidget::Data::click(const QPointF& at) {
    if (!scene) return;
    const Ray ray = rayThrough(motion.camera(), toVec(at), size());
    // A scene may hold a million voxels: not in the window's thread.
    picker.start([this, shown = scene, ray] {
        const ViewportHit hit = pick(*shown, ray).value_or(ViewportHit{});
        QMetaObject::invokeMethod(
            &self, [this, hit] { emit self.picked(hit); }, Qt::QueuedConnection);
    });
}

bool ViewportWidget::Data::key(int key, Qt::KeyboardModifiers modifiers) {
    if (grip) {
        // The camera stands still during a drag.
        if (key == Qt::Key_Escape) cancelGrip(true);
        return key == Qt::Key_Escape || isOurs(key);
    }
    if (modifiers & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
    if (const auto arrow = arrowOf(key)) {
        const float step = size().y / 12.0F; // 15 degrees
        modifiers.testFlag(Qt::ShiftModifier) ? panBy(-step * *arrow) : turnBy(step * *arrow);
        return true;
    }
    const QPointF middle = QRectF(self.rect()).center();
    switch (key) {
    case Qt::Key_F:
        self.frameSelected();
        return true;
    case Qt::Key_Home:
        self.frameAll();
        return true;
    case Qt::Key_1:
        self.viewFrom({0, 0, 1});
        return true;
    case Qt::Key_3:
        self.viewFrom({1, 0, 0});
        return true;
    case Qt::Key_7:
        self.viewFrom({0, 1, 0});
        return true;
    case Qt::Key_5:
        self.setOrthographic(!motion.camera().orthographic);
        return true;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
        zoomBy(kWheelNotch, middle);
        return true;
    case Qt::Key_Minus:
        zoomBy(1.0 / kWheelNotch, middle);
        return true;
    default:
        return false;
    }
}

bool ViewportWidget::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride) {
        const auto* pressed = static_cast<QKeyEvent*>(event);
        const bool plain = !(pressed->modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier));
        if ((data_->grip && pressed->key() == Qt::Key_Escape) || (plain && isOurs(pressed->key()))) {
            event->accept();
            return true;
        }
    }
    if (event->type() == QEvent::NativeGesture) {
        const auto* gesture = static_cast<QNativeGestureEvent*>(event);
        if (gesture->gestureType() == Qt::ZoomNativeGesture) {
            data_->zoomBy(1.0 + std::clamp(gesture->value(), -kPinchLimit, kPinchLimit), gesture->position());
            return true;
        }
    }
    return QWidget::event(event);
}

void ViewportWidget::mousePressEvent(QMouseEvent* event) {
    if (data_->ringed) {
        data_->ringed = false;
        update();
    }
    data_->press(event->position(), event->button(), event->modifiers());
}

void ViewportWidget::mouseMoveEvent(QMouseEvent* event) {
    if (data_->dragging != Data::Drag::none) {
        data_->drag(event->position(), event->modifiers());
        return;
    }
    data_->pointer = event->position();
    data_->hover(event->position());
}

void ViewportWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (data_->dragging != Data::Drag::none && event->button() == data_->button) data_->release(event->position());
}

void ViewportWidget::wheelEvent(QWheelEvent* event) {
    // A touchpad's pixels are worth what a wheel's notches of the same way are.
    const double notches = event->angleDelta().y() / 120.0;
    if (notches != 0.0 && !data_->grip) data_->zoomBy(std::pow(kWheelNotch, notches), event->position());
    event->accept();
}

void ViewportWidget::keyPressEvent(QKeyEvent* event) {
    if (data_->grip && event->key() == Qt::Key_Control && data_->grip->moved) data_->dragGrip(data_->pointer, true);
    if (!data_->key(event->key(), event->modifiers())) QWidget::keyPressEvent(event);
}

void ViewportWidget::keyReleaseEvent(QKeyEvent* event) {
    if (data_->grip && event->key() == Qt::Key_Control && data_->grip->moved) data_->dragGrip(data_->pointer, false);
    QWidget::keyReleaseEvent(event);
}

void ViewportWidget::leaveEvent(QEvent* event) {
    if (data_->dragging == Data::Drag::none) {
        data_->pointer = Data::kNowhere;
        data_->hover(data_->pointer);
    }
    QWidget::leaveEvent(event);
}

void ViewportWidget::focusInEvent(QFocusEvent* event) {
    data_->ringed = cameByKey(*event);
    update();
    QWidget::focusInEvent(event);
}

void ViewportWidget::focusOutEvent(QFocusEvent* event) {
    data_->ringed = false;
    update();
    QWidget::focusOutEvent(event);
}

} // namespace lumorph::studio
