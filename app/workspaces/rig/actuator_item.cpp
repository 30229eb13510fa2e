#include "app/workspaces/rig/actuator_item.h"

#include <QPainter>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

constexpr int kPadding = 8;
constexpr int kIcon = 18;
constexpr int kLineGap = 2;

} // namespace

QSize ActuatorItem::sizeHint(const QStyleOptionViewItem& option, const QModelIndex& /*index*/) const {
    return {160, 2 * option.fontMetrics.height() + kLineGap + 2 * kPadding};
}

void ActuatorItem::paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const {
    const Palette& colors = currentPalette();
    const bool chosen = option.state & QStyle::State_Selected;
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    if (chosen || option.state & QStyle::State_MouseOver) {
        painter->setPen(Qt::NoPen);
        painter->setBrush(chosen ? selectedColor(colors) : colors.hovered);
        painter->drawRoundedRect(QRectF(option.rect).adjusted(1, 1, -1, -1), 4, 4);
    }
    const QString named = index.data(kActuatorIcon).toString();
    const QRect inside = option.rect.adjusted(kPadding, kPadding, -kPadding, -kPadding);
    paintIcon(*painter, QRectF(inside.left(), inside.center().y() - kIcon / 2 + 1, kIcon, kIcon),
              named.isEmpty() ? QString("actuator") : named, chosen ? colors.accentText : colors.textMuted);
    const QRect words = inside.adjusted(kIcon + kPadding, 0, 0, 0);
    const QFontMetrics metrics(option.font);
    const QRect first(words.topLeft(), QSize(words.width(), metrics.height()));
    const auto write = [&](const QRect& line, const QColor& color, int role) {
        painter->setPen(color);
        painter->drawText(line, Qt::AlignLeft | Qt::AlignVCenter,
                          metrics.elidedText(index.data(role).toString(), Qt::ElideRight, line.width()));
    };
    painter->setFont(option.font);
    write(first, colors.text, Qt::DisplayRole);
    write(first.translated(0, metrics.height() + kLineGap), colors.textMuted, kActuatorDetail);
    painter->restore();
}

} // namespace lumorph::studio
