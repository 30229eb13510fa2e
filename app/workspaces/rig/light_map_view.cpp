#include "app/workspaces/rig/light_map_view.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/workspaces/common/field_colors.h"

namespace lumorph::studio {

namespace {

constexpr int kScaleRoom = 44;
constexpr int kMargin = 12;
constexpr int kCell = 3; ///< pixels of the widget that one look-up colours

QString millimetresText(double metres) { return QString("%1\u00A0mm").arg(1e3 * metres, 0, 'g', 2); }

QString degreesText(Angle angle) { return QString("%1\u00B0").arg(std::lround(angle.inDegrees())); }

} // namespace

LightMapView::LightMapView(QWidget* parent) : QWidget(parent) {
    setObjectName("rig.light.map");
    setAccessibleName("Light on the device from above");
    setMouseTracking(true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void LightMapView::show(std::shared_ptr<const LightMap> map, std::shared_ptr<const TriangleMesh> device,
                        const LightWish& wish) {
    map_ = std::move(map);
    device_ = std::move(device);
    wish_ = wish;
    if (device_) box_ = boundingBox(device_->positions);
    picture_ = {};
    update();
}

void LightMapView::setShown(Shown shown) {
    if (std::exchange(shown_, shown) == shown) return;
    picture_ = {};
    update();
}

QRectF LightMapView::mapArea() const {
    const QSizeF room(width() - 2 * kMargin, height() - kMargin - kScaleRoom);
    const QSizeF size = QSizeF(box_.max.x - box_.min.x, box_.max.z - box_.min.z).scaled(room, Qt::KeepAspectRatio);
    return {QPointF(kMargin + (room.width() - size.width()) / 2.0, kMargin + (room.height() - size.height()) / 2.0),
            size};
}

QPointF LightMapView::pixelOf(const glm::vec3& place) const {
    const QRectF area = mapArea();
    return {area.left() + area.width() * (place.x - box_.min.x) / (box_.max.x - box_.min.x),
            area.top() + area.height() * (place.z - box_.min.z) / (box_.max.z - box_.min.z)};
}

const LightAt* LightMapView::at(const QPointF& point) const {
    if (!map_ || !device_ || !mapArea().contains(point)) return nullptr;
    const auto squaredWay = [&](const LightAt& place) {
        const QPointF way = pixelOf(place.place) - point;
        return QPointF::dotProduct(way, way);
    };
    const auto nearest = std::ranges::min_element(map_->places, {}, squaredWay);
    return nearest == map_->places.end() ? nullptr : &*nearest;
}

double LightMapView::goodness(const LightAt& at) const {
    switch (shown_) {
    case Shown::pixels:
        return at.pixelsPerMillimetre / wish_.pixelsPerMillimetre;
    case Shown::incidence:
        return at.lit > 0.0 ? 1.0 - at.incidence.inRadians() / wish_.mostIncidence.inRadians() : 0.0;
    case Shown::blur:
        return at.lit > 0.0 ? 1.0 - at.blur / wish_.mostBlur : 0.0;
    case Shown::lit:
        break;
    }
    return at.lit;
}

void LightMapView::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(colors.line);
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    const bool blurUnknown = map_ && shown_ == Shown::blur && !map_->blurKnown;
    if (!map_ || !device_ || blurUnknown) {
        painter.setPen(colors.textMuted);
        painter.drawText(rect().adjusted(16, 8, -16, -8), Qt::AlignCenter | Qt::TextWordWrap,
                         blurUnknown ? "How sharp light is follows from the lens' aperture, or from blur that was "
                                       "measured: enter one of them below"
                                     : "The device from above, coloured by the light that reaches it");
        return;
    }
    if (picture_.isNull()) picture_ = makePicture();
    painter.drawImage(0, 0, picture_);
    paintScale(painter);
}

/// Colours by the nearest place, cut out by the triangles of the device.
QImage LightMapView::makePicture() const {
    struct Dot {
        QPointF pixel;
        QColor color;
    };
    std::vector<Dot> dots;
    dots.reserve(map_->places.size());
    for (const LightAt& place : map_->places) dots.push_back({pixelOf(place.place), gradeColor(goodness(place))});
    const QRectF area = mapArea();
    QImage coloured(size(), QImage::Format_ARGB32_Premultiplied);
    coloured.fill(Qt::transparent);
    QPainter cells(&coloured);
    for (int y = static_cast<int>(area.top()); y < area.bottom(); y += kCell)
        for (int x = static_cast<int>(area.left()); x < area.right(); x += kCell) {
            const QPointF middle(x + 0.5 * kCell, y + 0.5 * kCell);
            const auto nearest = std::ranges::min_element(dots, {}, [&middle](const Dot& dot) {
                const QPointF way = dot.pixel - middle;
                return QPointF::dotProduct(way, way);
            });
            if (nearest != dots.end()) cells.fillRect(x, y, kCell, kCell, nearest->color);
        }
    cells.end();
    QImage shape(size(), QImage::Format_ARGB32_Premultiplied);
    shape.fill(Qt::transparent);
    QPainter cut(&shape);
    cut.setPen(Qt::NoPen);
    cut.setBrush(Qt::white);
    for (const glm::uvec3& t : device_->triangles)
        cut.drawPolygon(QPolygonF{pixelOf(device_->positions[t.x]), pixelOf(device_->positions[t.y]),
                                  pixelOf(device_->positions[t.z])});
    cut.setCompositionMode(QPainter::CompositionMode_SourceIn);
    cut.drawImage(0, 0, coloured);
    return shape;
}

void LightMapView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    picture_ = {};
}

void LightMapView::paintScale(QPainter& painter) const {
    const Palette& colors = currentPalette();
    const QRectF bar(kMargin, height() - 30, width() - 2 * kMargin, 6);
    QLinearGradient gradient(bar.topLeft(), bar.topRight());
    for (int k = 0; k <= 8; ++k) gradient.setColorAt(k / 8.0, gradeColor(k / 8.0));
    painter.fillRect(bar, gradient);
    painter.setPen(colors.textMuted);
    const QRectF words(bar.left(), bar.bottom() + 2, bar.width(), 20);
    QString bad = "never lit", good = "always lit";
    if (shown_ == Shown::pixels) {
        bad = "dark";
        good = QString("%1 pixels a mm, or more").arg(wish_.pixelsPerMillimetre, 0, 'g', 3);
    } else if (shown_ == Shown::incidence) {
        bad = degreesText(wish_.mostIncidence) + ", or dark";
        good = "head on";
    } else if (shown_ == Shown::blur) {
        bad = millimetresText(wish_.mostBlur) + " wide, or dark";
        good = "sharp";
    }
    painter.drawText(words, Qt::AlignLeft | Qt::AlignVCenter, bad);
    painter.drawText(words, Qt::AlignRight | Qt::AlignVCenter, good);
}

void LightMapView::mouseMoveEvent(QMouseEvent* event) {
    const LightAt* place = at(event->position());
    if (!place) return QToolTip::hideText();
    const QString often = QString("Lit in %1 of the states").arg(shareText(place->lit));
    QString how = QString("%1 pixels a mm and %2 from head on, at worst")
                      .arg(place->pixelsPerMillimetre, 0, 'f', 2)
                      .arg(degreesText(place->incidence));
    if (map_->blurKnown) how += QString("; a point is %1 wide").arg(millimetresText(place->blur));
    QToolTip::showText(event->globalPosition().toPoint(), place->lit > 0.0 ? often + "\n" + how : "Never lit", this);
}

} // namespace lumorph::studio
