#include "app/workspaces/devices/horn_view.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kCell = 84, kTall = 96;
constexpr double kMiddle = 1500.0;              ///< microseconds at which a horn points up
constexpr double kDegreesPerMicrosecond = 0.09; ///< 180 degrees over 2000

} // namespace

HornView::HornView(QWidget* parent) : QWidget(parent) {
    QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    policy.setHeightForWidth(true);
    setSizePolicy(policy);
}

void HornView::show(std::vector<SimulatedServo> servos, std::vector<int> channels, int first) {
    first_ = first;
    const bool other = channels.size() != channels_.size();
    servos_ = std::move(servos);
    channels_ = std::move(channels);
    if (other) updateGeometry();
    update();
}

int HornView::columns(int width) const { return std::max(1, width / kCell); }

int HornView::heightForWidth(int width) const {
    const int across = columns(width);
    return kTall * ((static_cast<int>(channels_.size()) + across - 1) / across);
}

QSize HornView::sizeHint() const { return {3 * kCell, heightForWidth(3 * kCell)}; }
QSize HornView::minimumSizeHint() const { return {kCell, kTall}; }

void HornView::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const int across = columns(width());
    const double cell = static_cast<double>(width()) / across;
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        const int at = static_cast<int>(k);
        drawHorn(painter, QRectF(at % across * cell, at / across * kTall, cell, kTall), k);
    }
}

void HornView::drawHorn(QPainter& painter, const QRectF& box, std::size_t index) const {
    const Palette& colors = currentPalette();
    const int ofBoard = channels_[index] - first_;
    const auto channel = static_cast<std::size_t>(ofBoard);
    const bool there = ofBoard >= 0 && channel < servos_.size();
    const SimulatedServo servo = there ? servos_[channel] : SimulatedServo{};
    const bool powered = servo.pulse > 0.0;
    const QPointF axle(box.center().x(), box.top() + 38.0);
    painter.setPen(QPen(colors.border, 1.0));
    painter.setBrush(colors.raised);
    painter.drawRoundedRect(QRectF(axle.x() - 16.0, axle.y() - 10.0, 32.0, 36.0), 4.0, 4.0);
    painter.save();
    painter.translate(axle);
    painter.rotate((servo.position - kMiddle) * kDegreesPerMicrosecond);
    painter.setPen(Qt::NoPen);
    painter.setBrush(powered ? colors.accent : colors.textMuted);
    painter.drawRoundedRect(QRectF(-3.5, -30.0, 7.0, 36.0), 3.5, 3.5);
    painter.restore();
    painter.setBrush(colors.panel);
    painter.drawEllipse(axle, 2.5, 2.5);
    painter.setPen(powered ? colors.text : colors.textMuted);
    const QString pulse = powered ? QString::number(std::lround(servo.pulse)) + " µs" : QString("limp");
    painter.drawText(QRectF(box.left(), box.top() + 66.0, box.width(), 14.0), Qt::AlignCenter, pulse);
    painter.setPen(colors.textMuted);
    painter.drawText(QRectF(box.left(), box.top() + 80.0, box.width(), 14.0), Qt::AlignCenter,
                     there ? "ch. " + QString::number(channels_[index]) : "no channel");
}

} // namespace lumorph::studio
