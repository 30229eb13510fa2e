#include "app/studio/widgets/icon_label.h"

#include <QPainter>

namespace lumorph::studio {

IconLabel::IconLabel(const QString& name, IconRole role, int side, QWidget* parent)
    : QWidget(parent), icon_(icon(name, role)) {
    setFixedSize(side, side);
    setAttribute(Qt::WA_TransparentForMouseEvents);
}

void IconLabel::setIcon(const QString& name, IconRole role) {
    icon_ = icon(name, role);
    update();
}

void IconLabel::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    icon_.paint(&painter, rect(), Qt::AlignCenter, isEnabled() ? QIcon::Normal : QIcon::Disabled);
}

} // namespace lumorph::studio
