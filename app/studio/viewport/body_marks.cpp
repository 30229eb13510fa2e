#include "app/studio/viewport/body_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "app/studio/viewport/view_marks.h"

namespace lumorph::studio {
namespace {

constexpr float kAxis = 0.06F; // metres
constexpr float kLeastPixels = 26.0F;
constexpr double kEdge = 26.0;                 // pixels that an arrow keeps from the edge
constexpr double kArrow = 9.0;                 // pixels
constexpr double kFresh = 0.25, kFaded = 2.25; // seconds
constexpr double kFaintest = 0.25;
constexpr int kLongestName = 160; // pixels

QPointF toPoint(const glm::vec2& p) { return {static_cast<double>(p.x), static_cast<double>(p.y)}; }

/// Text that can be read on any picture.
void paintBodyName(QPainter& painter, const QPointF& at, const QString& name, Qt::Alignment side,
                   const Palette& palette) {
    const QString text = painter.fontMetrics().elidedText(name, Qt::ElideRight, kLongestName);
    const double width = painter.fontMetrics().horizontalAdvance(text);
    QPointF left = at + QPointF(0.0, 4.0);
    if (side == Qt::AlignRight) left.rx() -= width;
    if (side == Qt::AlignHCenter) left.rx() -= 0.5 * width;
    QColor halo = palette.window;
    halo.setAlpha(170);
    painter.setPen(halo);
    for (const QPointF& off : {QPointF(-1, 0), QPointF(1, 0), QPointF(0, -1), QPointF(0, 1)})
        painter.drawText(left + off, text);
    painter.setPen(palette.text);
    painter.drawText(left, text);
}

void paintBodyAxes(QPainter& painter, const QPointF& at, const ViewCamera& camera, const BodyMark& body,
                   const glm::vec2& size, const Palette& palette) {
    paintBodyName(painter, at + QPointF(9.0, -9.0), body.name, Qt::AlignLeft, palette); // under the axes
    const float length = std::max(kAxis, kLeastPixels * metresPerPixel(camera, body.position, size));
    const std::array<QColor, 3> colors = axisColors(palette);
    QColor halo = palette.window;
    halo.setAlpha(150);
    for (const bool isHalo : {true, false})
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 way(0.0F);
            way[axis] = length;
            const auto end = pixelOf(camera, body.position + body.rotation * way, size);
            if (!end) continue;
            const QColor& color = isHalo ? halo : colors[static_cast<std::size_t>(axis)];
            painter.setPen(QPen(color, isHalo ? 5.0 : 2.5, Qt::SolidLine, Qt::RoundCap));
            painter.drawLine(at, toPoint(*end));
        }
    painter.setPen(QPen(palette.window, 1.0));
    painter.setBrush(palette.text);
    painter.drawEllipse(at, 3.0, 3.0);
}

/// Where the way from the middle to what is not in sight meets the edge.
void paintArrow(QPainter& painter, const QSize& view, const ViewCamera& camera, const BodyMark& body,
                const Palette& palette) {
    const glm::vec4 seen = viewFromWorld(camera) * glm::vec4(body.position, 1.0F);
    QPointF way(static_cast<double>(seen.x), -static_cast<double>(seen.y));
    const double length = std::hypot(way.x(), way.y());
    way = length > 1e-6 ? way / length : QPointF(0.0, 1.0);
    const double halfWide = 0.5 * view.width() - kEdge, halfHigh = 0.5 * view.height() - kEdge;
    const double reach =
        std::min(halfWide / std::max(1e-6, std::abs(way.x())), halfHigh / std::max(1e-6, std::abs(way.y())));
    const QPointF tip = QPointF(0.5 * view.width(), 0.5 * view.height()) + reach * way;
    const QPointF across(-way.y(), way.x());
    painter.setPen(QPen(palette.window, 1.0));
    painter.setBrush(palette.text);
    painter.drawPolygon(QPolygonF({tip + kArrow * way, tip - 0.6 * kArrow * across, tip + 0.6 * kArrow * across}));
    const Qt::Alignment side = way.x() > 0.4 ? Qt::AlignRight : way.x() < -0.4 ? Qt::AlignLeft : Qt::AlignHCenter;
    paintBodyName(painter, tip - 14.0 * way, body.name, side, palette);
}

} // namespace

double strengthOf(double secondsAgo) {
    const double faded = std::clamp((secondsAgo - kFresh) / (kFaded - kFresh), 0.0, 1.0);
    return 1.0 - (1.0 - kFaintest) * faded;
}

void paintBodies(QPainter& painter, const QSize& view, const ViewCamera& camera, const std::vector<BodyMark>& bodies,
                 const Palette& palette) {
    if (bodies.empty()) return;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    QFont font = painter.font();
    font.setPixelSize(12);
    painter.setFont(font);
    const glm::vec2 size(static_cast<float>(view.width()), static_cast<float>(view.height()));
    for (const BodyMark& body : bodies) {
        painter.setOpacity(body.strength);
        const auto at = pixelOf(camera, body.position, size);
        if (at && QRectF(0.0, 0.0, view.width(), view.height()).contains(toPoint(*at)))
            paintBodyAxes(painter, toPoint(*at), camera, body, size, palette);
        else
            paintArrow(painter, view, camera, body, palette);
    }
    painter.restore();
}

} // namespace lumorph::studio
