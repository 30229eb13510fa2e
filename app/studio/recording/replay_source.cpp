#include "app/studio/recording/replay_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph::studio {
namespace {

bool isOf(const MatchFrame& frame, const MatchWish& wish) {
    return frame.rig == wish.rig && frame.field == wish.field && frame.target == wish.target &&
           frame.scene == wish.scene && frame.assets == wish.assets;
}

} // namespace

ReplaySource::ReplaySource(std::shared_ptr<const Recording> recording)
    : recording_(std::move(recording)), duration_(secondsOf(*recording_)) {}

std::shared_ptr<const MatchFrame> ReplaySource::frame(const MatchWish& wish, Microseconds now) {
    const std::scoped_lock lock(mutex_);
    pass(wish.stopped, now);
    const FrameRow* row = frameAt(*recording_, position_);
    const bool fits = wish.rig && row->estimated.size() == wish.rig->actuatorCount();
    if (!fits && shown_ && isOf(*shown_, wish)) return shown_;
    if (row == row_ && isOf(*shown_, wish)) return shown_;
    auto frame = std::make_shared<MatchFrame>(frameOf(*row, wish));
    frame->time = now; // when it is shown again
    frame->recorded = true;
    row_ = row;
    shown_ = std::move(frame);
    return shown_;
}

void ReplaySource::pass(bool stopped, Microseconds now) {
    const double passed = last_ ? 1e-6 * static_cast<double>((now - *last_).count()) : 0.0;
    last_ = now;
    if (!playing_ || stopped) return;
    position_ = std::min(position_ + speed_ * std::max(0.0, passed), duration_);
    if (position_ >= duration_) playing_ = false;
}

bool ReplaySource::moves() const { return playing(); }

void ReplaySource::play() {
    const std::scoped_lock lock(mutex_);
    if (position_ >= duration_) position_ = 0.0;
    playing_ = true;
    last_.reset();
}

void ReplaySource::pause() {
    const std::scoped_lock lock(mutex_);
    playing_ = false;
}

void ReplaySource::seek(double seconds) {
    const std::scoped_lock lock(mutex_);
    if (std::isfinite(seconds)) position_ = std::clamp(seconds, 0.0, duration_);
}

void ReplaySource::setSpeed(double times) {
    const std::scoped_lock lock(mutex_);
    if (std::isfinite(times)) speed_ = std::clamp(times, 0.05, 20.0);
}

bool ReplaySource::playing() const {
    const std::scoped_lock lock(mutex_);
    return playing_;
}

double ReplaySource::position() const {
    const std::scoped_lock lock(mutex_);
    return position_;
}

double ReplaySource::speed() const {
    const std::scoped_lock lock(mutex_);
    return speed_;
}

} // namespace lumorph::studio
