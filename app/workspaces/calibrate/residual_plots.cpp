#include "app/workspaces/calibrate/residual_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kLegendLine = 17;
constexpr int kLegendSquare = 8;
constexpr const char* kKinds[] = {"camera", "projector", "held out"};
constexpr int kBarRow = 32;
constexpr int kBarName = 86;
constexpr double kFieldArrow = 0.07; // of the image's width, for the longest

QColor faint(QColor color, int alpha) {
    color.setAlpha(alpha);
    return color;
}

/// Where the square of each kind stands; a word that does not fit begins a line.
std::array<QPoint, std::size(kKinds)> legendOf(const QFontMetrics& metrics, int width) {
    std::array<QPoint, std::size(kKinds)> places;
    QPoint at(4, 6);
    for (std::size_t i = 0; i < std::size(kKinds); ++i) {
        const int word = kLegendSquare + 4 + metrics.horizontalAdvance(kKinds[i]);
        if (at.x() > 4 && at.x() + word > width) at = {4, at.y() + kLegendLine};
        places[i] = at;
        at.rx() += word + 12;
    }
    return places;
}

} // namespace

PoseBars::PoseBars(QWidget* parent) : QWidget(parent) {
    setObjectName("calibrate.bars");
    setAccessibleName("Residuals by pose");
    setFocusPolicy(Qt::StrongFocus);
    setToolTip("Root mean square errors of each pose, in pixels. Held out: the other poses alone say where this pose's "
               "light should be. Click one to see it.");
}

void PoseBars::show(const ProcamCalibration& solved, const std::string& chosen) {
    views_ = solved.views;
    worst_ = solved.worstView;
    chosen_ = chosen;
    updateGeometry();
    update();
}

int PoseBars::rowsTop() const { return legendOf(fontMetrics(), width()).back().y() + kLegendLine - 3; }

QSize PoseBars::sizeHint() const { return {260, rowsTop() + 4 + kBarRow * static_cast<int>(views_.size())}; }

void PoseBars::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    if (event->size().width() != event->oldSize().width()) updateGeometry(); // the legend may take another line
}

void PoseBars::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    double most = 0.1;
    for (const ViewQuality& view : views_)
        most = std::max({most, view.cameraRms, view.projectorRms, view.heldOut.value_or(0.0)});
    const QColor kinds[] = {colors.levelLow, colors.accent, colors.warning};
    const auto legend = legendOf(fontMetrics(), width());
    painter.setPen(colors.textMuted);
    for (std::size_t i = 0; i < std::size(kKinds); ++i) {
        painter.fillRect(QRect(legend[i], QSize(kLegendSquare, kLegendSquare)), kinds[i]);
        painter.drawText(legend[i] + QPoint(kLegendSquare + 4, kLegendSquare), kKinds[i]);
    }
    const double room = width() - kBarName - 44;
    for (std::size_t k = 0; k < views_.size(); ++k) {
        const ViewQuality& view = views_[k];
        const double top = rowsTop() + kBarRow * static_cast<double>(k);
        if (view.name == chosen_) painter.fillRect(QRectF(0, top, width(), kBarRow - 2), selectedColor(colors));
        painter.setPen(view.name == worst_ ? colors.warning : colors.text);
        painter.drawText(
            QRectF(4, top, kBarName - 8, kBarRow - 2), Qt::AlignVCenter | Qt::AlignLeft,
            painter.fontMetrics().elidedText(QString::fromStdString(view.name), Qt::ElideMiddle, kBarName - 8));
        const double values[] = {view.cameraRms, view.projectorRms, view.heldOut.value_or(0.0)};
        for (int i = 0; i < 3; ++i) {
            const QRectF bar(kBarName, top + 3 + 9 * i, std::max(1.0, room * values[i] / most), 7);
            painter.fillRect(bar, kinds[i]);
        }
        painter.setPen(colors.textMuted);
        const double shown = view.heldOut.value_or(view.projectorRms);
        painter.drawText(QRectF(width() - 42, top, 40, kBarRow - 2), Qt::AlignVCenter | Qt::AlignRight,
                         QString::number(shown, 'f', 2));
    }
    if (hasFocus()) {
        painter.setPen(colors.accent);
        painter.setBrush(Qt::NoBrush);
        painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    }
}

void PoseBars::mousePressEvent(QMouseEvent* event) {
    const int below = static_cast<int>(event->position().y()) - rowsTop();
    const int row = below / kBarRow;
    if (below >= 0 && row >= 0 && row < static_cast<int>(views_.size()))
        emit chosen(QString::fromStdString(views_[static_cast<std::size_t>(row)].name));
}

void PoseBars::keyPressEvent(QKeyEvent* event) {
    const int step = event->key() == Qt::Key_Down ? 1 : event->key() == Qt::Key_Up ? -1 : 0;
    if (step == 0 || views_.empty()) return QWidget::keyPressEvent(event);
    const auto found = std::ranges::find(views_, chosen_, &ViewQuality::name);
    const int now = found == views_.end() ? (step > 0 ? -1 : 1) : static_cast<int>(found - views_.begin());
    const int next = std::clamp(now + step, 0, static_cast<int>(views_.size()) - 1);
    emit chosen(QString::fromStdString(views_[static_cast<std::size_t>(next)].name));
}

ResidualField::ResidualField(QWidget* parent) : QWidget(parent) {
    setObjectName("calibrate.residuals");
    setAccessibleName("Residuals over the image");
    setMinimumHeight(150);
    setToolTip("The frame is the image. An error that all arrows of a place share is one of the lens; arrows without "
               "order are noise.");
}

void ResidualField::show(std::vector<std::pair<std::string, std::vector<Residual>>> residuals, QSize image,
                         const std::string& pose) {
    residuals_ = std::move(residuals);
    image_ = image;
    pose_ = pose;
    update();
}

void ResidualField::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (image_.isEmpty()) return;
    const QSizeF fitted = QSizeF(image_).scaled(QSizeF(width() - 2.0, height() - 20.0), Qt::KeepAspectRatio);
    const QRectF area(QPointF((width() - fitted.width()) / 2.0, 1.0), fitted);
    painter.setPen(colors.line);
    painter.setBrush(colors.sunken);
    painter.drawRect(area);
    double longest = 0.0;
    for (const auto& [name, all] : residuals_)
        for (const Residual& one : all) longest = std::max(longest, cv::norm(one.error));
    if (!(longest > 0.0)) { // nothing to enlarge
        painter.setPen(colors.textMuted);
        painter.drawText(area, Qt::AlignCenter, "No errors are known");
        return;
    }
    const double scale = fitted.width() / image_.width();
    const double enlarged = kFieldArrow * image_.width() / longest;
    painter.setClipRect(area);
    const auto draw = [&](const std::vector<Residual>& all, const QColor& color) {
        painter.setPen(QPen(color, 1.2));
        for (const Residual& one : all) {
            const QPointF at = area.topLeft() + QPointF(one.at.x + 0.5, one.at.y + 0.5) * scale;
            painter.drawLine(at, at + QPointF(one.error.x, one.error.y) * scale * enlarged);
            painter.drawPoint(at);
        }
    };
    for (const auto& [name, all] : residuals_)
        if (name != pose_) draw(all, faint(colors.textMuted, pose_.empty() ? 255 : 110));
    for (const auto& [name, all] : residuals_)
        if (name == pose_) draw(all, colors.accent);
    painter.setClipping(false);
    painter.setPen(colors.textMuted);
    painter.drawText(QRectF(0, area.bottom() + 2, width(), 18), Qt::AlignHCenter | Qt::AlignTop,
                     QString("%1 × %2, arrows %3 times; longest %4 px")
                         .arg(image_.width())
                         .arg(image_.height())
                         .arg(enlarged, 0, 'f', 0)
                         .arg(longest, 0, 'f', 2));
}

} // namespace lumorph::studio
