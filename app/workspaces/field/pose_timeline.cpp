#include "app/workspaces/field/pose_timeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QApplication>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/plot_axes.h"

namespace lumorph::studio {

namespace {

constexpr double kSide = 1.0;       ///< left and right of all steps
constexpr double kLeastStep = 14.0; ///< a step is at least so wide, that it can be taken hold of
constexpr double kReadable = 64.0;  ///< and steps are drawn so large that the shortest of them can be read
constexpr double kMostPerSecond = 160.0;
constexpr int kBlockHeight = 64, kScaleHeight = 20;
constexpr double kGap = 2.0;
constexpr double kRound = 4.0;

double secondsOf(const PoseStep& step) { return step.travelSeconds + step.holdSeconds; }

/// A round number of seconds between two marks that are at least `least` apart.
double markSeconds(double least) {
    for (const double unit : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0, 3600.0})
        if (unit >= least) return unit;
    return 36000.0;
}

QString easingWord(Easing easing) {
    return easing == Easing::linear ? "even" : easing == Easing::smooth ? "smooth" : "natural";
}

QString textOf(int number, const PoseStep& set, const PoseStep& planned) {
    QString text = QString("Step %1: %2 s to %3 (%4), %5 s there")
                       .arg(number)
                       .arg(planned.travelSeconds, 0, 'f', 2)
                       .arg(QString::fromStdString(set.pose), easingWord(set.easing))
                       .arg(planned.holdSeconds, 0, 'f', 2);
    if (planned.travelSeconds > set.travelSeconds)
        text += QString("; set to %1 s, which the servos cannot keep").arg(set.travelSeconds, 0, 'f', 2);
    return text;
}

} // namespace

PoseTimeline::PoseTimeline(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    setFixedHeight(kBlockHeight + kScaleHeight);
    setAccessibleName("Steps of the sequence");
    setAccessibleDescription("Arrow keys choose a step, Alt with them moves it, Delete removes it");
}

void PoseTimeline::setSequence(const PoseSequence& set, const PoseSequence& planned) {
    if (set == set_ && planned == planned_) return;
    set_ = set;
    planned_ = planned;
    if (pressed_ >= count()) {
        pressed_ = -1;
        dragging_ = false;
    }
    layOut();
}

void PoseTimeline::setRoom(int width) {
    if (std::exchange(room_, width) != width) layOut();
}

void PoseTimeline::setChosen(int step) {
    if (std::exchange(chosen_, step) == step) return;
    const auto k = static_cast<std::size_t>(chosen_);
    if (chosen_ >= 0 && chosen_ < count())
        setAccessibleDescription(textOf(chosen_ + 1, set_.steps[k], planned_.steps[k]));
    update();
}

void PoseTimeline::setPlayhead(std::optional<double> seconds) {
    if (std::exchange(playhead_, seconds) != seconds) update();
}

void PoseTimeline::layOut() {
    double total = 0.0, shortest = kMaxStepSeconds;
    for (const PoseStep& step : planned_.steps) {
        total += secondsOf(step);
        if (secondsOf(step) > 0.0) shortest = std::min(shortest, secondsOf(step));
    }
    const double room = room_ - 2.0 * kSide;
    // Filled, but no wider than reads well; wider than there is room where steps would be too narrow to read.
    double scale = total > 0.0 ? room / total : 0.0;
    scale = std::max(scale, std::min(kReadable / shortest, 8.0 * scale));
    scale = std::min(scale, kMostPerSecond);
    edges_.assign(1, kSide);
    for (const PoseStep& step : planned_.steps)
        edges_.push_back(edges_.back() + std::max(kLeastStep, scale * secondsOf(step)));
    setFixedWidth(std::max(room_, static_cast<int>(std::ceil(edges_.back() + kSide))));
    update();
}

QSize PoseTimeline::sizeHint() const { return {room_, kBlockHeight + kScaleHeight}; }

QRect PoseTimeline::boxOf(int step) const {
    const auto at = static_cast<std::size_t>(step);
    if (step < 0 || at + 1 >= edges_.size()) return {};
    return QRectF(edges_[at], 0.0, edges_[at + 1] - edges_[at], kBlockHeight).toRect();
}

int PoseTimeline::stepAt(double x) const {
    for (int step = 0; step < count(); ++step)
        if (x >= edges_[static_cast<std::size_t>(step)] && x < edges_[static_cast<std::size_t>(step) + 1]) return step;
    return -1;
}

double PoseTimeline::xOf(double seconds) const {
    for (std::size_t k = 0; k < planned_.steps.size(); ++k) {
        const double length = secondsOf(planned_.steps[k]);
        if (seconds < length) return edges_[k] + (edges_[k + 1] - edges_[k]) * seconds / length;
        seconds -= length;
    }
    return edges_.empty() ? kSide : edges_.back();
}

double PoseTimeline::playheadX() const { return playhead_ ? xOf(*playhead_) : -1.0; }

int PoseTimeline::dropPlace() const {
    int place = 0;
    for (int step = 0; step < count(); ++step) {
        const auto k = static_cast<std::size_t>(step);
        if (step != pressed_ && dragX_ > 0.5 * (edges_[k] + edges_[k + 1])) ++place;
    }
    return place;
}

void PoseTimeline::paintStep(QPainter& painter, int step) const {
    const Palette& colors = currentPalette();
    const auto k = static_cast<std::size_t>(step);
    const PoseStep& set = set_.steps[k];
    const PoseStep& planned = planned_.steps[k];
    const QRectF box(edges_[k] + 0.5, 0.5, edges_[k + 1] - edges_[k] - kGap, kBlockHeight - 1.0);
    const bool isChosen = step == chosen_;
    QPainterPath outline;
    outline.addRoundedRect(box, kRound, kRound);
    painter.fillPath(outline, isChosen ? selectedColor(colors) : colors.raised);
    painter.save();
    painter.setClipPath(outline);
    const double total = secondsOf(planned);
    const double travel = total > 0.0 ? box.width() * planned.travelSeconds / total : 0.0;
    QPainterPath way(QPointF(box.left(), box.bottom()));
    constexpr int kPieces = 24;
    const double rise = box.height() - 24.0; // the name stands above it
    for (int i = 0; i <= kPieces; ++i)
        way.lineTo(box.left() + travel * i / kPieces,
                   box.bottom() - rise * eased(set.easing, static_cast<double>(i) / kPieces));
    way.lineTo(box.right(), box.bottom() - rise);
    way.lineTo(box.right(), box.bottom());
    way.closeSubpath();
    painter.fillPath(way, blend(isChosen ? selectedColor(colors) : colors.raised, colors.accent, 0.30));
    if (planned.travelSeconds > set.travelSeconds) {
        const double from = travel * set.travelSeconds / planned.travelSeconds;
        QColor hatch = colors.warning;
        hatch.setAlphaF(0.55);
        painter.fillRect(QRectF(box.left() + from, box.top(), travel - from, box.height()),
                         QBrush(hatch, Qt::BDiagPattern));
    }
    painter.setPen(QPen(colors.line, 1.0));
    if (travel > 0.0 && travel < box.width() - 1.0)
        painter.drawLine(QPointF(box.left() + travel, box.top()), QPointF(box.left() + travel, box.bottom()));
    painter.setPen(colors.text);
    const QRectF words = box.adjusted(8.0, 4.0, -4.0, 0.0);
    painter.drawText(words, Qt::AlignTop | Qt::AlignLeft,
                     painter.fontMetrics().elidedText(QString::fromStdString(set.pose), Qt::ElideRight,
                                                      static_cast<int>(std::max(0.0, words.width()))));
    painter.restore();
    const bool focused = isChosen && hasFocus();
    painter.setPen(QPen(isChosen ? colors.accent : colors.border, focused ? 2.0 : 1.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(outline);
}

void PoseTimeline::paintScale(QPainter& painter) const {
    const Palette& colors = currentPalette();
    const double total = durationOf(planned_);
    if (!(total > 0.0)) return;
    const double perSecond = (edges_.back() - edges_.front()) / total;
    const double unit = markSeconds(56.0 / perSecond);
    painter.setPen(colors.textMuted);
    painter.setFont(plotFont(font()));
    for (int mark = 0; mark * unit <= total + 1e-9; ++mark) {
        const double x = xOf(mark * unit);
        painter.drawLine(QPointF(x + 0.5, kBlockHeight + 1.0), QPointF(x + 0.5, kBlockHeight + 5.0));
        const QString text = QString::number(mark * unit, 'g', 5) + " s";
        const double width = painter.fontMetrics().horizontalAdvance(text);
        const double left = std::clamp(x - 0.5 * width, 0.0, std::max(0.0, this->width() - width));
        painter.drawText(QPointF(left, height() - 4.0), text);
    }
}

void PoseTimeline::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    for (int step = 0; step < count(); ++step) paintStep(painter, step);
    paintScale(painter);
    if (dragging_) {
        const int place = dropPlace();
        const auto edge = static_cast<std::size_t>(place > pressed_ ? place + 1 : place);
        painter.setPen(QPen(colors.accent, 3.0));
        const double x = std::clamp(edges_[edge] - 0.5 * kGap, 1.5, width() - 1.5);
        painter.drawLine(QPointF(x, 0.0), QPointF(x, kBlockHeight));
    }
    if (!playhead_) return;
    const double x = playheadX();
    painter.setPen(QPen(colors.accentText, 2.0));
    painter.drawLine(QPointF(x, 0.0), QPointF(x, kBlockHeight + 4.0));
    painter.setBrush(colors.accentText);
    painter.setPen(Qt::NoPen);
    painter.drawPolygon(QPolygonF({QPointF(x - 5.0, 0.0), QPointF(x + 5.0, 0.0), QPointF(x, 7.0)}));
}

void PoseTimeline::choose(int step) {
    if (step < 0 || step >= count()) return;
    emit chosen(step);
}

void PoseTimeline::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    pressed_ = stepAt(event->position().x());
    pressX_ = dragX_ = event->position().x();
    choose(pressed_);
}

void PoseTimeline::mouseMoveEvent(QMouseEvent* event) {
    if (pressed_ < 0) return;
    dragX_ = event->position().x();
    if (std::abs(dragX_ - pressX_) >= QApplication::startDragDistance()) dragging_ = true;
    if (dragging_) update();
}

void PoseTimeline::mouseReleaseEvent(QMouseEvent* /*event*/) {
    const int to = pressed_ >= 0 ? dropPlace() : -1;
    const int from = std::exchange(pressed_, -1);
    const bool dropped = std::exchange(dragging_, false);
    update();
    if (dropped && to != from) emit moved(from, to);
}

void PoseTimeline::keyPressEvent(QKeyEvent* event) {
    const bool moves = event->modifiers() & Qt::AltModifier;
    const int by = event->key() == Qt::Key_Left ? -1 : event->key() == Qt::Key_Right ? 1 : 0;
    if (event->key() == Qt::Key_Escape && dragging_) {
        dragging_ = false;
        pressed_ = -1;
        return update();
    }
    if (event->key() == Qt::Key_Delete && chosen_ >= 0) return emit removed();
    if (by == 0) return QWidget::keyPressEvent(event);
    if (!moves) return choose(std::clamp(chosen_ + by, 0, std::max(0, count() - 1)));
    if (chosen_ + by >= 0 && chosen_ + by < count()) emit moved(chosen_, chosen_ + by);
}

bool PoseTimeline::event(QEvent* event) {
    if (event->type() == QEvent::ToolTip) {
        const auto* help = static_cast<QHelpEvent*>(event);
        const int step = stepAt(help->pos().x());
        if (step < 0) {
            QToolTip::hideText();
        } else {
            const auto k = static_cast<std::size_t>(step);
            QToolTip::showText(help->globalPos(), textOf(step + 1, set_.steps[k], planned_.steps[k]), this);
        }
        return true;
    }
    return QWidget::event(event);
}

} // namespace lumorph::studio
