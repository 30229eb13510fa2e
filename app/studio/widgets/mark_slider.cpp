#include "app/studio/widgets/mark_slider.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <QStyleOptionSlider>
#include <QToolTip>

#include "app/studio/look/palette.h"
#include "app/studio/recording/recording_service.h"

namespace lumorph::studio {
namespace {

constexpr int kSteps = 10'000;
constexpr double kNear = 5.0; // pixels

} // namespace

MarkSlider::MarkSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
    setRange(0, kSteps);
    setSingleStep(kSteps / 100);
    setPageStep(kSteps / 20);
    setMouseTracking(true);
    // By keys; the mouse says more exactly where.
    connect(this, &QSlider::valueChanged, this,
            [this](int value) { emit sought(duration_ * static_cast<double>(value) / kSteps); });
}

void MarkSlider::setDuration(double seconds) {
    duration_ = seconds;
    update();
}

void MarkSlider::setMarks(std::vector<Mark> marks) {
    marks_ = std::move(marks);
    update();
}

void MarkSlider::showSeconds(double seconds) {
    const QSignalBlocker quiet(this);
    setValue(duration_ > 0.0 ? static_cast<int>(std::lround(kSteps * seconds / duration_)) : 0);
}

double MarkSlider::xOf(double seconds) const {
    const int handle = style()->pixelMetric(QStyle::PM_SliderLength, nullptr, this);
    return handle / 2.0 + (duration_ > 0.0 ? seconds / duration_ : 0.0) * (width() - handle);
}

double MarkSlider::secondsAt(double x) const {
    const int handle = style()->pixelMetric(QStyle::PM_SliderLength, nullptr, this);
    return duration_ * std::clamp((x - handle / 2.0) / std::max(1, width() - handle), 0.0, 1.0);
}

/// A mark that is nearly hit is meant.
void MarkSlider::seekTo(double x) {
    double seconds = secondsAt(x);
    for (const Mark& mark : marks_)
        if (std::abs(xOf(mark.seconds) - x) <= kNear) seconds = mark.seconds;
    showSeconds(seconds);
    emit sought(seconds);
}

void MarkSlider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return QSlider::mousePressEvent(event);
    setSliderDown(true);
    seekTo(event->position().x());
}

void MarkSlider::mouseMoveEvent(QMouseEvent* event) {
    if (isSliderDown()) seekTo(event->position().x());
}

void MarkSlider::mouseReleaseEvent(QMouseEvent* /*event*/) { setSliderDown(false); }

bool MarkSlider::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip) return QSlider::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    QString text = clockText(secondsAt(help->pos().x()));
    for (const Mark& mark : marks_)
        if (std::abs(xOf(mark.seconds) - help->pos().x()) <= kNear) text = clockText(mark.seconds) + "  " + mark.text;
    QToolTip::showText(help->globalPos(), text, this);
    return true;
}

void MarkSlider::paintEvent(QPaintEvent* event) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor color = currentPalette().accentText;
    for (const Mark& mark : marks_) {
        const double x = std::round(xOf(mark.seconds));
        painter.fillRect(QRectF(x - 1.0, 1.0, 2.0, height() - 2.0), color);
    }
    painter.end();
    QSlider::paintEvent(event);
}

} // namespace lumorph::studio
