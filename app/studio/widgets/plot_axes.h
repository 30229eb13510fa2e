#pragma once

#include <vector>

#include <QFontMetricsF>
#include <QPainter>

#include "app/studio/widgets/plot.h"

namespace lumorph::studio {

/// Where a plot's values lie in its widget, and where its ticks are.
struct PlotAxes {
    QRectF area; ///< of the curves, widget pixels
    int steps = 0;
    double low = 0.0, high = 1.0;
    double tick = 0.1; ///< between two lines of y
    int stepTick = 1;  ///< between two labels of x
    int decimals = 1;  ///< of the labels of y

    [[nodiscard]] QPointF pointOf(double x, double y) const;
    /// The step nearest to a pixel; -1 outside the area.
    [[nodiscard]] int stepAt(const QPointF& pixel) const;
};

/// 1, 2 or 5 times a power of ten: at most `most` of them in the span.
[[nodiscard]] double niceTick(double span, int most);
/// Where the names of the curves stand, after the label of y, in as many rows as they need.
[[nodiscard]] std::vector<QRectF> legendBoxes(const QString& y, const std::vector<Plot::Curve>& curves,
                                              const QRectF& box, const QFontMetricsF& metrics);
/// Axes of `steps` steps and values from `low` to `high`; widened to whole ticks unless `exact`. `top` is how much of
/// the box the labels above take.
[[nodiscard]] PlotAxes makeAxes(int steps, double low, double high, bool exact, const QRectF& box, double top,
                                const QFontMetricsF& metrics);
[[nodiscard]] QFont plotFont(const QFont& font);

void drawAxes(QPainter& painter, const PlotAxes& axes, const QString& x, const QString& y);
void drawUpright(QPainter& painter, const PlotAxes& axes, double x, const QPen& pen);
void drawLegend(QPainter& painter, const std::vector<QRectF>& boxes, const std::vector<Plot::Curve>& curves);
void drawReadout(QPainter& painter, const PlotAxes& axes, const QString& x, int hover,
                 const std::vector<Plot::Curve>& curves);

} // namespace lumorph::studio
