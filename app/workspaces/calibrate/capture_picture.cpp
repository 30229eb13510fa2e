#include "app/workspaces/calibrate/capture_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QFontMetricsF>
#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

QColor withAlpha(QColor color, int alpha) {
    color.setAlpha(alpha);
    return color;
}

void drawArrow(QPainter& painter, const QPointF& from, const QPointF& by) {
    const QPointF to = from + by;
    painter.drawLine(from, to);
    const double length = std::hypot(by.x(), by.y());
    if (length < 4.0) return;
    const QPointF back = by / length * std::min(6.0, 0.4 * length);
    const QPointF side(-back.y() * 0.5, back.x() * 0.5);
    painter.drawLine(to, to - back + side);
    painter.drawLine(to, to - back - side);
}

/// Words on a plate that can be read on any picture.
void drawPlate(QPainter& painter, const QPointF& corner, const QString& words, const QColor& color) {
    const QFontMetricsF metrics(painter.font());
    const QSizeF size(metrics.horizontalAdvance(words) + 16.0, metrics.height() + 8.0);
    const QRectF plate(corner - QPointF(0.0, size.height()), size);
    painter.setPen(Qt::NoPen);
    painter.setBrush(withAlpha(currentPalette().panel, 225));
    painter.drawRoundedRect(plate, 4.0, 4.0);
    painter.setPen(color);
    painter.drawText(plate, Qt::AlignCenter, words);
}

/// Roots of the shares: what is rare is to be seen as well. The last bar is what may be clipped.
void drawHistogram(QPainter& painter, const QRectF& plate, const std::vector<float>& shares) {
    const Palette& colors = currentPalette();
    painter.setPen(Qt::NoPen);
    painter.setBrush(withAlpha(colors.panel, 225));
    painter.drawRoundedRect(plate, 4.0, 4.0);
    const QRectF room = plate.adjusted(6.0, 6.0, -6.0, -4.0);
    const float most = *std::ranges::max_element(shares);
    const double width = room.width() / static_cast<double>(shares.size());
    for (std::size_t i = 0; i < shares.size() && most > 0.0F; ++i) {
        const double height = room.height() * std::sqrt(static_cast<double>(shares[i] / most));
        painter.setBrush(i + 1 == shares.size() ? colors.danger : colors.accent);
        painter.drawRect(QRectF(room.left() + width * static_cast<double>(i), room.bottom() - height, width, height));
    }
}

} // namespace

CapturePicture::CapturePicture(QWidget* parent) : QWidget(parent) {
    setObjectName("calibrate.picture");
    setAccessibleName("Picture of the camera");
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void CapturePicture::show(const QImage& picture, QSize pixels, PictureMarks marks, const QString& emptyText) {
    picture_ = picture;
    pixels_ = pixels;
    marks_ = std::move(marks);
    emptyText_ = emptyText;
    update();
}

void CapturePicture::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.fillRect(rect(), colors.sunken);
    painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    if (picture_.isNull() && marks_.ghost.isEmpty() && marks_.coverage.empty()) {
        painter.setPen(colors.textMuted);
        painter.drawText(rect().adjusted(32, 32, -32, -32), Qt::AlignCenter | Qt::TextWordWrap, emptyText_);
        return;
    }
    const QSizeF whole = pixels_.isEmpty() ? QSizeF(picture_.size()) : QSizeF(pixels_);
    const QSizeF fitted = whole.scaled(QSizeF(size()), Qt::KeepAspectRatio);
    const QRectF area(QPointF((width() - fitted.width()) / 2.0, (height() - fitted.height()) / 2.0), fitted);
    const double scale = fitted.width() / whole.width();
    const auto on = [&](const QPointF& point) { return area.topLeft() + (point + QPointF(0.5, 0.5)) * scale; };
    const auto onAll = [&](const QPolygonF& points) {
        QPolygonF moved;
        for (const QPointF& point : points) moved << on(point);
        return moved;
    };
    if (!picture_.isNull()) painter.drawImage(area, picture_);
    painter.setClipRect(area);
    painter.setPen(QPen(withAlpha(colors.success, 170), 1.0));
    painter.setBrush(withAlpha(colors.success, 28));
    for (const QPolygonF& outline : marks_.coverage) painter.drawPolygon(onAll(outline));
    if (!marks_.ghost.isEmpty()) {
        painter.setPen(QPen(colors.accent, 2.5, Qt::DashLine));
        painter.setBrush(withAlpha(colors.accent, 36));
        const QPolygonF ghost = onAll(marks_.ghost);
        painter.drawPolygon(ghost);
        if (!marks_.ghostText.isEmpty()) {
            const QRectF box = ghost.boundingRect();
            drawPlate(painter, {box.center().x() - 40.0, std::min(box.bottom() + 28.0, area.bottom() - 4.0)},
                      marks_.ghostText, colors.accentText);
        }
    }
    painter.setBrush(Qt::NoBrush);
    if (marks_.arrows.empty()) {
        painter.setPen(QPen(colors.accent, 1.5));
        for (const QPointF& corner : marks_.corners) painter.drawEllipse(on(corner), 3.5, 3.5);
        if (!marks_.corners.empty()) {
            painter.setBrush(colors.accent);
            painter.drawEllipse(on(marks_.corners.front()), 4.0, 4.0);
            painter.setBrush(Qt::NoBrush);
        }
    }
    painter.setPen(QPen(colors.warning, 1.5));
    for (const PictureMarks::Arrow& arrow : marks_.arrows) {
        painter.drawEllipse(on(arrow.at), 1.0, 1.0);
        drawArrow(painter, on(arrow.at), arrow.error * scale * marks_.arrowScale);
    }
    painter.setClipping(false);
    if (!marks_.histogram.empty()) {
        const QRectF plate(area.bottomRight() - QPointF(148.0, 56.0), QSizeF(140.0, 48.0));
        drawHistogram(painter, plate, marks_.histogram);
        const double width = QFontMetricsF(painter.font()).horizontalAdvance(marks_.light) + 16.0;
        drawPlate(painter, {plate.right() - width, plate.top() - 4.0}, marks_.light, colors.text);
    }
    if (!marks_.words.isEmpty()) drawPlate(painter, area.bottomLeft() + QPointF(8.0, -8.0), marks_.words, colors.text);
}

} // namespace lumorph::studio
