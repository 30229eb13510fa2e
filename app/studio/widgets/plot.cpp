#include "app/studio/widgets/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/plot_axes.h"

namespace lumorph::studio {
namespace {

/// Whether a curve may go straight from one point to another past the one between; nobody sees a fifth of a pixel.
bool straightPast(const QPointF& from, const QPointF& between, const QPointF& to) {
    const QPointF way = to - from, aside = between - from;
    const double length = std::hypot(way.x(), way.y());
    constexpr double kLongest = 12.0; // so that small errors do not add up along a gentle bend
    return length < kLongest && std::abs(way.x() * aside.y() - way.y() * aside.x()) < 0.2 * length;
}

/// One run of a curve without gaps. Qt draws single lines with square ends many times faster than one long path.
void drawRun(QPainter& painter, const QPolygonF& run, bool dashed) {
    if (run.size() == 1) painter.drawPoint(run.front());
    if (run.size() < 2) return;
    if (dashed) {
        painter.drawPolyline(run);
        return;
    }
    QList<QLineF> lines;
    lines.reserve(run.size());
    QPointF from = run.front();
    for (qsizetype i = 1; i < run.size(); ++i) {
        if (i + 1 < run.size() && straightPast(from, run[i], run[i + 1])) continue;
        lines.emplace_back(from, run[i]);
        from = run[i];
    }
    painter.drawLines(lines);
}

/// Runs of values, broken at NaN.
void drawCurve(QPainter& painter, const Plot::Curve& curve, const PlotAxes& axes) {
    painter.setPen(QPen(curve.color, 1.8, curve.dashed ? Qt::DashLine : Qt::SolidLine, Qt::SquareCap, Qt::BevelJoin));
    QPolygonF run;
    for (std::size_t x = 0; x <= curve.values.size(); ++x) {
        if (x < curve.values.size() && std::isfinite(curve.values[x])) {
            run << axes.pointOf(static_cast<double>(x), curve.values[x]);
            continue;
        }
        drawRun(painter, run, curve.dashed);
        run.clear();
    }
}

std::size_t stepsOf(const std::vector<Plot::Curve>& curves) {
    std::size_t steps = 0;
    for (const auto& curve : curves) steps = std::max(steps, curve.values.size());
    return steps;
}

PlotAxes axesOf(const std::vector<Plot::Curve>& curves, const QString& y, double low, double high, const QRectF& box,
                const QFontMetricsF& metrics) {
    const bool given = low != high;
    if (!given) {
        low = std::numeric_limits<double>::infinity();
        high = -low;
        for (const auto& curve : curves)
            for (const double value : curve.values)
                if (std::isfinite(value)) {
                    low = std::min(low, value);
                    high = std::max(high, value);
                }
    }
    const auto names = legendBoxes(y, curves, box, metrics);
    const double top = (names.empty() ? metrics.height() : names.back().bottom() - box.top()) + 4;
    return makeAxes(static_cast<int>(stepsOf(curves)) - 1, low, high, given, box, top, metrics);
}

/// What a screen reader says of a step: "level 5: Flap 1 0.25, Flap 2 0.5".
QString readoutOf(const std::vector<Plot::Curve>& curves, const QString& x, int step) {
    QStringList values;
    for (const auto& curve : curves) {
        const auto at = static_cast<std::size_t>(step);
        if (at < curve.values.size() && std::isfinite(curve.values[at]))
            values << curve.name + ' ' + QString::number(curve.values[at], 'g', 3);
    }
    return x + ' ' + QString::number(step) + ": " + (values.isEmpty() ? QString("no value") : values.join(", "));
}

} // namespace

Plot::Plot(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
}

void Plot::setAxes(const QString& x, const QString& y) {
    x_ = x;
    y_ = y;
    update();
}

void Plot::setCurves(std::vector<Curve> curves) {
    curves_ = std::move(curves);
    if (hover_ >= static_cast<int>(stepsOf(curves_))) hover_ = -1;
    update();
}

void Plot::setMark(double x) {
    if (x == mark_) return;
    mark_ = x;
    update();
}

void Plot::setRange(double low, double high) {
    low_ = low;
    high_ = high;
    update();
}

void Plot::setEmptyText(const QString& text) {
    empty_ = text;
    update();
}

QSize Plot::sizeHint() const { return {280, 180}; }

QSize Plot::minimumSizeHint() const { return {160, 128}; }

QPointF Plot::pointOf(double x, double y) const {
    return axesOf(curves_, y_, low_, high_, rect(), QFontMetricsF(plotFont(font()))).pointOf(x, y);
}

void Plot::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(plotFont(font()));
    painter.setPen(QPen(colors.line, 1));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    if (stepsOf(curves_) < 2) {
        painter.setPen(colors.textMuted);
        painter.drawText(rect().adjusted(16, 8, -16, -8), Qt::AlignCenter | Qt::TextWordWrap, empty_);
        return;
    }
    const PlotAxes axes = axesOf(curves_, y_, low_, high_, rect(), QFontMetricsF(painter.font()));
    drawAxes(painter, axes, x_, y_);
    if (mark_ >= 0.0 && mark_ <= axes.steps) drawUpright(painter, axes, mark_, QPen(colors.accent, 1.5));
    painter.setClipRect(axes.area.adjusted(-2, -2, 2, 2));
    for (const auto& curve : curves_) drawCurve(painter, curve, axes);
    painter.setClipping(false);
    drawLegend(painter, legendBoxes(y_, curves_, rect(), QFontMetricsF(painter.font())), curves_);
    if (hover_ >= 0) drawReadout(painter, axes, x_, hover_, curves_);
}

void Plot::mouseMoveEvent(QMouseEvent* event) {
    const PlotAxes axes = axesOf(curves_, y_, low_, high_, rect(), QFontMetricsF(plotFont(font())));
    const int now = stepsOf(curves_) < 2 ? -1 : axes.stepAt(event->position());
    read(now);
    if (now >= 0 && event->buttons().testFlag(Qt::LeftButton)) emit clicked(now);
}

void Plot::mousePressEvent(QMouseEvent* event) { mouseMoveEvent(event); }

void Plot::read(int step) {
    if (step == hover_) return;
    hover_ = step;
    setAccessibleDescription(step < 0 ? QString() : readoutOf(curves_, x_, step));
    update();
}

void Plot::leaveEvent(QEvent* /*event*/) { read(-1); }

void Plot::focusOutEvent(QFocusEvent* event) {
    read(-1);
    QWidget::focusOutEvent(event);
}

void Plot::keyPressEvent(QKeyEvent* event) {
    const int last = static_cast<int>(stepsOf(curves_)) - 1;
    if (last < 1) return QWidget::keyPressEvent(event);
    const int start = std::clamp(static_cast<int>(std::lround(mark_)), 0, last); // where reading begins
    switch (event->key()) {
    case Qt::Key_Left:
        return read(hover_ < 0 ? start : std::max(0, hover_ - 1));
    case Qt::Key_Right:
        return read(hover_ < 0 ? start : std::min(last, hover_ + 1));
    case Qt::Key_Home:
        return read(0);
    case Qt::Key_End:
        return read(last);
    case Qt::Key_Return:
    case Qt::Key_Enter:
        if (hover_ >= 0) emit clicked(hover_);
        return;
    default:
        QWidget::keyPressEvent(event);
    }
}

} // namespace lumorph::studio
