#include "app/studio/viewport/view_marks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QCoreApplication>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

namespace lumorph::studio {
namespace {

constexpr double kMarksMargin = 16.0;
constexpr double kAxisLength = 20.0;

struct Axis {
    glm::vec3 seen;
    QColor color;
    const char* name;
};

// Far axes first.
std::array<Axis, 3> axesFarFirst(const ViewCamera& camera, const Palette& palette) {
    const glm::mat3 turn(viewFromWorld(camera));
    const std::array<QColor, 3> colors = axisColors(palette);
    std::array<Axis, 3> axes{{{turn[0], colors[0], "X"}, {turn[1], colors[1], "Y"}, {turn[2], colors[2], "Z"}}};
    std::sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return a.seen.z < b.seen.z; });
    return axes;
}

void paintWorldAxes(QPainter& painter, const QPointF& middle, const ViewCamera& camera, const Palette& palette) {
    QFont font = painter.font();
    font.setPixelSize(10);
    font.setWeight(QFont::DemiBold);
    painter.setFont(font);
    for (const Axis& axis : axesFarFirst(camera, palette)) {
        const QPointF along(static_cast<double>(axis.seen.x), -static_cast<double>(axis.seen.y));
        painter.setPen(QPen(axis.color, 2.0, Qt::SolidLine, Qt::RoundCap));
        painter.drawLine(middle, middle + kAxisLength * along);
        // The letter of an axis that points at the viewer would cover the others.
        if (std::hypot(along.x(), along.y()) < 0.3) continue;
        const QPointF at = middle + (kAxisLength + 8.0) * along;
        painter.drawText(QRectF(at.x() - 8, at.y() - 8, 16, 16), Qt::AlignCenter, QString::fromLatin1(axis.name));
    }
}

// Text that can be read on any picture: its outline in the colour of the window.
void paintReadable(QPainter& painter, const QRectF& where, const QString& text, const QColor& color,
                   const QColor& behind) {
    QColor halo = behind;
    halo.setAlpha(150);
    painter.setPen(halo);
    for (const QPointF& offset : {QPointF(-1, 0), QPointF(1, 0), QPointF(0, -1), QPointF(0, 1)})
        painter.drawText(where.translated(offset), Qt::AlignLeft | Qt::AlignVCenter, text);
    painter.setPen(color);
    painter.drawText(where, Qt::AlignLeft | Qt::AlignVCenter, text);
}

QFont smallFont(const QPainter& painter) {
    QFont font = painter.font();
    font.setPixelSize(12);
    font.setWeight(QFont::Normal);
    return font;
}

QString word(const char* text) { return QCoreApplication::translate("ViewMarks", text); }

} // namespace

std::array<QColor, 3> axisColors(const Palette& palette) {
    if (palette.window.lightness() < 128) return {QColor(236, 96, 90), QColor(126, 200, 92), QColor(98, 160, 248)};
    return {QColor(192, 48, 44), QColor(50, 124, 36), QColor(36, 92, 196)};
}

QString projectionName(const ViewCamera& camera) {
    QString projection = camera.orthographic ? word("Orthographic") : word("Perspective");
    const double pitch = camera.pitch.inDegrees();
    constexpr double exact = 0.05;
    if (pitch > 90.0 - exact) return projection + word(" top");
    if (pitch < -90.0 + exact) return projection + word(" bottom");
    const double quarters = camera.yaw.inDegrees() / 90.0;
    if (std::abs(pitch) > exact || std::abs(quarters - std::round(quarters)) > exact / 90.0) return projection;
    static constexpr std::array sides{" front", " right", " back", " left"};
    const auto side = static_cast<int>(std::lround(quarters)) & 3;
    return projection + word(sides[static_cast<std::size_t>(side)]);
}

void paintLegend(QPainter& painter, const QSize& view, const ViewCamera& camera, const QString& grid,
                 const Palette& palette) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    const QPointF middle(kMarksMargin + 26.0, view.height() - kMarksMargin - 26.0);
    paintWorldAxes(painter, middle, camera, palette);
    painter.setFont(smallFont(painter));
    const double left = middle.x() + 46.0;
    paintReadable(painter, {left, middle.y() + 8.0, 240.0, 18.0}, projectionName(camera), palette.text, palette.window);
    if (!grid.isEmpty())
        paintReadable(painter, {left, middle.y() - 10.0, 240.0, 18.0}, word("Grid ") + grid, palette.textMuted,
                      palette.window);
    painter.restore();
}

void paintChip(QPainter& painter, const QSize& view, const QPointF& pointer, const QString& text,
               const Palette& palette) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    QFont font = painter.font();
    font.setPixelSize(13);
    font.setWeight(QFont::DemiBold);
    painter.setFont(font);
    const QSizeF size(painter.fontMetrics().horizontalAdvance(text) + 20.0, 26.0);
    QPointF at = pointer + QPointF(18.0, 16.0);
    at.setX(std::clamp(at.x(), 4.0, std::max(4.0, view.width() - size.width() - 4.0)));
    if (at.y() + size.height() > view.height() - 4.0) at.setY(pointer.y() - 16.0 - size.height());
    const QRectF plate(at, size);
    QColor fill = palette.raised;
    fill.setAlpha(240);
    painter.setPen(QPen(palette.border, 1.0));
    painter.setBrush(fill);
    painter.drawRoundedRect(plate.adjusted(0.5, 0.5, -0.5, -0.5), 6.0, 6.0);
    painter.setPen(palette.text);
    painter.drawText(plate, Qt::AlignCenter, text);
    painter.restore();
}

void paintNotice(QPainter& painter, const QSize& view, const QString& text, const Palette& palette) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(smallFont(painter));
    const QRectF room(kMarksMargin, kMarksMargin, std::max(120.0, view.width() - 140.0), 200.0);
    const QRectF lines = painter.boundingRect(room.adjusted(12, 8, -12, -8), Qt::TextWordWrap, text);
    painter.setPen(QPen(palette.warning, 1.0));
    painter.setBrush(palette.panel);
    painter.drawRoundedRect(lines.adjusted(-11.5, -7.5, 11.5, 7.5), 6.0, 6.0);
    painter.setPen(palette.text);
    painter.drawText(lines, Qt::TextWordWrap, text);
    painter.restore();
}

bool cameByKey(const QFocusEvent& event) {
    const Qt::FocusReason why = event.reason();
    return why == Qt::TabFocusReason || why == Qt::BacktabFocusReason || why == Qt::ShortcutFocusReason;
}

void paintFocusRing(QPainter& painter, const QSize& view, const Palette& palette) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(palette.accentText, 2.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(QRectF(1.0, 1.0, view.width() - 2.0, view.height() - 2.0), 3.0, 3.0);
    painter.restore();
}

} // namespace lumorph::studio
