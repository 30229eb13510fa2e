#include "app/workspaces/field/error_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <QFontInfo>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "app/studio/look/palette.h"
#include "app/workspaces/field/vote_table.h"

namespace lumorph::studio {

namespace {

constexpr int kNarrowestCell = 108;
constexpr int kCellHeight = 66;
constexpr int kCellGap = 4;
constexpr int kNameHeight = 18;

} // namespace

ErrorCurves::ErrorCurves(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    policy.setHeightForWidth(true);
    setSizePolicy(policy);
}

void ErrorCurves::setNames(const QStringList& names) {
    if (names == names_) return;
    names_ = names;
    curves_.clear();
    levels_.clear();
    tried_ = -1;
    dragging_ = false;
    current_ = -1;
    updateGeometry();
    update();
}

void ErrorCurves::setVotes(const std::vector<ActuatorVote>& votes, const std::vector<Level>& levels) {
    if (trying() || votes.size() != static_cast<std::size_t>(names_.size())) return;
    std::vector<std::vector<double>> curves;
    std::vector<int> asked;
    for (std::size_t i = 0; i < votes.size(); ++i) {
        curves.push_back(votes[i].reached ? errorCurve(votes[i]) : std::vector<double>());
        asked.push_back(i < levels.size() ? levels[i].index : votes[i].level.index);
    }
    curves_ = std::move(curves);
    levels_ = std::move(asked);
    update();
}

void ErrorCurves::setCurrent(int actuator) {
    if (actuator == current_ || trying()) return;
    current_ = actuator;
    update();
}

int ErrorCurves::columns(int width) const {
    return std::clamp(width / kNarrowestCell, 1, std::max(1, static_cast<int>(names_.size())));
}

int ErrorCurves::heightForWidth(int width) const {
    const int count = static_cast<int>(names_.size());
    return (count + columns(width) - 1) / columns(width) * kCellHeight;
}

QSize ErrorCurves::sizeHint() const { return {280, heightForWidth(280)}; }

QRect ErrorCurves::cellOf(int actuator) const {
    const int across = columns(width());
    const int side = width() / across;
    return {actuator % across * side, actuator / across * kCellHeight, side - kCellGap, kCellHeight - kCellGap};
}

QRect ErrorCurves::plotOf(int actuator) const { return cellOf(actuator).adjusted(6, kNameHeight, -6, -6); }

int ErrorCurves::stepsOf(int actuator) const {
    return actuator >= 0 && actuator < static_cast<int>(curves_.size())
               ? static_cast<int>(curves_[static_cast<std::size_t>(actuator)].size())
               : 0;
}

int ErrorCurves::xOf(int actuator, int level) const {
    const QRect plot = plotOf(actuator);
    return plot.left() + level * plot.width() / std::max(1, stepsOf(actuator) - 1);
}

int ErrorCurves::levelAt(int actuator, int x) const {
    const QRect plot = plotOf(actuator);
    const int last = stepsOf(actuator) - 1;
    return std::clamp(static_cast<int>(std::lround((x - plot.left()) * static_cast<double>(last) / plot.width())), 0,
                      std::max(0, last));
}

int ErrorCurves::cellAt(const QPoint& place) const {
    for (int i = 0; i < names_.size(); ++i)
        if (cellOf(i).contains(place)) return i;
    return -1;
}

void ErrorCurves::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QFont font = this->font();
    font.setPixelSize(std::max(8, static_cast<int>(std::lround(0.85 * QFontInfo(font).pixelSize()))));
    painter.setFont(font);
    for (int i = 0; i < names_.size(); ++i) drawCell(painter, i);
}

void ErrorCurves::drawCell(QPainter& painter, int actuator) const {
    const Palette& colors = currentPalette();
    const QRectF cell = QRectF(cellOf(actuator)).adjusted(0.5, 0.5, -0.5, -0.5);
    const bool chosen = actuator == current_;
    painter.setPen(QPen(chosen ? (hasFocus() ? colors.text : colors.accent) : colors.line, chosen ? 1.5 : 1.0));
    painter.setBrush(colors.sunken);
    painter.drawRoundedRect(cell, 4, 4);
    const int steps = stepsOf(actuator);
    const int level = chosen && trying() ? tried_
                      : static_cast<std::size_t>(actuator) < levels_.size()
                          ? levels_[static_cast<std::size_t>(actuator)]
                          : 0;
    QRect top = cellOf(actuator).adjusted(6, 2, -6, 0);
    top.setHeight(kNameHeight - 2);
    const QString number = steps > 1 ? QString::number(level) : QString();
    painter.setPen(chosen && trying() ? colors.accentText : colors.textMuted);
    painter.drawText(top, Qt::AlignRight | Qt::AlignVCenter, number);
    painter.setPen(colors.text);
    const int room = top.width() - painter.fontMetrics().horizontalAdvance(number) - 4;
    painter.drawText(top, Qt::AlignLeft | Qt::AlignVCenter,
                     painter.fontMetrics().elidedText(names_[actuator], Qt::ElideMiddle, room));
    const QRect plot = plotOf(actuator);
    if (steps < 2) {
        painter.setPen(colors.warning);
        if (static_cast<std::size_t>(actuator) < curves_.size())
            painter.drawText(plot, Qt::AlignCenter, "out of reach");
        return;
    }
    painter.setPen(QPen(colors.accent, chosen && trying() ? 2.0 : 1.2));
    painter.drawLine(xOf(actuator, level), plot.top(), xOf(actuator, level), plot.bottom());
    const std::vector<double>& curve = curves_[static_cast<std::size_t>(actuator)];
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double error : curve)
        if (std::isfinite(error)) {
            low = std::min(low, error);
            high = std::max(high, error);
        }
    QPolygonF run;
    painter.setPen(QPen(colors.text, 1.4));
    for (int step = 0; step <= steps; ++step) {
        const double error = step < steps ? curve[static_cast<std::size_t>(step)] : std::nan("");
        if (std::isfinite(error)) {
            const double share = high > low ? (error - low) / (high - low) : 0.5;
            run << QPointF(xOf(actuator, step), plot.bottom() - share * plot.height());
            continue;
        }
        if (run.size() > 1) painter.drawPolyline(run);
        if (run.size() == 1) painter.drawPoint(run.front());
        run.clear();
    }
}

bool ErrorCurves::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride && trying() &&
        static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
        event->accept();
        return true;
    }
    if (event->type() != QEvent::ToolTip) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const int actuator = cellAt(help->pos());
    if (actuator < 0) {
        QToolTip::hideText();
        return true;
    }
    const QString what =
        stepsOf(actuator) > 1
            ? QString("drag to try a level; the device goes back when you let go. Double click to keep it.")
            : QString("no level of this actuator covers enough of the target, so it stays at rest.");
    QToolTip::showText(help->globalPos(), names_[actuator] + ": " + what, this);
    return true;
}

void ErrorCurves::choose(int actuator) {
    if (actuator == current_) return;
    endTry(false);
    current_ = actuator;
    update();
    emit chosen(actuator);
}

void ErrorCurves::tryLevel(int level) {
    if (stepsOf(current_) < 2 || level == tried_) return;
    tried_ = level;
    setAccessibleDescription(QString("%1, level %2").arg(names_[current_]).arg(level));
    update();
    emit previewed(current_, level);
}

void ErrorCurves::endTry(bool keep) {
    dragging_ = false;
    if (!trying()) return;
    const int level = tried_;
    tried_ = -1;
    if (keep) levels_[static_cast<std::size_t>(current_)] = level;
    update();
    keep ? emit kept(current_, level) : emit letGo();
}

void ErrorCurves::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    const int actuator = cellAt(event->position().toPoint());
    if (actuator < 0) return;
    choose(actuator);
    dragging_ = true;
}

void ErrorCurves::mouseMoveEvent(QMouseEvent* event) {
    if (dragging_ && event->buttons().testFlag(Qt::LeftButton))
        tryLevel(levelAt(current_, event->position().toPoint().x()));
}

void ErrorCurves::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) endTry(false);
}

void ErrorCurves::mouseDoubleClickEvent(QMouseEvent* event) {
    const int actuator = cellAt(event->position().toPoint());
    if (event->button() != Qt::LeftButton || actuator < 0) return;
    choose(actuator);
    tryLevel(levelAt(actuator, event->position().toPoint().x()));
    endTry(true);
}

void ErrorCurves::keyPressEvent(QKeyEvent* event) {
    const int last = static_cast<int>(names_.size()) - 1;
    const bool tries = event->modifiers().testFlag(Qt::ShiftModifier) && current_ >= 0;
    const int from = trying()                         ? tried_
                     : tries && stepsOf(current_) > 1 ? levels_[static_cast<std::size_t>(current_)]
                                                      : 0;
    switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Right: {
        const int by = event->key() == Qt::Key_Left ? -1 : 1;
        if (tries) return tryLevel(std::clamp(from + by, 0, std::max(0, stepsOf(current_) - 1)));
        return choose(std::clamp(current_ + by, 0, last));
    }
    case Qt::Key_Up:
        return choose(std::max(current_ - columns(width()), 0));
    case Qt::Key_Down:
        return choose(std::min(current_ + columns(width()), last));
    case Qt::Key_Return:
    case Qt::Key_Enter:
        return endTry(true);
    case Qt::Key_Escape:
        if (trying()) return endTry(false);
        break;
    default:
        break;
    }
    QWidget::keyPressEvent(event);
}

void ErrorCurves::keyReleaseEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Shift && !dragging_) endTry(false);
    QWidget::keyReleaseEvent(event);
}

void ErrorCurves::focusOutEvent(QFocusEvent* event) {
    endTry(false);
    update();
    QWidget::focusOutEvent(event);
}

} // namespace lumorph::studio
