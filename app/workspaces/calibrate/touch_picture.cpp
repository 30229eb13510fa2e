#include "app/workspaces/calibrate/touch_picture.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <QPainter>
#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr double kMargin = 24.0; // pixels
constexpr double kLean = 0.55;   // of the height that is seen: the view looks down by about a radian
constexpr double kDepth = 0.835; // of the depth likewise
const glm::vec3 kLight = glm::normalize(glm::vec3(-0.4F, 1.0F, 0.5F));

/// Metres in the picture, y down.
QPointF seen(const glm::dvec3& point) { return {point.x, kDepth * point.z - kLean * point.y}; }
double towardsViewer(const glm::dvec3& point) { return kLean * point.z + kDepth * point.y; }

} // namespace

TouchPicture::TouchPicture(QWidget* parent) : QWidget(parent) {
    setObjectName("chain.corner");
    setMinimumHeight(280);
}

void TouchPicture::show(std::shared_ptr<const Rig> rig, const std::optional<PlannedLandmark>& corner) {
    if (rig != rig_) device_ = {};
    rig_ = std::move(rig);
    corner_ = corner;
    setAccessibleName(corner ? tr("The device, with the corner to touch") : QString());
    setVisible(rig_ && corner_);
    update();
}

void TouchPicture::resizeEvent(QResizeEvent*) { device_ = {}; }

void TouchPicture::drawDevice() {
    const TriangleMesh& mesh = rig_->restMesh();
    QRectF box;
    for (const glm::vec3& at : mesh.positions) {
        const QPointF point = seen(glm::dvec3(at));
        box |= QRectF(point, QSizeF(1e-9, 1e-9));
    }
    scale_ = std::min((width() - 2.0 * kMargin) / box.width(), (height() - 2.0 * kMargin) / box.height());
    origin_ = QPointF(0.5 * width(), 0.5 * height()) - scale_ * box.center();
    // Far triangles first: nearer ones hide them.
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto corner = [&](std::size_t triangle, int k) {
        return glm::dvec3(mesh.positions[mesh.triangles[triangle][k]]);
    };
    const auto nearness = [&](std::size_t t) {
        return towardsViewer(corner(t, 0)) + towardsViewer(corner(t, 1)) + towardsViewer(corner(t, 2));
    };
    std::ranges::sort(order, {}, nearness);
    device_ = QPixmap(size() * devicePixelRatioF());
    device_.setDevicePixelRatio(devicePixelRatioF());
    device_.fill(Qt::transparent);
    QPainter painter(&device_);
    painter.setRenderHint(QPainter::Antialiasing);
    for (const std::size_t t : order) {
        const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
        const glm::dvec3 across = glm::cross(b - a, c - a);
        if (glm::length(across) <= 0.0 || towardsViewer(across) <= 0.0) continue;
        const double lit = std::max(0.0, glm::dot(glm::normalize(across), glm::dvec3(kLight)));
        const QColor color = QColor::fromHsvF(0.58, 0.06, 0.35 + 0.5 * lit);
        painter.setPen(QPen(color, 1.0)); // closes the seams between triangles
        painter.setBrush(color);
        const QPointF outline[] = {origin_ + scale_ * seen(a), origin_ + scale_ * seen(b), origin_ + scale_ * seen(c)};
        painter.drawConvexPolygon(outline, 3);
    }
}

void TouchPicture::paintEvent(QPaintEvent*) {
    if (!rig_ || !corner_) return;
    if (device_.isNull()) drawDevice();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.drawPixmap(0, 0, device_);
    const QPointF at = origin_ + scale_ * seen(corner_->onModel);
    const QColor accent = currentPalette().accent;
    painter.setPen(QPen(accent, 3.0));
    painter.drawEllipse(at, 12.0, 12.0);
    painter.setPen(Qt::NoPen);
    painter.setBrush(accent);
    painter.drawEllipse(at, 4.0, 4.0);
}

} // namespace lumorph::studio
