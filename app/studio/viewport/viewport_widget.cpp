#include "app/studio/viewport/viewport_widget.h"

#include <algorithm>
#include <cmath>

#include <QPainter>
#include <QResizeEvent>

#include "app/studio/viewport/view_marks.h"
#include "app/studio/viewport/viewport_data.h"

namespace lumorph::studio {
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
    asked = pixels();
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
    // A view smaller than its marks shows only the picture.
    if (view.width() > 220 && view.height() > 160) {
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
    data_->dragging = Data::Drag::none;
    data_->renderer.forget(data_->number);
}

} // namespace lumorph::studio
