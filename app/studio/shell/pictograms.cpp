#include "app/studio/shell/pictograms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <QPainterPath>

namespace lumorph::studio {
namespace {

/// All are drawn in a square of this side, around its middle.
constexpr double kSide = 64.0;

double sway(double turn) { return std::sin(2.0 * std::numbers::pi * turn); }

/// A small filled triangle at `tip` that points along `way`, of length 1.
void paintArrowhead(QPainter& painter, const QPointF& tip, const QPointF& way) {
    const QPointF across(-way.y(), way.x());
    const QPointF root = tip - 7.0 * way;
    painter.setBrush(painter.pen().color());
    painter.drawPolygon(QPolygonF{tip, root + 4.5 * across, root - 4.5 * across});
    painter.setBrush(Qt::NoBrush);
}

void paintMouse(QPainter& painter, double turn) {
    painter.save();
    painter.translate(7.0 * sway(turn), 0.0);
    painter.drawRoundedRect(QRectF(-11.0, -17.0, 22.0, 34.0), 11.0, 11.0);
    painter.drawLine(QPointF(0.0, -10.0), QPointF(0.0, -4.0));
    painter.restore();
    paintArrowhead(painter, {-29.0, 0.0}, {-1.0, 0.0});
    paintArrowhead(painter, {29.0, 0.0}, {1.0, 0.0});
}

/// The four arrow keys, one after the other pressed.
void paintKeys(QPainter& painter, double turn) {
    constexpr double kKey = 18.0, kGap = 3.0;
    const struct {
        QPointF middle, way;
    } keys[] = {{{-kKey - kGap, 12.0}, {-1.0, 0.0}},
                {{0.0, 12.0 - kKey - kGap}, {0.0, -1.0}},
                {{kKey + kGap, 12.0}, {1.0, 0.0}},
                {{0.0, 12.0}, {0.0, 1.0}}};
    const int pressed = static_cast<int>(4.0 * turn) % 4;
    for (int k = 0; k < 4; ++k) {
        const auto& [middle, way] = keys[k];
        QColor fill = painter.pen().color();
        fill.setAlphaF(k == pressed ? 0.35F : 0.0F);
        painter.setBrush(fill);
        painter.drawRoundedRect(QRectF(middle - QPointF(kKey, kKey) / 2.0, QSizeF(kKey, kKey)), 4.0, 4.0);
        painter.setBrush(Qt::NoBrush);
        paintArrowhead(painter, middle + 4.0 * way, way);
    }
}

/// The device between two hands, leaning.
void paintTilt(QPainter& painter, double turn) {
    painter.save();
    painter.rotate(12.0 * sway(turn));
    painter.drawRoundedRect(QRectF(-26.0, -4.0, 52.0, 8.0), 3.0, 3.0);
    painter.restore();
    for (const double side : {-1.0, 1.0}) {
        QPainterPath arc;
        arc.moveTo(side * 24.0, 22.0);
        arc.quadTo(side * 33.0, 12.0, side * 33.0, -2.0);
        painter.drawPath(arc);
    }
    paintArrowhead(painter, {-33.0, -10.0}, {0.0, -1.0});
    paintArrowhead(painter, {33.0, -10.0}, {0.0, -1.0});
}

void paintPad(QPainter& painter, double turn) {
    QPainterPath body;
    body.moveTo(-18.0, -12.0);
    body.lineTo(18.0, -12.0);
    body.cubicTo(30.0, -12.0, 32.0, 18.0, 24.0, 18.0);
    body.cubicTo(18.0, 18.0, 16.0, 8.0, 9.0, 8.0);
    body.lineTo(-9.0, 8.0);
    body.cubicTo(-16.0, 8.0, -18.0, 18.0, -24.0, 18.0);
    body.cubicTo(-32.0, 18.0, -30.0, -12.0, -18.0, -12.0);
    painter.drawPath(body);
    painter.setBrush(painter.pen().color());
    const double angle = 2.0 * std::numbers::pi * turn;
    painter.drawEllipse(QPointF(-12.0, -2.0) + 2.5 * QPointF(std::cos(angle), std::sin(angle)), 4.0, 4.0);
    painter.drawEllipse(QPointF(12.0, -6.0), 2.2, 2.2);
    painter.drawEllipse(QPointF(17.0, -1.0), 2.2, 2.2);
    painter.setBrush(Qt::NoBrush);
}

/// A pointing hand that taps; rings run out from its finger.
void paintHand(QPainter& painter, double turn) {
    const QPointF tip(-5.0, -20.0);
    QColor ring = painter.pen().color();
    ring.setAlphaF(ring.alphaF() * static_cast<float>(1.0 - turn));
    const QPen ink = painter.pen();
    painter.setPen(QPen(ring, 2.0));
    painter.drawEllipse(tip, 4.0 + 16.0 * turn, 4.0 + 16.0 * turn);
    painter.setPen(ink);
    QPainterPath hand;
    hand.moveTo(-9.0, 8.0);
    hand.lineTo(-9.0, -16.0);
    hand.cubicTo(-9.0, -22.0, -1.0, -22.0, -1.0, -16.0);
    hand.lineTo(-1.0, -3.0);
    hand.lineTo(12.0, 0.0);
    hand.cubicTo(17.0, 1.0, 19.0, 4.0, 18.0, 9.0);
    hand.lineTo(15.0, 24.0);
    hand.lineTo(-5.0, 24.0);
    hand.lineTo(-16.0, 10.0);
    hand.cubicTo(-18.0, 6.0, -13.0, 3.0, -9.0, 8.0);
    QColor fill = ink.color();
    fill.setAlphaF(0.25F * fill.alphaF());
    painter.setBrush(fill);
    painter.drawPath(hand);
    painter.setBrush(Qt::NoBrush);
}

} // namespace

void paintPictogram(QPainter& painter, Pictogram what, const QRectF& box, const QColor& ink, double turn) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(box.center());
    const double scale = std::min(box.width(), box.height()) / kSide;
    painter.scale(scale, scale);
    painter.setPen(QPen(ink, 2.4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setBrush(Qt::NoBrush);
    switch (what) {
    case Pictogram::mouse:
        paintMouse(painter, turn);
        break;
    case Pictogram::keys:
        paintKeys(painter, turn);
        break;
    case Pictogram::tilt:
        paintTilt(painter, turn);
        break;
    case Pictogram::pad:
        paintPad(painter, turn);
        break;
    case Pictogram::hand:
        paintHand(painter, turn);
        break;
    }
    painter.restore();
}

void paintKeycap(QPainter& painter, const QRectF& box, const QString& text, const QColor& ink) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(ink, 1.5));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box.adjusted(0.75, 0.75, -0.75, -0.75), 5.0, 5.0);
    painter.drawText(box, Qt::AlignCenter, text);
    painter.restore();
}

} // namespace lumorph::studio
