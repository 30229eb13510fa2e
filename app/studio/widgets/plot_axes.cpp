#include "app/studio/widgets/plot_axes.h"

#include <algorithm>
#include <cmath>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

QString number(double value, int decimals) {
    const QString text = QString::number(value, 'f', decimals);
    return text.toDouble() == 0.0 ? QString::number(0.0, 'f', decimals) : text;
}

/// In three digits, whatever its size.
QString readout(double value) { return QString::number(value, 'g', 3); }

} // namespace

QFont plotFont(const QFont& font) {
    QFont small = font;
    small.setPixelSize(11);
    return small;
}

QPointF PlotAxes::pointOf(double x, double y) const {
    const double along = steps > 0 ? x / steps : 0.0;
    return {area.left() + along * area.width(), area.bottom() - (y - low) / (high - low) * area.height()};
}

int PlotAxes::stepAt(const QPointF& pixel) const {
    if (!area.adjusted(-8, -8, 8, 8).contains(pixel) || steps <= 0) return -1;
    return std::clamp(static_cast<int>(std::lround((pixel.x() - area.left()) / area.width() * steps)), 0, steps);
}

double niceTick(double span, int most) {
    const double raw = span / std::max(1, most);
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw * (1 - 1e-9)) return factor * power;
    return 10.0 * power;
}

std::vector<QRectF> legendBoxes(const QString& y, const std::vector<Plot::Curve>& curves, const QRectF& box,
                                const QFontMetricsF& metrics) {
    std::vector<QRectF> boxes;
    const double line = metrics.height(), left = box.left() + 8, right = box.right() - 8;
    double x = left + metrics.horizontalAdvance(y) + 16, top = box.top() + 4;
    for (const auto& curve : curves) {
        const double width = metrics.horizontalAdvance(curve.name) + 16;
        if (x + width > right && x > left) {
            x = left;
            top += line + 1;
        }
        boxes.emplace_back(x, top, width, line);
        x += width + 10;
    }
    return boxes;
}

PlotAxes makeAxes(int steps, double low, double high, bool exact, const QRectF& box, double top,
                  const QFontMetricsF& metrics) {
    PlotAxes axes;
    axes.steps = std::max(0, steps);
    if (!(low <= high)) low = 0.0, high = 1.0; // no values at all
    if (low == high) low -= 0.5, high += 0.5;
    const double line = metrics.height();
    const double height = std::max(16.0, box.height() - top - 2 * line - 14);
    axes.tick = niceTick(high - low, std::max(1, static_cast<int>(height / (2.2 * line))));
    axes.low = exact ? low : std::floor(low / axes.tick + 1e-9) * axes.tick;
    axes.high = exact ? high : std::ceil(high / axes.tick - 1e-9) * axes.tick;
    axes.decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(axes.tick) - 1e-9)), 0, 6);
    const double labels = std::max(metrics.horizontalAdvance(number(axes.low, axes.decimals)),
                                   metrics.horizontalAdvance(number(axes.high, axes.decimals)));
    axes.area = QRectF(box.left() + labels + 14, box.top() + top + 6, 0, height);
    axes.area.setRight(box.right() - 12);
    const double room = metrics.horizontalAdvance(QString::number(axes.steps)) + 16;
    const int most = std::max(1, static_cast<int>(axes.area.width() / room));
    axes.stepTick = std::max(1, static_cast<int>(niceTick(std::max(1, axes.steps), most)));
    return axes;
}

void drawAxes(QPainter& painter, const PlotAxes& axes, const QString& x, const QString& y) {
    const Palette& colors = currentPalette();
    const QFontMetricsF metrics(painter.font());
    const double line = metrics.height();
    painter.setRenderHint(QPainter::Antialiasing, false);
    for (double value = std::ceil(axes.low / axes.tick - 1e-9) * axes.tick; value <= axes.high + 1e-9 * axes.tick;
         value += axes.tick) {
        const double height = axes.pointOf(0, value).y();
        painter.setPen(colors.line);
        painter.drawLine(QPointF(axes.area.left(), height), QPointF(axes.area.right(), height));
        painter.setPen(colors.textMuted);
        painter.drawText(QRectF(0, height - line / 2, axes.area.left() - 6, line), Qt::AlignRight | Qt::AlignVCenter,
                         number(value, axes.decimals));
    }
    for (int step = 0; step <= axes.steps; step += axes.stepTick) {
        const double across = axes.pointOf(step, axes.low).x();
        painter.drawText(QRectF(across - 30, axes.area.bottom() + 3, 60, line), Qt::AlignCenter, QString::number(step));
    }
    painter.setRenderHint(QPainter::Antialiasing);
    painter.drawText(QRectF(axes.area.left(), axes.area.bottom() + line + 3, axes.area.width(), line), Qt::AlignCenter,
                     x);
    painter.drawText(QRectF(8, 4, axes.area.right() - 8, line), Qt::AlignLeft | Qt::AlignVCenter, y);
}

void drawUpright(QPainter& painter, const PlotAxes& axes, double x, const QPen& pen) {
    const double across = axes.pointOf(x, axes.low).x();
    painter.setPen(pen);
    painter.drawLine(QPointF(across, axes.area.top()), QPointF(across, axes.area.bottom()));
}

void drawLegend(QPainter& painter, const std::vector<QRectF>& boxes, const std::vector<Plot::Curve>& curves) {
    for (std::size_t i = 0; i < boxes.size() && i < curves.size(); ++i) {
        if (curves[i].name.isEmpty()) continue;
        const QRectF& box = boxes[i];
        painter.setPen(currentPalette().textMuted);
        painter.drawText(box.adjusted(16, 0, 8, 0), Qt::AlignLeft | Qt::AlignVCenter, curves[i].name);
        painter.setPen(QPen(curves[i].color, 2, curves[i].dashed ? Qt::DotLine : Qt::SolidLine));
        painter.drawLine(QPointF(box.left(), box.center().y()), QPointF(box.left() + 11, box.center().y()));
    }
}

void drawReadout(QPainter& painter, const PlotAxes& axes, const QString& x, int hover,
                 const std::vector<Plot::Curve>& curves) {
    const Palette& colors = currentPalette();
    const QFontMetricsF metrics(painter.font());
    drawUpright(painter, axes, hover, QPen(colors.textMuted, 1, Qt::DotLine));
    QStringList names{x}, values{QString::number(hover)};
    std::vector<QColor> inks{colors.textMuted};
    for (const auto& curve : curves) {
        if (hover >= static_cast<int>(curve.values.size()) || !std::isfinite(curve.values[hover])) continue;
        painter.setPen(Qt::NoPen);
        painter.setBrush(curve.color);
        painter.drawEllipse(axes.pointOf(hover, curve.values[hover]), 3, 3);
        names << curve.name;
        values << readout(curve.values[hover]);
        inks.push_back(curve.color);
    }
    double nameWidth = 0, valueWidth = 0;
    for (const auto& name : names) nameWidth = std::max(nameWidth, metrics.horizontalAdvance(name));
    for (const auto& value : values) valueWidth = std::max(valueWidth, metrics.horizontalAdvance(value));
    const double line = metrics.height() + 1;
    QRectF box(0, axes.area.top() + 4, nameWidth + valueWidth + 40, names.size() * line + 8);
    const double across = axes.pointOf(hover, axes.low).x();
    const bool fitsRight = across + 8 + box.width() <= axes.area.right() + 8;
    box.moveLeft(std::max(2.0, fitsRight ? across + 8 : across - 8 - box.width()));
    painter.setPen(QPen(colors.border, 1));
    painter.setBrush(colors.raised);
    painter.drawRoundedRect(box, 4, 4);
    for (int i = 0; i < names.size(); ++i) {
        const QRectF row(box.left() + 8, box.top() + 4 + i * line, box.width() - 16, line);
        if (i > 0) painter.fillRect(QRectF(row.left(), row.center().y() - 1, 8, 2), inks[i]);
        painter.setPen(colors.textMuted);
        painter.drawText(row.adjusted(i > 0 ? 14 : 0, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, names[i]);
        painter.setPen(colors.text);
        painter.drawText(row, Qt::AlignRight | Qt::AlignVCenter, values[i]);
    }
}

} // namespace lumorph::studio
