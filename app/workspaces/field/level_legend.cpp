#include "app/workspaces/field/level_legend.h"

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kBar = 10;

} // namespace

LevelLegend::LevelLegend(QWidget* parent) : QWidget(parent) {
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    setToolTip(tr("The colour says at which level an actuator first fills a voxel"));
}

void LevelLegend::setLevels(int lowest, int highest) {
    lowest_ = lowest;
    highest_ = highest;
    setAccessibleName(tr("Colours: light green is level %1, darker green level %2").arg(lowest).arg(highest));
    update();
}

QSize LevelLegend::sizeHint() const { return {160, kBar + 4 + fontMetrics().height()}; }

QSize LevelLegend::minimumSizeHint() const { return {120, sizeHint().height()}; }

void LevelLegend::paintEvent(QPaintEvent*) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QLinearGradient gradient(0, 0, width(), 0);
    gradient.setColorAt(0.0, colors.levelLow);
    gradient.setColorAt(1.0, colors.levelHigh);
    painter.setPen(Qt::NoPen);
    painter.setBrush(gradient);
    painter.drawRoundedRect(QRectF(0, 0, width(), kBar), 2, 2);
    const QRect text(0, kBar + 4, width(), fontMetrics().height());
    painter.setPen(colors.textMuted);
    painter.drawText(text, Qt::AlignLeft, tr("level %1").arg(lowest_));
    painter.drawText(text, Qt::AlignHCenter, tr("first filled at"));
    painter.drawText(text, Qt::AlignRight, tr("level %1").arg(highest_));
}

} // namespace lumorph::studio
