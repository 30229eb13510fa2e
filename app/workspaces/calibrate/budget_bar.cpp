#include "app/workspaces/calibrate/budget_bar.h"

#include <utility>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kBarHeight = 44, kBarGap = 16, kSliceRow = 28, kSwatch = 16, kSliceName = 210, kSliceNumber = 90,
              kSliceShare = 60;

/// As far apart as they can be, and none of them the accent, which is for the next step.
QColor sliceColor(std::size_t slice, std::size_t count) {
    const bool isDark = currentPalette().panel.lightnessF() < 0.5F;
    const float hue = static_cast<float>(slice) / static_cast<float>(count);
    return QColor::fromHslF(hue, 0.45F, isDark ? 0.62F : 0.48F);
}

void fillSlice(QPainter& painter, const QRectF& place, const QColor& color, bool isMeasured) {
    if (isMeasured) return painter.fillRect(place, color);
    painter.fillRect(place, blend(currentPalette().panel, color, 0.35));
    painter.fillRect(place, QBrush(color, Qt::BDiagPattern));
}

} // namespace

BudgetBar::BudgetBar(QWidget* parent) : QWidget(parent) {
    setObjectName("budget.bar");
    setAccessibleName(tr("Where the millimetres come from"));
}

void BudgetBar::show(std::vector<BudgetSlice> slices) {
    slices_ = std::move(slices);
    QStringList words;
    for (const BudgetSlice& slice : slices_)
        words << QString("%1: %2 mm, %3").arg(slice.name).arg(slice.millimetres, 0, 'f', 2).arg(slice.words);
    setAccessibleDescription(words.join("; "));
    updateGeometry();
    update();
}

QSize BudgetBar::sizeHint() const {
    return {460, slices_.empty() ? 0 : kBarHeight + kBarGap + kSliceRow * static_cast<int>(slices_.size())};
}

void BudgetBar::paintEvent(QPaintEvent* /*event*/) {
    if (slices_.empty()) return;
    const Palette& colors = currentPalette();
    QPainter painter(this);
    double left = 0.0;
    for (std::size_t k = 0; k < slices_.size(); ++k) {
        const double wide = width() * slices_[k].share;
        const QColor color = sliceColor(k, slices_.size());
        fillSlice(painter, QRectF(left, 0, wide, kBarHeight), color, slices_[k].isMeasured);
        if (left > 0.0) painter.fillRect(QRectF(left, 0, 1, kBarHeight), colors.panel);
        left += wide;
    }
    for (std::size_t k = 0; k < slices_.size(); ++k) {
        const BudgetSlice& slice = slices_[k];
        const double top = kBarHeight + kBarGap + kSliceRow * static_cast<double>(k);
        fillSlice(painter, QRectF(0, top + 0.5 * (kSliceRow - kSwatch), kSwatch, kSwatch),
                  sliceColor(k, slices_.size()), slice.isMeasured);
        double x = kSwatch + 8;
        const auto text = [&](const QString& shown, double wide, const QColor& color, Qt::Alignment side) {
            painter.setPen(color);
            painter.drawText(QRectF(x, top, wide, kSliceRow), Qt::AlignVCenter | side,
                             painter.fontMetrics().elidedText(shown, Qt::ElideRight, static_cast<int>(wide)));
            x += wide;
        };
        text(slice.name, kSliceName, colors.text, Qt::AlignLeft);
        text(QString("%1 mm").arg(slice.millimetres, 0, 'f', 2), kSliceNumber, colors.text, Qt::AlignRight);
        text(QString("%1 %").arg(100.0 * slice.share, 0, 'f', 0), kSliceShare, colors.textMuted, Qt::AlignRight);
        x += 16;
        text(slice.words, width() - x, colors.textMuted, Qt::AlignLeft);
    }
}

} // namespace lumorph::studio
