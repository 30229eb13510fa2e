#include "app/workspaces/calibrate/point_bars.h"

#include <algorithm>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kRow = 20, kLegend = 24, kName = 150, kValue = 64;
constexpr std::size_t kMostRows = 40;

} // namespace

PointBars::PointBars(QWidget* parent) : QWidget(parent) {
    setObjectName("chain.points");
    setAccessibleName("How far points lie beside");
}

void PointBars::show(std::vector<LinkPoint> points) {
    points_ = std::move(points);
    std::ranges::stable_sort(points_, [](const LinkPoint& a, const LinkPoint& b) { return a.isFresh > b.isFresh; });
    if (points_.size() > kMostRows) points_.resize(kMostRows);
    QStringList words;
    for (const LinkPoint& point : points_)
        words << QString("%1: %2 mm%3")
                     .arg(point.name)
                     .arg(point.millimetres, 0, 'f', 2)
                     .arg(point.isFresh ? ", check point" : "");
    setAccessibleDescription(words.join("; "));
    updateGeometry();
    update();
}

QSize PointBars::sizeHint() const {
    return {260, points_.empty() ? 0 : kLegend + kRow * static_cast<int>(points_.size())};
}

void PointBars::paintEvent(QPaintEvent* /*event*/) {
    if (points_.empty()) return;
    const Palette& colors = currentPalette();
    QPainter painter(this);
    double most = 0.1;
    for (const LinkPoint& point : points_) most = std::max(most, point.millimetres);
    const auto square = [&](int x, const QColor& color, const QString& text) {
        painter.fillRect(QRect(x, 5, 10, 10), color);
        painter.setPen(colors.textMuted);
        painter.drawText(QRect(x + 16, 0, width(), 20), Qt::AlignVCenter, text);
    };
    square(0, colors.accent, "never seen by the fit");
    const bool any = std::ranges::any_of(points_, [](const LinkPoint& point) { return !point.isFresh; });
    if (any) square(160, colors.levelLow, "of the fit");
    const double room = width() - kName - kValue;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const LinkPoint& point = points_[k];
        const double top = kLegend + kRow * static_cast<double>(k);
        painter.setPen(colors.text);
        painter.drawText(QRectF(0, top, kName - 8, kRow), Qt::AlignVCenter | Qt::AlignLeft,
                         painter.fontMetrics().elidedText(point.name, Qt::ElideMiddle, kName - 8));
        painter.fillRect(QRectF(kName, top + 5, std::max(1.0, room * point.millimetres / most), kRow - 10),
                         point.isFresh ? colors.accent : colors.levelLow);
        painter.setPen(colors.textMuted);
        painter.drawText(QRectF(width() - kValue, top, kValue, kRow), Qt::AlignVCenter | Qt::AlignRight,
                         QString("%1 mm").arg(point.millimetres, 0, 'f', 2));
    }
}

} // namespace lumorph::studio
