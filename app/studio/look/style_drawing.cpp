#include "app/studio/look/style_drawing.h"

#include <algorithm>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

bool enabled(const QStyleOption& option) { return option.state.testFlag(QStyle::State_Enabled); }
bool hovered(const QStyleOption& option) { return enabled(option) && option.state.testFlag(QStyle::State_MouseOver); }

QColor borderOf(const QStyleOption& option, const Palette& colors) {
    if (!enabled(option)) return colors.line;
    return hovered(option) ? colors.textMuted : colors.border;
}

void drawTick(QPainter& painter, const QRectF& box, const QColor& color) {
    painter.setPen(QPen(color, 2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    const auto at = [&box](double x, double y) {
        return QPointF(box.x() + x * box.width(), box.y() + y * box.height());
    };
    painter.drawPolyline(QPolygonF({at(0.26, 0.53), at(0.43, 0.70), at(0.75, 0.33)}));
}

/// The part of a groove that is filled: from the low end, or from the high one when it is upside down.
QRectF filledPart(const QStyleOptionSlider& option, const QRectF& track, const QPointF& knob) {
    QRectF filled = track;
    if (option.orientation == Qt::Horizontal) {
        if (option.upsideDown)
            filled.setLeft(knob.x());
        else
            filled.setRight(knob.x());
    } else if (option.upsideDown) {
        filled.setTop(knob.y());
    } else {
        filled.setBottom(knob.y());
    }
    return filled;
}

} // namespace

void drawMark(QPainter& painter, const QStyleOption& option, bool round) {
    const Palette& colors = currentPalette();
    const bool on = option.state.testFlag(QStyle::State_On);
    const bool partly = option.state.testFlag(QStyle::State_NoChange);
    const QColor fill = on || partly ? colors.accent : colors.raised;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(on || partly ? QPen(fill, 1) : QPen(borderOf(option, colors), 1));
    painter.setBrush(enabled(option) ? fill : colors.panel);
    if (!enabled(option)) painter.setPen(colors.line);
    QRectF box(0, 0, 15, 15);
    box.moveCenter(QRectF(option.rect).center());
    const double corner = round ? 7.5 : 4.0;
    painter.drawRoundedRect(box, corner, corner);
    const QColor ink = enabled(option) ? colors.onAccent : disabledText(colors);
    if (on && round) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(ink);
        painter.drawEllipse(box.center(), 3.0, 3.0);
    } else if (on) {
        drawTick(painter, box, ink);
    } else if (partly) {
        painter.setPen(QPen(ink, 2, Qt::SolidLine, Qt::RoundCap));
        painter.drawLine(box.center() - QPointF(3.5, 0), box.center() + QPointF(3.5, 0));
    }
    painter.restore();
}

void drawChevronIn(QPainter& painter, const QStyleOption& option, const QRect& box, double degrees) {
    const Palette& colors = currentPalette();
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(QRectF(box).center());
    painter.rotate(degrees);
    const QColor color = !enabled(option) ? disabledText(colors) : hovered(option) ? colors.text : colors.textMuted;
    painter.setPen(QPen(color, 1.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.drawPolyline(QPolygonF({QPointF(-3.5, -1.75), QPointF(0, 1.75), QPointF(3.5, -1.75)}));
    painter.restore();
}

void drawChevron(QPainter& painter, const QStyleOption& option, double degrees) {
    drawChevronIn(painter, option, option.rect, degrees);
}

void drawSeparator(QPainter& painter, const QStyleOption& option) {
    const Palette& colors = currentPalette();
    const bool hot = option.state.testFlag(QStyle::State_MouseOver) && enabled(option);
    painter.fillRect(option.rect, colors.window);
    if (!hot) return;
    QRectF line = option.rect;
    if (line.width() < line.height())
        line = QRectF(line.center().x() - 1, line.top(), 2, line.height());
    else
        line = QRectF(line.left(), line.center().y() - 1, line.width(), 2);
    painter.fillRect(line, colors.accent);
}

void drawSlider(QPainter& painter, const QStyleOptionSlider& option, const QRect& groove, const QRect& handle) {
    const Palette& colors = currentPalette();
    const bool flat = option.orientation == Qt::Horizontal;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    QRectF track = groove;
    const QPointF knob = QRectF(handle).center();
    track = flat ? QRectF(track.left() + 1, knob.y() - 2, track.width() - 2, 4)
                 : QRectF(knob.x() - 2, track.top() + 1, 4, track.height() - 2);
    painter.setBrush(blend(colors.panel, colors.border, 0.55));
    painter.drawRoundedRect(track, 2, 2);
    painter.setBrush(enabled(option) ? colors.accent : disabledText(colors));
    painter.drawRoundedRect(filledPart(option, track, knob), 2, 2);
    const bool held =
        option.state.testFlag(QStyle::State_Sunken) && (option.activeSubControls & QStyle::SC_SliderHandle);
    painter.setPen(QPen(enabled(option) ? colors.accent : colors.line, 2));
    painter.setBrush(held ? colors.accent : hovered(option) ? colors.hovered : colors.panel);
    painter.drawEllipse(knob, 6, 6);
    painter.restore();
}

void drawScrollBar(QPainter& painter, const QStyleOptionSlider& option, const QRect& slider) {
    const Palette& colors = currentPalette();
    if (option.minimum >= option.maximum) return;
    const bool held = option.state.testFlag(QStyle::State_Sunken);
    const double margin = held || hovered(option) ? 2.5 : 3.5;
    const QRectF box = QRectF(slider).adjusted(margin, margin, -margin, -margin);
    const double corner = std::min(box.width(), box.height()) / 2;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(held              ? colors.textMuted
                     : hovered(option) ? colors.border
                                       : blend(colors.panel, colors.border, 0.6));
    painter.drawRoundedRect(box, corner, corner);
    painter.restore();
}

void drawField(QPainter& painter, const QStyleOption& option, bool framed) {
    const Palette& colors = currentPalette();
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    const bool focused = enabled(option) && option.state.testFlag(QStyle::State_HasFocus);
    painter.setPen(!framed ? QPen(Qt::NoPen) : QPen(focused ? colors.accent : borderOf(option, colors), 1));
    painter.setBrush(!enabled(option) ? colors.panel : hovered(option) ? colors.hovered : colors.raised);
    painter.drawRoundedRect(QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    painter.restore();
}

QRect scrollBarPart(const QStyleOptionSlider& option, QStyle::SubControl part) {
    const bool flat = option.orientation == Qt::Horizontal;
    const int length = flat ? option.rect.width() : option.rect.height();
    const int range = option.maximum - option.minimum;
    int size = length;
    if (range > 0)
        size = std::min(length,
                        std::max(28, static_cast<int>(qint64(option.pageStep) * length / (range + option.pageStep))));
    const int start = QStyle::sliderPositionFromValue(option.minimum, option.maximum, option.sliderPosition,
                                                      length - size, option.upsideDown);
    const auto along = [&](int from, int extent) {
        return flat ? QRect(option.rect.x() + from, option.rect.y(), extent, option.rect.height())
                    : QRect(option.rect.x(), option.rect.y() + from, option.rect.width(), extent);
    };
    switch (part) {
    case QStyle::SC_ScrollBarSlider:
        return along(start, size);
    case QStyle::SC_ScrollBarGroove:
        return along(0, length);
    case QStyle::SC_ScrollBarSubPage:
        return along(0, start);
    case QStyle::SC_ScrollBarAddPage:
        return along(start + size, length - start - size);
    default:
        return {};
    }
}

} // namespace lumorph::studio
