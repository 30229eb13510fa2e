#include "app/workspaces/field/actuator_grid.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

/// Strokes that are nearer than this are drawn as one.
constexpr double kArrived = 0.02;

} // namespace

ActuatorGrid::ActuatorGrid(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    policy.setHeightForWidth(true);
    setSizePolicy(policy);
}

void ActuatorGrid::setNames(QStringList names) {
    names_ = std::move(names);
    const auto count = static_cast<std::size_t>(names_.size());
    wanted_.assign(count, 0.0);
    estimated_.assign(count, 0.0);
    current_ = std::clamp(current_, 0, std::max(static_cast<int>(count) - 1, 0));
    updateGeometry();
    update();
}

void ActuatorGrid::setStrokes(const std::vector<double>& wanted, const std::vector<double>& estimated) {
    if (wanted.size() != wanted_.size() || estimated.size() != estimated_.size()) return;
    if (wanted == wanted_ && estimated == estimated_) return;
    wanted_ = wanted;
    estimated_ = estimated;
    update();
}

void ActuatorGrid::setLive(bool live) {
    if (live == live_) return;
    live_ = live;
    update();
}

void ActuatorGrid::setCurrent(int index) {
    index = std::clamp(index, 0, std::max(static_cast<int>(names_.size()) - 1, 0));
    if (index == current_) return;
    current_ = index;
    update();
    emit currentChanged(index);
}

int ActuatorGrid::columns() const {
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(names_.size())))));
}

int ActuatorGrid::cellSize(int width) const { return std::clamp(width / columns(), 4, 40); }

QRect ActuatorGrid::cellOf(int index) const {
    const int side = cellSize(width());
    return {index % columns() * side, index / columns() * side, side - 1, side - 1};
}

int ActuatorGrid::cellAt(const QPoint& place) const {
    const int side = cellSize(width());
    const int x = place.x() / side, y = place.y() / side;
    if (place.x() < 0 || place.y() < 0 || x >= columns()) return -1;
    const int index = y * columns() + x;
    return index < names_.size() ? index : -1;
}

int ActuatorGrid::heightForWidth(int width) const {
    const int rows = (static_cast<int>(names_.size()) + columns() - 1) / columns();
    return rows * cellSize(width);
}

QSize ActuatorGrid::sizeHint() const { return {240, heightForWidth(240)}; }

void ActuatorGrid::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    const QColor fill = live_ ? colors.accent : colors.textMuted;
    for (int i = 0; i < names_.size(); ++i) {
        const QRectF cell = cellOf(i);
        const auto at = static_cast<std::size_t>(i);
        painter.fillRect(cell, colors.sunken);
        painter.fillRect(QRectF(cell.left(), cell.bottom() - estimated_[at] * cell.height(), cell.width(),
                                estimated_[at] * cell.height()),
                         fill);
        if (std::abs(wanted_[at] - estimated_[at]) < kArrived) continue;
        const double line = cell.bottom() - wanted_[at] * (cell.height() - 1.0) - 1.0;
        painter.fillRect(QRectF(cell.left(), line, cell.width(), 1.0), colors.text);
    }
    if (names_.isEmpty()) return;
    painter.setPen(QPen(hasFocus() ? colors.text : colors.accentText, 2.0));
    painter.drawRect(cellOf(current_).adjusted(0, 0, 0, 0));
}

bool ActuatorGrid::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const int index = cellAt(help->pos());
    if (index < 0) {
        QToolTip::hideText();
        return true;
    }
    const double stroke = wanted_[static_cast<std::size_t>(index)];
    QToolTip::showText(help->globalPos(), QString("%1: %2 %").arg(names_[index]).arg(qRound(100.0 * stroke)), this);
    return true;
}

void ActuatorGrid::mousePressEvent(QMouseEvent* event) {
    const int index = cellAt(event->pos());
    if (index >= 0) setCurrent(index);
}

void ActuatorGrid::mouseMoveEvent(QMouseEvent* event) {
    const int index = cellAt(event->pos());
    if (index >= 0 && (event->buttons() & Qt::LeftButton) != 0) setCurrent(index);
}

void ActuatorGrid::keyPressEvent(QKeyEvent* event) {
    switch (event->key()) {
    case Qt::Key_Left:
        return setCurrent(current_ - 1);
    case Qt::Key_Right:
        return setCurrent(current_ + 1);
    case Qt::Key_Up:
        return setCurrent(current_ - columns());
    case Qt::Key_Down:
        return setCurrent(current_ + columns());
    case Qt::Key_Home:
        return setCurrent(0);
    case Qt::Key_End:
        return setCurrent(static_cast<int>(names_.size()) - 1);
    default:
        QWidget::keyPressEvent(event);
    }
}

} // namespace lumorph::studio
