#include "app/workspaces/rig/sheet_picture.h"

#include <algorithm>
#include <utility>

#include <QPainter>
#include <QTransform>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

QPolygonF polygonOf(const std::vector<glm::dvec2>& page) {
    QPolygonF polygon;
    for (const glm::dvec2& p : page) polygon << QPointF(p.x, p.y);
    return polygon;
}

/// As large as fits, in the middle of the box; the page's y points up.
QTransform boxFromPage(const QRectF& page, const QRectF& box) {
    const double scale =
        std::min(box.width() / std::max(1e-9, page.width()), box.height() / std::max(1e-9, page.height()));
    QTransform transform;
    transform.translate(box.center().x(), box.center().y());
    transform.scale(scale, -scale);
    transform.translate(-page.center().x(), -page.center().y());
    return transform;
}

QLineF bendOf(const Flap& flap) {
    const glm::dvec2 from = flap.frame.page(flap.rim.front());
    const glm::dvec2 to = flap.frame.page(flap.rim.back());
    return {from.x, from.y, to.x, to.y};
}

} // namespace

SheetPicture::SheetPicture(QWidget* parent) : QWidget(parent) { setFixedSize(sizeHint()); }

void SheetPicture::show(std::vector<glm::dvec2> outline, std::vector<Flap> flaps) {
    for (glm::dvec2& place : outline) place = pageOf(place);
    outline_ = std::move(outline);
    flaps_ = std::move(flaps);
    update();
}

void SheetPicture::paintEvent(QPaintEvent* /*event*/) {
    if (outline_.empty()) return;
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPolygonF outline = polygonOf(outline_);
    const QTransform place = boxFromPage(outline.boundingRect(), QRectF(rect()).adjusted(4, 4, -4, -4));
    painter.setPen(QPen(colors.border, 1.2));
    painter.setBrush(colors.raised);
    painter.drawPolygon(place.map(outline));
    for (const Flap& flap : flaps_) {
        painter.setPen(QPen(colors.border, 1));
        painter.setBrush(blend(colors.raised, colors.accent, 0.25));
        painter.drawPolygon(place.map(polygonOf(flap.outline)));
    }
    painter.setPen(QPen(colors.accentText, 2.2, Qt::SolidLine, Qt::RoundCap));
    for (const Flap& flap : flaps_)
        if (flap.rim.size() > 1) painter.drawLine(place.map(bendOf(flap)));
}

} // namespace lumorph::studio
