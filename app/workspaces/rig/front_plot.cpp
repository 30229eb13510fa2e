#include "app/workspaces/rig/front_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/plot_axes.h"

namespace lumorph::studio {

namespace {

constexpr double kDot = 4.0;    ///< radius, pixels
constexpr double kReach = 14.0; ///< how near to a dot the pointer has to be
constexpr double kCross = 5.0;

QPointF pixelOf(const PlotAxes& axes, const FrontPlot::Dot& dot) { return axes.pointOf(dot.cost, 100.0 * dot.fit); }

} // namespace

FrontPlot::FrontPlot(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::MinimumExpanding);
}

void FrontPlot::setCost(const QString& name, double most) {
    cost_ = name;
    most_ = most;
    update();
}

void FrontPlot::setDots(std::vector<Dot> dots) {
    if (dots == dots_) return;
    dots_ = std::move(dots);
    if (hover_ >= static_cast<int>(dots_.size())) hover_ = -1;
    update();
}

void FrontPlot::setOpenDevice(std::optional<Dot> dot) {
    if (std::exchange(open_, dot) != dot) update();
}

void FrontPlot::setChosen(std::optional<Dot> dot) {
    if (std::exchange(chosen_, dot) != dot) update();
}

void FrontPlot::setEmptyText(const QString& text) {
    empty_ = text;
    update();
}

PlotAxes FrontPlot::axes() const {
    double most = most_;
    double best = 0.1;
    const auto hold = [&](const Dot& dot) {
        most = std::max(most, std::ceil(dot.cost));
        best = std::max(best, dot.fit);
    };
    for (const Dot& dot : dots_) hold(dot);
    if (open_) hold(*open_);
    const QFontMetricsF metrics(plotFont(font()));
    return makeAxes(static_cast<int>(most), 0.0, 100.0 * best, false, rect(), metrics.height() + 4, metrics);
}

QPointF FrontPlot::placeOf(const Dot& dot) const { return pixelOf(axes(), dot); }

void FrontPlot::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(plotFont(font()));
    painter.setPen(QPen(hasFocus() ? colors.border : colors.line, 1));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    if (dots_.empty()) {
        painter.setPen(colors.textMuted);
        painter.drawText(rect().adjusted(16, 8, -16, -8), Qt::AlignCenter | Qt::TextWordWrap, empty_);
        return;
    }
    const PlotAxes axes = this->axes();
    drawAxes(painter, axes, cost_, tr("fit, %"));
    if (open_) drawOpenDevice(painter, axes);
    drawDots(painter, axes);
}

void FrontPlot::drawDots(QPainter& painter, const PlotAxes& axes) const {
    const Palette& colors = currentPalette();
    QPolygonF steps{axes.pointOf(dots_.front().cost, axes.low)};
    for (const Dot& dot : dots_) steps << QPointF(pixelOf(axes, dot).x(), steps.back().y()) << pixelOf(axes, dot);
    steps << QPointF(axes.area.right(), steps.back().y());
    painter.setPen(QPen(blend(colors.sunken, colors.accent, 0.5), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawPolyline(steps);
    painter.setPen(QPen(colors.sunken, 1.5));
    painter.setBrush(colors.accentText);
    for (const Dot& dot : dots_) painter.drawEllipse(pixelOf(axes, dot), kDot, kDot);
    painter.setBrush(Qt::NoBrush);
    if (chosen_) {
        painter.setPen(QPen(colors.text, 2));
        painter.drawEllipse(pixelOf(axes, *chosen_), kDot + 3.0, kDot + 3.0);
    }
    if (hover_ >= 0) {
        painter.setPen(QPen(colors.accentText, 1.5));
        painter.drawEllipse(pixelOf(axes, dots_[static_cast<std::size_t>(hover_)]), kDot + 3.0, kDot + 3.0);
    }
}

/// With a legend of its own, at the right of the label of y.
void FrontPlot::drawOpenDevice(QPainter& painter, const PlotAxes& axes) const {
    const QFontMetricsF metrics(painter.font());
    const QString name = tr("open now");
    const double width = metrics.horizontalAdvance(name);
    const QRectF text(axes.area.right() - width, rect().top() + 4, width + 2, metrics.height());
    const auto cross = [&](const QPointF& at, double size) {
        painter.drawLine(at - QPointF(size, size), at + QPointF(size, size));
        painter.drawLine(at - QPointF(size, -size), at + QPointF(size, -size));
    };
    painter.setPen(QPen(currentPalette().text, 1.8));
    cross(pixelOf(axes, *open_), kCross);
    cross({text.left() - 10, text.center().y()}, 3.5);
    painter.setPen(currentPalette().textMuted);
    painter.drawText(text, Qt::AlignLeft | Qt::AlignVCenter, name);
}

int FrontPlot::dotAt(const QPointF& pixel) const {
    const PlotAxes axes = this->axes();
    int nearest = -1;
    double least = kReach;
    for (std::size_t k = 0; k < dots_.size(); ++k) {
        const QPointF way = pixelOf(axes, dots_[k]) - pixel;
        const double distance = std::hypot(way.x(), way.y());
        if (distance >= least) continue;
        least = distance;
        nearest = static_cast<int>(k);
    }
    return nearest;
}

int FrontPlot::chosenDot() const {
    const auto found = chosen_ ? std::ranges::find(dots_, *chosen_) : dots_.end();
    return found == dots_.end() ? -1 : static_cast<int>(found - dots_.begin());
}

void FrontPlot::hover(int dot) {
    if (dot == hover_) return;
    hover_ = dot;
    setCursor(dot < 0 ? Qt::ArrowCursor : Qt::PointingHandCursor);
    update();
    emit hovered(dot);
}

void FrontPlot::mouseMoveEvent(QMouseEvent* event) { hover(dotAt(event->position())); }

void FrontPlot::mousePressEvent(QMouseEvent* event) {
    const int dot = dotAt(event->position());
    if (dot >= 0 && event->button() == Qt::LeftButton) emit clicked(dot);
}

void FrontPlot::mouseDoubleClickEvent(QMouseEvent* event) {
    const int dot = dotAt(event->position());
    if (dot >= 0 && event->button() == Qt::LeftButton) emit taken(dot);
}

void FrontPlot::leaveEvent(QEvent* /*event*/) { hover(-1); }

void FrontPlot::keyPressEvent(QKeyEvent* event) {
    const int last = static_cast<int>(dots_.size()) - 1;
    const int now = chosenDot();
    if (last < 0) return QWidget::keyPressEvent(event);
    switch (event->key()) {
    case Qt::Key_Left:
        return emit clicked(now < 0 ? last : std::max(0, now - 1));
    case Qt::Key_Right:
        return emit clicked(now < 0 ? 0 : std::min(last, now + 1));
    case Qt::Key_Home:
        return emit clicked(0);
    case Qt::Key_End:
        return emit clicked(last);
    case Qt::Key_Return:
    case Qt::Key_Enter:
        if (now >= 0) emit taken(now);
        return;
    default:
        QWidget::keyPressEvent(event);
    }
}

} // namespace lumorph::studio
