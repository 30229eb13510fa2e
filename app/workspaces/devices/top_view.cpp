#include "app/workspaces/devices/top_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kHeight = 160;
constexpr double kLeastReach = 0.5, kMostReach = 50.0;
constexpr double kMargin = 14.0;
constexpr double kAxis = 18.0; ///< pixels of an axis that lies flat
const QColor kAxisColors[] = {QColor(0xe0, 0x55, 0x55), QColor(0x4c, 0xb0, 0x5a), QColor(0x55, 0x8c, 0xf0)};

/// Of world metres to the widget's pixels.
struct TopMap {
    QPointF origin;
    double scale = 1.0;
    [[nodiscard]] QPointF of(const glm::dvec3& at) const { return origin + scale * QPointF(at.x, at.z); }
};

void drawGround(QPainter& painter, const TopMap& map, const QRectF& box) {
    const Palette& colors = currentPalette();
    painter.setPen(QPen(colors.line, 1));
    painter.drawLine(QPointF(map.origin.x(), box.top() + 1), QPointF(map.origin.x(), box.bottom() - 1));
    painter.drawLine(QPointF(box.left() + 1, map.origin.y()), QPointF(box.right() - 1, map.origin.y()));
    // One length to compare with: the longest of these that is not too long.
    double length = 0.1;
    for (const double next : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0})
        if (next * map.scale < 0.3 * box.width()) length = next;
    const QPointF from(box.left() + kMargin, box.bottom() - kMargin);
    painter.setPen(QPen(colors.textMuted, 1));
    painter.drawLine(from, from + QPointF(length * map.scale, 0));
    painter.drawText(from + QPointF(0, -4), QString("%1 m").arg(length));
    painter.drawText(QRectF(box).adjusted(kMargin, 4, -kMargin, 0), Qt::AlignRight | Qt::AlignTop, "x →  z ↓");
}

void drawBody(QPainter& painter, const TopMap& map, const TopView::Body& body) {
    const Palette& colors = currentPalette();
    const QPointF at = map.of(body.pose.position);
    painter.setOpacity(body.seen ? 1.0 : 0.35);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 way(0.0);
        way[axis] = 1.0;
        way = body.pose.rotation * way;
        painter.setPen(QPen(kAxisColors[axis], 2.0, Qt::SolidLine, Qt::RoundCap));
        painter.drawLine(at, at + kAxis * QPointF(way.x, way.z));
    }
    painter.setPen(Qt::NoPen);
    painter.setBrush(colors.text);
    painter.drawEllipse(at, 3.0, 3.0);
    painter.setPen(colors.text);
    painter.drawText(at + QPointF(8, -6), painter.fontMetrics().elidedText(body.name, Qt::ElideRight, 96));
    painter.setOpacity(1.0);
}

} // namespace

TopView::TopView(QWidget* parent) : QWidget(parent) {
    setAccessibleName("Tracked bodies from above");
    setToolTip(
        "From above, in the world's frame. Red, green and blue are the axes x, y and z of each body; a body that "
        "is upright shows its green one as a dot. The grey cross is the world's origin.");
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TopView::show(std::vector<Body> bodies) {
    bodies_ = std::move(bodies);
    double farthest = 0.0;
    for (const Body& body : bodies_)
        farthest = std::max({farthest, std::abs(body.pose.position.x), std::abs(body.pose.position.z)});
    // In steps, so that the picture does not breathe with every move.
    while (reach_ < 1.05 * farthest && reach_ < kMostReach) reach_ *= 2.0;
    while (reach_ > kLeastReach && reach_ > 4.0 * farthest) reach_ *= 0.5;
    update();
}

QSize TopView::sizeHint() const { return {240, kHeight}; }
QSize TopView::minimumSizeHint() const { return {160, kHeight}; }

void TopView::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF box = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
    painter.setPen(QPen(colors.line, 1));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(box, 4, 4);
    painter.setClipRect(box);
    const double room = 0.5 * std::min(box.width(), box.height()) - kMargin;
    const TopMap map{box.center(), room / reach_};
    drawGround(painter, map, box);
    for (const Body& body : bodies_) drawBody(painter, map, body);
}

} // namespace lumorph::studio
