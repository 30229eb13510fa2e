#include "app/workspaces/scene/direction_dial.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

constexpr double kDialMargin = 10.0;
constexpr double kHandle = 6.0;
constexpr double kLowest = 3.0 * std::numbers::pi / 180.0; ///< a light in the horizon casts endless shadows
constexpr double kStep = 5.0 * std::numbers::pi / 180.0;

struct Bearing {
    double azimuth = 0.0;   ///< from +X towards +Z, the front
    double elevation = 0.0; ///< above the horizon
};

Bearing bearingOf(const glm::vec3& direction) {
    const double flat = std::hypot(direction.x, direction.z);
    return {std::atan2(direction.z, direction.x), std::max(0.0, std::atan2(static_cast<double>(direction.y), flat))};
}

glm::vec3 directionOf(Bearing bearing) {
    const double elevation = std::clamp(bearing.elevation, kLowest, std::numbers::pi / 2.0);
    return {std::cos(elevation) * std::cos(bearing.azimuth), std::sin(elevation),
            std::cos(elevation) * std::sin(bearing.azimuth)};
}

} // namespace

DirectionDial::DirectionDial(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    setCursor(Qt::CrossCursor);
    setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
    setToolTip("Where the light comes from, seen from above; the front is below. Drag the point, or use the arrow "
               "keys: left and right walk around, up and down climb and sink.");
}

void DirectionDial::setDirection(const glm::vec3& direction) {
    if (dragging_ || direction == direction_) return;
    direction_ = direction;
    update();
}

double DirectionDial::radius() const { return std::min(width(), height()) / 2.0 - kDialMargin; }

QPointF DirectionDial::handle() const {
    const Bearing bearing = bearingOf(direction_);
    const double share = 1.0 - bearing.elevation / (std::numbers::pi / 2.0);
    return QPointF(width() / 2.0, height() / 2.0) +
           radius() * share * QPointF(std::cos(bearing.azimuth), std::sin(bearing.azimuth));
}

void DirectionDial::drag(const QPointF& at) {
    const QPointF from = at - QPointF(width() / 2.0, height() / 2.0);
    const double share = std::min(1.0, std::hypot(from.x(), from.y()) / std::max(1.0, radius()));
    direction_ = directionOf({std::atan2(from.y(), from.x()), (1.0 - share) * std::numbers::pi / 2.0});
    update();
    emit previewed(direction_);
}

void DirectionDial::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPointF middle(width() / 2.0, height() / 2.0);
    QRadialGradient sky(middle, radius());
    sky.setColorAt(0.0, colors.hovered);
    sky.setColorAt(1.0, colors.sunken);
    painter.setPen(QPen(colors.border, 1.0));
    painter.setBrush(sky);
    painter.drawEllipse(middle, radius(), radius());
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colors.line, 1.0));
    for (const double share : {1.0 / 3.0, 2.0 / 3.0}) painter.drawEllipse(middle, share * radius(), share * radius());
    // The device, as small as it lies there.
    painter.setBrush(colors.raised);
    painter.drawRoundedRect(QRectF(middle.x() - 10, middle.y() - 7, 20, 14), 2, 2);
    painter.setPen(QPen(colors.accent, 1.5));
    painter.drawLine(middle, handle());
    painter.setPen(QPen(colors.onAccent, 1.0));
    painter.setBrush(isEnabled() ? colors.accent : colors.border);
    painter.drawEllipse(handle(), kHandle, kHandle);
}

void DirectionDial::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    before_ = direction_;
    dragging_ = true;
    drag(event->position());
}

void DirectionDial::mouseMoveEvent(QMouseEvent* event) {
    if (dragging_) drag(event->position());
}

void DirectionDial::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !dragging_) return;
    dragging_ = false;
    emit committed(direction_);
}

void DirectionDial::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape && dragging_) {
        dragging_ = false;
        direction_ = before_;
        update();
        emit reverted();
        return;
    }
    Bearing bearing = bearingOf(direction_);
    switch (event->key()) {
    case Qt::Key_Left:
        bearing.azimuth -= kStep;
        break;
    case Qt::Key_Right:
        bearing.azimuth += kStep;
        break;
    case Qt::Key_Up:
        bearing.elevation += kStep;
        break;
    case Qt::Key_Down:
        bearing.elevation -= kStep;
        break;
    default:
        QWidget::keyPressEvent(event);
        return;
    }
    direction_ = directionOf(bearing);
    update();
    emit committed(direction_);
}

} // namespace lumorph::studio
