#include "app/workspaces/field/timeline.h"

#include <algorithm>

#include <QBoxLayout>
#include <QSignalBlocker>

#include "app/studio/widgets/dock_parts.h"

namespace lumorph::studio {

namespace {

constexpr int kSteps = 1000;
constexpr int kWidth = 400;

QString timeText(double seconds, double duration) {
    return QString("%1 / %2 s").arg(seconds, 0, 'f', 1).arg(duration, 0, 'f', 1);
}

} // namespace

Timeline::Timeline(Studio& studio, QWidget* parent)
    : FloatingCard(parent), studio_(studio), slider_(new QSlider(Qt::Horizontal, this)),
      time_(makeNumber("field.time", "00.0 / 00.0 s", this)) {
    setObjectName("field.timeline");
    slider_->setObjectName("field.scrub");
    slider_->setAccessibleName("Time of the animation");
    slider_->setToolTip("Time of the target's animation. Dragging stops it there.");
    slider_->setRange(0, kSteps);
    slider_->setPageStep(kSteps / 10);
    slider_->setSingleStep(kSteps / 100);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(8, 4, 16, 4);
    layout->setSpacing(8);
    layout->addWidget(makeCommandIcon(studio.commands.find("target.play"), "field.play", this));
    layout->addWidget(slider_, 1);
    layout->addWidget(time_);
    connect(slider_, &QSlider::valueChanged, this, &Timeline::scrub);
    setFixedWidth(kWidth);
    hide();
}

void Timeline::scrub(int step) {
    const auto& target = studio_.document.state().target.target;
    if (!target || target->duration <= 0.0) return;
    if (studio_.document.state().playback.playing)
        studio_.document.change("Stop the animation", [](StudioState& state) { state.playback.playing = false; });
    // The last step is the end, not the beginning that follows it.
    const double seconds = std::min(step / static_cast<double>(kSteps), 0.9999) * target->duration;
    studio_.loop.seek(seconds);
    time_->setText(timeText(seconds, target->duration));
}

void Timeline::refresh() {
    const auto& target = studio_.document.state().target.target;
    setVisible(target && target->duration > 0.0);
    const auto& frame = studio_.loop.frame();
    if (isHidden() || !frame || frame->target != target || slider_->isSliderDown()) return;
    if (!studio_.document.state().playback.playing) return;
    const double seconds = animationTime(*target, frame->seconds);
    const QSignalBlocker quiet(slider_);
    slider_->setValue(static_cast<int>(kSteps * seconds / target->duration));
    time_->setText(timeText(seconds, target->duration));
}

} // namespace lumorph::studio
