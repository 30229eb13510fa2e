#include "app/workspaces/calibrate/budget_bar.h"

#include <utility>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kBarHeight = 44, kBarGap = 12, kSliceRow = 28, kWordsRow = 18, kSwatch = 16, kSliceName = 200,
              kSliceNumber = 70, kSliceShare = 48, kWordsGap = 24;
constexpr int kOneLine = 620; ///< pixels; in less the words go under the name

/// As far apart as they can be, and none of them the accent, which is for the next step.
QColor sliceColor(std::size_t slice, std::size_t count) {
    const bool isDark = currentPalette().panel.lightnessF() < 0.5F;
    const float hue = static_cast<float>(slice) / static_cast<float>(count);
    return QColor::fromHslF(hue, 0.45F, isDark ? 0.62F : 0.48F);
}

/// Hatched as wide on every screen, where Qt's patterns are of the screen's own pixels.
void fillSlice(QPainter& painter, const QRectF& place, const QColor& color, bool isMeasured) {
    if (isMeasured) return painter.fillRect(place, color);
    painter.fillRect(place, blend(currentPalette().panel, color, 0.25));
    painter.save();
    painter.setClipRect(place);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(color, 2.0));
    for (double x = place.left(); x < place.right() + place.height(); x += 7.0)
        painter.drawLine(QPointF(x, place.top() - 1.0), QPointF(x - place.height() - 2.0, place.bottom() + 1.0));
    painter.restore();
}

QString millimetresText(double millimetres) {
    return QString("%1 mm").arg(millimetres, 0, 'f', millimetres < 1.0 ? 2 : 1);
}

/// What is there at all is not said to be nothing.
QString percentText(double share) {
    const double percent = 100.0 * share;
    return percent > 0.0 && percent < 0.5 ? QString("< 1 %") : QString("%1 %").arg(percent, 0, 'f', 0);
}

} // namespace

BudgetBar::BudgetBar(QWidget* parent) : QWidget(parent) {
    setObjectName("budget.bar");
    setAccessibleName(tr("Where the millimetres come from"));
    QSizePolicy policy(QSizePolicy::Preferred, QSizePolicy::Minimum);
    policy.setHeightForWidth(true);
    setSizePolicy(policy);
}

void BudgetBar::show(std::vector<BudgetSlice> slices) {
    slices_ = std::move(slices);
    QStringList words;
    for (const BudgetSlice& slice : slices_)
        words << QString("%1: %2, %3").arg(slice.name, millimetresText(slice.millimetres), slice.words);
    setAccessibleDescription(words.join("; "));
    updateGeometry();
    update();
}

int BudgetBar::rowHeight(int width) const { return width < kOneLine ? kSliceRow + kWordsRow : kSliceRow; }

int BudgetBar::heightForWidth(int width) const {
    return slices_.empty() ? 0 : kBarHeight + kBarGap + rowHeight(width) * static_cast<int>(slices_.size());
}

QSize BudgetBar::sizeHint() const { return {kOneLine, heightForWidth(kOneLine)}; }

QSize BudgetBar::minimumSizeHint() const { return {240, heightForWidth(kOneLine)}; }

void BudgetBar::paintEvent(QPaintEvent* /*event*/) {
    if (slices_.empty()) return;
    QPainter painter(this);
    double left = 0.0;
    for (std::size_t k = 0; k < slices_.size(); ++k) {
        const double wide = width() * slices_[k].share;
        fillSlice(painter, QRectF(left, 0, wide, kBarHeight), sliceColor(k, slices_.size()), slices_[k].isMeasured);
        if (left > 0.0) painter.fillRect(QRectF(left, 0, 1, kBarHeight), currentPalette().panel);
        left += wide;
    }
    for (std::size_t k = 0; k < slices_.size(); ++k) paintRow(painter, k);
}

void BudgetBar::paintRow(QPainter& painter, std::size_t row) const {
    const Palette& colors = currentPalette();
    const BudgetSlice& slice = slices_[row];
    const double top = kBarHeight + kBarGap + rowHeight(width()) * static_cast<double>(row);
    fillSlice(painter, QRectF(0, top + 0.5 * (kSliceRow - kSwatch), kSwatch, kSwatch), sliceColor(row, slices_.size()),
              slice.isMeasured);
    const bool isNarrow = width() < kOneLine;
    const double names = kSwatch + 8.0;
    double x = names;
    const auto text = [&](const QString& shown, const QRectF& place, const QColor& color, Qt::Alignment side) {
        painter.setPen(color);
        painter.drawText(place, Qt::AlignVCenter | side,
                         painter.fontMetrics().elidedText(shown, Qt::ElideRight, static_cast<int>(place.width())));
        x = place.right();
    };
    const double nameWide = isNarrow ? width() - x - kSliceNumber - kSliceShare : kSliceName;
    text(slice.name, {x, top, nameWide, kSliceRow}, colors.text, Qt::AlignLeft);
    text(millimetresText(slice.millimetres), {x, top, kSliceNumber, kSliceRow}, colors.text, Qt::AlignRight);
    text(percentText(slice.share), {x, top, kSliceShare, kSliceRow}, colors.textMuted, Qt::AlignRight);
    const QRectF words = isNarrow ? QRectF(names, top + kSliceRow - 4.0, width() - names, kWordsRow)
                                  : QRectF(x + kWordsGap, top, width() - x - kWordsGap, kSliceRow);
    text(slice.words, words, colors.textMuted, Qt::AlignLeft);
}

} // namespace lumorph::studio
