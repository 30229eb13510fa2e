#include "core/motion/delayed_strokes.h"

#include <algorithm>
#include <utility>

namespace lumorph {

void DelayedStrokes::setDelays(std::vector<double> seconds) {
    delays_ = std::move(seconds);
    longest_ = delays_.empty() ? 0.0 : std::ranges::max(delays_);
}

void DelayedStrokes::standAt(std::span<const double> strokes) {
    now_.assign(strokes.begin(), strokes.end());
    told_.clear();
    told_.push_back({0.0, now_});
}

void DelayedStrokes::step(std::span<const double> told, double seconds) {
    told_.push_back({seconds, {told.begin(), told.end()}});
    double since = 0.0; // the last step that is as old as the longest delay
    for (std::size_t k = told_.size(); k-- > 1;) {
        since += told_[k].seconds;
        if (since < longest_) continue;
        told_.erase(told_.begin(), told_.begin() + static_cast<std::ptrdiff_t>(k - 1));
        break;
    }
    now_.resize(told.size());
    for (std::size_t i = 0; i < now_.size(); ++i) now_[i] = strokeOf(i);
}

double DelayedStrokes::strokeOf(std::size_t actuator) const noexcept {
    const double delay = actuator < delays_.size() ? delays_[actuator] : 0.0;
    const double newest = told_.back().strokes[actuator];
    if (!(delay > 0.0)) return newest;
    double since = 0.0;
    for (std::size_t k = told_.size() - 1; k > 0; --k) {
        const double step = told_[k].seconds;
        if (since + step >= delay && step > 0.0) {
            const double before = told_[k - 1].strokes[actuator], after = told_[k].strokes[actuator];
            return before == after ? after : after + (delay - since) / step * (before - after);
        }
        since += step;
    }
    return told_.front().strokes[actuator]; // before the first it stood there
}

void DelayedStrokes::rearrange(std::span<const std::optional<std::size_t>> places) {
    const auto moved = [places](const std::vector<double>& from) {
        std::vector<double> to;
        for (const std::optional<std::size_t>& place : places) to.push_back(place ? from[*place] : 0.0);
        return to;
    };
    for (Told& told : told_) told.strokes = moved(told.strokes);
    now_ = moved(now_);
}

bool DelayedStrokes::stand() const noexcept {
    return std::ranges::all_of(told_, [this](const Told& told) { return told.strokes == told_.back().strokes; });
}

} // namespace lumorph
