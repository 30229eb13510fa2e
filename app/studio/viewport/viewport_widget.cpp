#include "app/studio/viewport/viewport_widget.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <QImage>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QNativeGestureEvent>
#include <QPainter>
#include <QPointF>
#include <QResizeEvent>
#include <QThreadPool>
#include <QTimer>
#include <QWheelEvent>
#include <QWindow>

#include "app/studio/viewport/camera_motion.h"
#include "app/studio/viewport/gl_page.h"
#include "app/studio/viewport/view_cube.h"
#include "app/studio/viewport/view_marks.h"

namespace lumorph::studio {

/// The inside of a viewport: what is shown and how frames come, and what the pointer and the keys do.
struct ViewportWidget::Data {
    using Clock = std::chrono::steady_clock;

    /// The pointer is not over the view.
    static constexpr QPointF kNowhere{-1e4, -1e4};

    /// What a pressed button does.
    enum class Drag { none, undecided, orbit, pan, cube, gizmo, overlay };

    /// The drag of a handle.
    struct Grip {
        Gizmo start;
        GizmoHandle handle = GizmoHandle::moveX;
        QPointF from;
        bool coarse = false;
        bool moved = false;
        QString label;
    };

    Data(ViewportWidget& widget, RenderThread& thread);
    ~Data();

    // Frames.
    void changed();      ///< of what is to be drawn: asks for a frame
    void cameraMoved();  ///< the same, and tells the owner
    void prepareScene(); ///< the owner's scene with the gizmo's lines
    void frameFirstScene();
    void takeFrame();
    void showReason();
    void tick();
    void startTicking();
    [[nodiscard]] bool wantsFrames() const;
    [[nodiscard]] bool isExposed() const;
    [[nodiscard]] QSize pixels() const;
    [[nodiscard]] glm::vec2 size() const;
    void paintFrame(QPainter& painter) const;
    void paintMarks(QPainter& painter) const;

    // Pointer and keys; true when used.
    void press(const QPointF& at, Qt::MouseButton with, Qt::KeyboardModifiers modifiers);
    void drag(const QPointF& to, Qt::KeyboardModifiers modifiers);
    void release(const QPointF& at);
    void hover(const QPointF& at);
    void click(const QPointF& at);
    void dragGrip(const QPointF& to, bool coarse);
    void cancelGrip(bool tell);
    void cancelOverlay();
    void snapChanged(bool coarse);                                                 ///< Ctrl went down or up
    [[nodiscard]] bool holds() const { return grip || dragging == Drag::overlay; } ///< a handle
    void dropGrip();
    void setHot(std::optional<GizmoHandle> handle, std::optional<CubeSide> side);
    void showCursor();
    [[nodiscard]] bool key(int key, Qt::KeyboardModifiers modifiers);
    void turnBy(const glm::vec2& pixels);
    void panBy(const glm::vec2& pixels);
    void zoomBy(double factor, const QPointF& at);
    void glideTo(const ViewCamera& camera);
    [[nodiscard]] std::optional<CubeSide> cubeAt(const QPointF& at) const;

    ViewportWidget& self;
    RenderThread& renderer;
    const int number;

    std::shared_ptr<const ViewportScene> scene;
    std::shared_ptr<const ViewportScene> prepared; ///< `scene`, with the gizmo when there is one
    Box selection;
    std::optional<Gizmo> gizmo;
    std::vector<BodyMark> bodies;
    PaneOverlay* overlay = nullptr;
    bool overlayMoved = false; ///< a drag of it has begun
    bool active = true;
    bool cameraGiven = false; ///< the owner or the user has chosen where to look from
    CameraMotion motion;
    QTimer ticker;

    DrawnFrame frame; ///< on the screen or about to be
    QSize asked;      ///< size of the newest request, pixels
    std::uint64_t painted = 0;
    bool unpainted = false; ///< `frame` was not painted yet
    QString notice;         ///< why frames do not come
    GlPage* page = nullptr;
    bool ringed = false; ///< the focus came by key

    Drag dragging = Drag::none;
    Qt::MouseButton button = Qt::NoButton;
    QPointF pressedAt;
    QPointF pointer = kNowhere;
    std::optional<Grip> grip;
    std::optional<GizmoHandle> hotHandle;
    std::optional<CubeSide> hotSide;

    QThreadPool picker; ///< last: waits for its work before the rest goes
};

inline glm::vec2 toVec(const QPointF& p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

namespace {

constexpr int kTickMilliseconds = 12;
// Degrees of pitch below which the ground is a line without squares.
constexpr double kGridOnEdge = 0.5;

// From the front, right and above: where a new view looks from.
ViewCamera firstCamera() {
    ViewCamera camera;
    camera.yaw = Angle::degrees(30.0);
    camera.pitch = Angle::degrees(28.0);
    return camera;
}

/// In a small view cube and legend would lie over what it is there to show.
bool hasRoomForMarks(const QSize& view) { return view.width() > 320 && view.height() > 220; }

} // namespace

ViewportWidget::Data::Data(ViewportWidget& widget, RenderThread& thread)
    : self(widget), renderer(thread), number(thread.newViewport()) {
    motion.set(firstCamera());
    picker.setMaxThreadCount(1);
    ticker.setTimerType(Qt::PreciseTimer);
    ticker.setInterval(kTickMilliseconds);
    connect(&ticker, &QTimer::timeout, &self, [this] { tick(); });
    page = new GlPage([this] { renderer.retry(); }, &self);
    page->hide();
    connect(&renderer, &RenderThread::ready, &self, [this] { showReason(); });
    connect(&renderer, &RenderThread::drawn, &self, [this](int viewport) {
        if (viewport == number) takeFrame();
    });
    connect(&renderer, &RenderThread::broke, &self, [this](const QString& why) {
        notice = tr("The view could not be drawn. %1").arg(why);
        self.update();
    });
}

ViewportWidget::Data::~Data() { picker.waitForDone(); }

QSize ViewportWidget::Data::pixels() const {
    const double ratio = self.devicePixelRatioF();
    return {static_cast<int>(std::lround(self.width() * ratio)), static_cast<int>(std::lround(self.height() * ratio))};
}

glm::vec2 ViewportWidget::Data::size() const {
    return {static_cast<float>(self.width()), static_cast<float>(self.height())};
}

bool ViewportWidget::Data::wantsFrames() const {
    return active && scene && self.isVisible() && !pixels().isEmpty() && !page->isVisibleTo(&self);
}

/// A window that is minimised or on another desktop is painted again when it comes back.
bool ViewportWidget::Data::isExposed() const {
    const QWindow* window = self.window()->windowHandle();
    return window == nullptr || window->isExposed();
}

void ViewportWidget::Data::prepareScene() {
    if (!gizmo) {
        prepared = scene;
        return;
    }
    auto with = std::make_shared<ViewportScene>(*scene);
    const auto lines = gizmoLines(*gizmo, motion.camera(), size(), 1.0, grip ? grip->handle : hotHandle, scene->accent);
    with->lines.insert(with->lines.end(), lines.begin(), lines.end());
    prepared = std::move(with);
}

void ViewportWidget::Data::frameFirstScene() {
    if (cameraGiven || !scene || !(glm::length(scene->bounds.size()) > 0.0F)) return;
    cameraGiven = true;
    motion.set(framed(motion.camera(), scene->bounds, size().x / size().y));
    emit self.cameraChanged();
}

void ViewportWidget::Data::changed() {
    if (!wantsFrames()) return;
    frameFirstScene();
    prepareScene();
    asked = isExposed() ? pixels() : QSize();
    if (asked.isEmpty()) return;
    renderer.request(number, {prepared, motion.camera(), asked, self.devicePixelRatioF(), true});
}

void ViewportWidget::Data::cameraMoved() {
    cameraGiven = true;
    changed();
    self.update();
    emit self.cameraChanged();
}

void ViewportWidget::Data::takeFrame() {
    auto taken = renderer.takeFrame(number);
    if (!taken) return;
    frame = std::move(*taken);
    unpainted = true;
    notice.clear();
    self.update();
}

void ViewportWidget::Data::showReason() {
    const auto why = renderer.failure();
    page->setReason(why.value_or(QString()));
    page->setVisible(why.has_value());
    page->setGeometry(self.rect());
    self.update();
    changed();
}

void ViewportWidget::Data::startTicking() {
    if (!ticker.isActive()) ticker.start();
}

void ViewportWidget::Data::tick() {
    motion.advance(Clock::now());
    if (!motion.moves()) ticker.stop();
    hover(pointer);
    cameraMoved();
}

void ViewportWidget::Data::paintFrame(QPainter& painter) const {
    if (frame.image.isNull()) {
        painter.fillRect(self.rect(), currentPalette().window);
        painter.setPen(currentPalette().textMuted);
        painter.drawText(self.rect(), Qt::AlignCenter, tr("Preparing the view..."));
        return;
    }
    const QSize wanted = pixels();
    painter.save();
    // In pixels of the screen, so that an image of the right size is copied and nothing else.
    const double ratio = self.devicePixelRatioF();
    painter.scale(1.0 / ratio, 1.0 / ratio);
    if (frame.image.size() == wanted) {
        painter.drawImage(QPoint(0, 0), frame.image);
    } else {
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(QRect(QPoint(0, 0), wanted), frame.image);
    }
    painter.restore();
}

void ViewportWidget::Data::paintMarks(QPainter& painter) const {
    const Palette& colors = currentPalette();
    const ViewCamera& camera = motion.camera();
    const QSize view = self.size();
    if (!frame.image.isNull()) paintBodies(painter, view, camera, bodies, colors);
    if (overlay && !frame.image.isNull()) overlay->paint(painter, view);
    if (hasRoomForMarks(view)) {
        const bool onEdge = std::abs(camera.pitch.inDegrees()) < kGridOnEdge;
        const QString grid =
            scene && scene->grid && !onEdge ? QString::fromStdString(gridOf(camera, size()).label) : QString();
        paintLegend(painter, view, camera, grid, colors);
        paintViewCube(painter, viewCubeBox(view), camera, hotSide, colors);
    }
    if (grip && grip->moved) paintChip(painter, view, pointer, grip->label, colors);
    if (!notice.isEmpty()) paintNotice(painter, view, notice, colors);
    if (ringed) paintFocusRing(painter, view, colors);
}

ViewportWidget::ViewportWidget(RenderThread& renderer, QWidget* parent)
    : QWidget(parent), data_(std::make_unique<Data>(*this, renderer)) {
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    // The right button pans.
    setContextMenuPolicy(Qt::PreventContextMenu);
    setMinimumSize(120, 90);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    setAccessibleName(tr("3D view"));
    setAccessibleDescription(tr("Arrow keys turn the view, with Shift they move it; + and - zoom; F frames what is "
                                "selected, Home everything; 1, 3 and 7 look from the front, the right and the top."));
    data_->showReason();
}

ViewportWidget::~ViewportWidget() { data_->renderer.forget(data_->number); }

void ViewportWidget::setScene(std::shared_ptr<const ViewportScene> scene) {
    if (scene == data_->scene) return;
    data_->scene = std::move(scene);
    data_->changed();
}

const std::shared_ptr<const ViewportScene>& ViewportWidget::scene() const noexcept { return data_->scene; }
const ViewCamera& ViewportWidget::camera() const noexcept { return data_->motion.camera(); }

void ViewportWidget::setCamera(const ViewCamera& camera, bool glide) {
    if (glide && isVisible()) {
        data_->glideTo(camera);
        return;
    }
    data_->motion.set(camera);
    data_->cameraMoved();
}

void ViewportWidget::setSelectionBox(const Box& box) { data_->selection = box; }

void ViewportWidget::setGizmo(std::optional<Gizmo> gizmo) {
    // Set anew with every match: what is drawn already is not drawn again.
    if (gizmo == data_->gizmo) return;
    if (!gizmo && data_->grip) data_->cancelGrip(false);
    data_->gizmo = gizmo;
    if (!data_->gizmo) data_->setHot(std::nullopt, data_->hotSide);
    data_->changed();
}

void ViewportWidget::setOverlay(PaneOverlay* overlay) {
    if (data_->dragging == Data::Drag::overlay) data_->cancelOverlay();
    data_->overlay = overlay;
    update();
}

void ViewportWidget::setBodies(std::vector<BodyMark> bodies) {
    if (bodies == data_->bodies) return;
    data_->bodies = std::move(bodies);
    update();
}

void ViewportWidget::setActive(bool active) {
    if (active == data_->active) return;
    data_->active = active;
    if (active)
        data_->changed();
    else
        data_->renderer.forget(data_->number);
}

std::uint64_t ViewportWidget::framesPainted() const noexcept { return data_->painted; }
double ViewportWidget::frameResolution() const noexcept { return data_->frame.resolution; }
double ViewportWidget::frameMilliseconds() const noexcept { return data_->frame.milliseconds; }
QImage ViewportWidget::frameImage() const { return data_->frame.image.copy(); }

bool ViewportWidget::settled() const noexcept {
    const DrawnFrame& frame = data_->frame;
    return !data_->motion.moves() && !data_->unpainted && frame.still && frame.scene == data_->prepared &&
           frame.camera == data_->motion.camera() && frame.image.size() == data_->pixels();
}

void ViewportWidget::frameAll() {
    if (data_->scene && !data_->scene->bounds.empty())
        data_->glideTo(framed(camera(), data_->scene->bounds, data_->size().x / data_->size().y));
}

void ViewportWidget::frameSelected() {
    if (data_->selection.empty())
        frameAll();
    else
        data_->glideTo(framed(camera(), data_->selection, data_->size().x / data_->size().y));
}

void ViewportWidget::viewFrom(const glm::vec3& side) {
    if (glm::length(side) > 0.0F) data_->glideTo(lookingFrom(data_->motion.destination(), side));
}

void ViewportWidget::setOrthographic(bool on) {
    ViewCamera camera = data_->motion.destination();
    if (camera.orthographic == on) return;
    camera.orthographic = on;
    setCamera(camera);
}

void ViewportWidget::paintEvent(QPaintEvent* /*event*/) {
    // On another screen than the frame was asked for.
    if (data_->wantsFrames() && data_->asked != data_->pixels()) data_->changed();
    QPainter painter(this);
    data_->paintFrame(painter);
    if (std::exchange(data_->unpainted, false)) ++data_->painted;
    data_->paintMarks(painter);
}

void ViewportWidget::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    data_->page->setGeometry(rect());
    data_->changed();
}

void ViewportWidget::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    data_->changed();
}

void ViewportWidget::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    if (data_->grip) data_->cancelGrip(true);
    if (data_->dragging == Data::Drag::overlay) data_->cancelOverlay();
    data_->dragging = Data::Drag::none;
    data_->renderer.forget(data_->number);
}

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
    if (!hasRoomForMarks(self.size())) return std::nullopt;
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
        case Drag::overlay:
            return Qt::ClosedHandCursor;
        case Drag::pan:
            return Qt::SizeAllCursor;
        default:
            break;
        }
        if (hotSide) return Qt::PointingHandCursor;
        return hotHandle || (overlay && overlay->hot()) ? Qt::OpenHandCursor : Qt::ArrowCursor;
    }();
    if (self.cursor().shape() != shape) self.setCursor(shape);
}

void ViewportWidget::Data::hover(const QPointF& at) {
    if (dragging != Drag::none) return;
    const bool inside = QRectF(self.rect()).contains(at);
    const auto side = inside ? cubeAt(at) : std::nullopt;
    if (overlay && overlay->hover(inside && !side ? at : kNowhere, self.size())) self.update();
    std::optional<GizmoHandle> handle;
    if (inside && gizmo && !side && !(overlay && overlay->hot()))
        handle = gizmoAt(*gizmo, motion.camera(), toVec(at), size(), 1.0);
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
    } else if (with == Qt::LeftButton && overlay && overlay->press(at, self.size(), modifiers)) {
        dragging = Drag::overlay;
        overlayMoved = false;
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
    case Drag::overlay:
        overlayMoved = overlayMoved || wandered;
        if (overlayMoved) overlay->drag(to, self.size(), modifiers);
        self.update();
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
    if (ended == Drag::overlay) {
        overlay->release();
        self.update();
    }
    if (ended == Drag::undecided) click(at);
    hover(at);
}

void ViewportWidget::Data::dragGrip(const QPointF& to, bool coarse) {
    const GizmoDrag now =
        dragGizmo(grip->start, grip->handle, motion.camera(), toVec(grip->from), toVec(to), size(), coarse);
    grip->moved = true;
    grip->coarse = coarse;
    grip->label = QString::fromStdString(now.label);
    gizmo = Gizmo{now.placement, now.centre, grip->start.handles};
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

void ViewportWidget::Data::cancelOverlay() {
    dragging = Drag::none;
    overlay->cancel();
    self.update();
    showCursor();
}

void ViewportWidget::Data::snapChanged(bool coarse) {
    if (grip && grip->moved) dragGrip(pointer, coarse);
    if (dragging == Drag::overlay && overlayMoved) drag(pointer, coarse ? Qt::ControlModifier : Qt::NoModifier);
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
    if (holds()) {
        // The camera stands still during a drag.
        if (key == Qt::Key_Escape) grip ? cancelGrip(true) : cancelOverlay();
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
        if ((data_->holds() && pressed->key() == Qt::Key_Escape) || (plain && isOurs(pressed->key()))) {
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
    if (notches != 0.0 && !data_->holds()) data_->zoomBy(std::pow(kWheelNotch, notches), event->position());
    event->accept();
}

void ViewportWidget::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Control) data_->snapChanged(true);
    if (!data_->key(event->key(), event->modifiers())) QWidget::keyPressEvent(event);
}

void ViewportWidget::keyReleaseEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Control) data_->snapChanged(false);
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
