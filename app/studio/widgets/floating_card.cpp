#include "app/studio/widgets/floating_card.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

void FloatingCard::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QColor plate = colors.panel;
    plate.setAlphaF(0.9F);
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(colors.line, 1.0));
    painter.setBrush(plate);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 8.0, 8.0);
}

void FloatingCard::mousePressEvent(QMouseEvent* event) { event->accept(); }
void FloatingCard::wheelEvent(QWheelEvent* event) { event->accept(); }

} // namespace lumorph::studio
