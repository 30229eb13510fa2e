#include "app/applications/ambient/world_clock.h"

#include <algorithm>
#include <cmath>

namespace lumorph::ambient {
namespace {

constexpr double kWorldDay = 86'400.0;
constexpr double kQuick = 720.0; ///< seconds of the world in one, where a visitor moves the world's own time
constexpr double kUnseen = 90.0; ///< seconds of the world
constexpr double kReturns = 0.5; ///< seconds, by a factor of e
constexpr double kMorning = 7.0; ///< hours: when a visitor's next day begins

} // namespace

WorldClock::WorldClock(const Place& place, std::vector<double> days, double begin, double daySeconds,
                       std::function<double()> now)
    : place_(place), days_(std::move(days)), now_(std::move(now)), begin_(begin), utc_(begin),
      usualSpeed_(kWorldDay / daySeconds), speed_(usualSpeed_) {
    const auto today = std::ranges::find(days_, localMidnight(place, begin));
    if (today != days_.end()) day_ = static_cast<std::size_t>(today - days_.begin());
}

void WorldClock::setDays(std::vector<double> days, double begin) {
    days_ = std::move(days);
    begin_ = begin;
    const auto today = std::ranges::find(days_, localMidnight(place_, utc_));
    day_ = today == days_.end() ? 0 : static_cast<std::size_t>(today - days_.begin());
    if (today == days_.end() && !now_) utc_ = days_.front() + (utc_ - localMidnight(place_, utc_));
}

void WorldClock::goToNextDay(double hour) {
    day_ = (day_ + 1) % days_.size();
    utc_ = days_[day_] + 3600.0 * hour;
}

/// Sets the time at once where the step is too small to be seen, else returns to it exponentially.
void WorldClock::returnToNow(double step) {
    const double away = now_() - utc_;
    utc_ += std::abs(away) < kUnseen ? away : away * (1.0 - std::exp(-step / kReturns));
}

void WorldClock::advance(double step, const Visitor& visitor) {
    const double push = visitor.push().x;
    const double scrub = now_ ? kScrub * kQuick / usualSpeed_ : kScrub;
    speed_ = usualSpeed_ * (push >= 0.0 ? std::lerp(1.0, scrub, push) : std::lerp(1.0, -scrub, -push));
    const double midnight = localMidnight(place_, utc_);
    utc_ += speed_ * step;
    if (visitor.restart()) utc_ = now_ ? now_() : begin_;
    if (visitor.next()) return goToNextDay(kMorning);
    const bool night = localMidnight(place_, utc_) > midnight;
    if (now_ && !visitor.there()) return returnToNow(step);
    if (night && !visitor.there() && usualSpeed_ > 1.0) goToNextDay((utc_ - localMidnight(place_, utc_)) / 3600.0);
}

} // namespace lumorph::ambient
