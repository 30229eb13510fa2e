#include "app/workspaces/calibrate/error_map_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QLinearGradient>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "app/studio/look/palette.h"
#include "app/workspaces/common/field_colors.h"

namespace lumorph::studio {
namespace {

std::size_t cellOf(int row, int column) {
    return static_cast<std::size_t>(row) * ErrorPlan::kColumns + static_cast<std::size_t>(column);
}

constexpr int kTitleHeight = 24;
constexpr int kScaleHeight = 40;
constexpr int kGap = 16;

QColor errorColor(double share) { return gradeColor(1.0 - share); }

/// What stands at the red end: a round number above what most of the light has.
double scaleOf(const ErrorPlan& plan) {
    std::vector<double> errors;
    for (const std::vector<double>* plane : {&plan.table, &plan.device})
        for (const double error : *plane)
            if (std::isfinite(error)) errors.push_back(error);
    if (errors.empty()) return 1.0;
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(errors.size() - 1));
    std::ranges::nth_element(errors, at);
    for (const double round : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
        if (*at <= round) return round;
    return 100.0;
}

/// World metres as columns and rows of the plan.
QPointF cellOf(const ErrorPlan& plan, const QPointF& world) {
    return {(world.x() / plan.size.x + 0.5) * ErrorPlan::kColumns, (world.y() / plan.size.y + 0.5) * ErrorPlan::kRows};
}

/// Where light falls on one of the planes, and the device, with a little around: a plan is mostly dark table.
QRect partOf(const ErrorPlan& plan, const QPolygonF& device) {
    constexpr int kAround = 2;
    const QRect whole(0, 0, ErrorPlan::kColumns, ErrorPlan::kRows);
    QRect part;
    for (int row = 0; row < whole.height(); ++row)
        for (int column = 0; column < whole.width(); ++column) {
            const auto index = cellOf(row, column);
            if (std::isfinite(plan.table[index]) || std::isfinite(plan.device[index])) part |= QRect(column, row, 1, 1);
        }
    if (part.isEmpty()) return whole;
    QPolygonF outline;
    for (const QPointF& corner : device) outline << cellOf(plan, corner);
    part |= outline.boundingRect().toAlignedRect();
    return part.adjusted(-kAround, -kAround, kAround, kAround) & whole;
}

} // namespace

ErrorMapView::ErrorMapView(QWidget* parent) : QWidget(parent) {
    setObjectName("calibrate.map");
    setAccessibleName("Error map of table and device");
    setMouseTracking(true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void ErrorMapView::show(std::optional<ErrorPlan> plan, QPolygonF device) {
    plan_ = std::move(plan);
    device_ = std::move(device);
    if (plan_) part_ = partOf(*plan_, device_);
    update();
}

QRectF ErrorMapView::panelOf(int plane) const {
    const QSizeF table(part_.width() * plan_->size.x / ErrorPlan::kColumns,
                       part_.height() * plan_->size.y / ErrorPlan::kRows);
    const bool wide = width() > height();
    const QSizeF room = wide ? QSizeF((width() - kGap) / 2.0, height() - kTitleHeight - kScaleHeight)
                             : QSizeF(width(), (height() - kScaleHeight - kGap) / 2.0 - kTitleHeight);
    const QSizeF fitted = table.scaled(room, Qt::KeepAspectRatio);
    const QPointF origin = wide ? QPointF(plane * (room.width() + kGap), kTitleHeight)
                                : QPointF(0, kTitleHeight + plane * (room.height() + kTitleHeight + kGap));
    return {origin + QPointF((room.width() - fitted.width()) / 2.0, (room.height() - fitted.height()) / 2.0), fitted};
}

void ErrorMapView::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    if (!plan_) {
        painter.fillRect(rect(), colors.sunken);
        painter.setPen(colors.textMuted);
        painter.drawText(rect().adjusted(32, 32, -32, -32), Qt::AlignCenter | Qt::TextWordWrap,
                         "Where light can be trusted is drawn here once camera and projector are known, and the pose "
                         "in which the board lay on the table.");
        return;
    }
    const double most = scaleOf(*plan_);
    for (int plane = 0; plane < 2; ++plane) {
        const QRectF panel = panelOf(plane);
        const std::vector<double>& errors = plane == 0 ? plan_->table : plan_->device;
        painter.setPen(colors.text);
        painter.drawText(QRectF(panel.left(), panel.top() - kTitleHeight, panel.width(), kTitleHeight),
                         Qt::AlignLeft | Qt::AlignVCenter,
                         plane == 0 ? QString("On the table")
                                    : QString("%1 cm above it").arg(100.0 * plan_->height, 0, 'f', 0));
        painter.fillRect(panel, colors.sunken);
        QImage picture(ErrorPlan::kColumns, ErrorPlan::kRows, QImage::Format_ARGB32);
        for (int row = 0; row < ErrorPlan::kRows; ++row)
            for (int column = 0; column < ErrorPlan::kColumns; ++column) {
                const double error = errors[cellOf(row, column)];
                picture.setPixelColor(column, row, std::isfinite(error) ? errorColor(error / most) : Qt::transparent);
            }
        painter.drawImage(panel, picture, part_);
        const auto on = [&](const QPointF& world) {
            const QPointF cell = cellOf(*plan_, world) - part_.topLeft();
            return QPointF(panel.left() + cell.x() / part_.width() * panel.width(),
                           panel.top() + cell.y() / part_.height() * panel.height());
        };
        QPolygonF outline;
        for (const QPointF& corner : device_) outline << on(corner);
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(colors.text, 1.5));
        painter.drawPolygon(outline);
        painter.setPen(colors.line);
        painter.drawRect(panel);
    }
    const QRectF scale(8, height() - kScaleHeight + 12, std::min(240, width() - 120), 8);
    QLinearGradient gradient(scale.topLeft(), scale.topRight());
    for (int stop = 0; stop <= 8; ++stop) gradient.setColorAt(stop / 8.0, errorColor(stop / 8.0));
    painter.fillRect(scale, gradient);
    painter.setPen(colors.textMuted);
    painter.drawText(QRectF(scale.left(), scale.bottom() + 2, scale.width(), 16), Qt::AlignLeft, "0");
    painter.drawText(QRectF(scale.left(), scale.bottom() + 2, scale.width(), 16), Qt::AlignRight,
                     QString("%1 mm").arg(most));
    painter.drawText(QRectF(scale.right() + 16, scale.top() - 8, width() - scale.right() - 16, 32),
                     Qt::AlignLeft | Qt::AlignVCenter | Qt::TextWordWrap,
                     "95 of 100 times light lands no farther beside. Frame: the device.");
}

void ErrorMapView::mouseMoveEvent(QMouseEvent* event) {
    if (!plan_) return;
    for (int plane = 0; plane < 2; ++plane) {
        const QRectF panel = panelOf(plane);
        if (!panel.contains(event->position())) continue;
        const QPointF share = (event->position() - panel.topLeft());
        const int column = std::clamp(part_.left() + static_cast<int>(share.x() / panel.width() * part_.width()), 0,
                                      ErrorPlan::kColumns - 1);
        const int row = std::clamp(part_.top() + static_cast<int>(share.y() / panel.height() * part_.height()), 0,
                                   ErrorPlan::kRows - 1);
        const double error = (plane == 0 ? plan_->table : plan_->device)[cellOf(row, column)];
        QToolTip::showText(event->globalPosition().toPoint(),
                           std::isfinite(error) ? QString("%1 mm").arg(error, 0, 'f', 2) : QString("no light"), this);
        return;
    }
}

QPolygonF deviceOutlineOf(const StudioState& state) {
    if (!state.rig.rig) return {};
    glm::vec3 low(1e30F), high(-1e30F);
    for (const glm::vec3& point : state.rig.rig->restMesh().positions)
        low = glm::min(low, point), high = glm::max(high, point);
    QPolygonF outline;
    for (const glm::vec2 corner :
         {glm::vec2(low.x, low.z), glm::vec2(high.x, low.z), glm::vec2(high.x, high.z), glm::vec2(low.x, high.z)}) {
        const glm::vec4 world = state.installation->worldFromDevice * glm::vec4(corner.x, 0.0F, corner.y, 1.0F);
        outline << QPointF(world.x, world.z);
    }
    return outline;
}

} // namespace lumorph::studio
