#include "app/applications/ambient/anticipation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace lumorph::ambient {

SeaState between(const SeaState& from, const SeaState& to, double share) noexcept {
    const double a = std::atan2(from.towards.y, from.towards.x), b = std::atan2(to.towards.y, to.towards.x);
    const double angle = a + share * std::remainder(b - a, 2.0 * std::numbers::pi);
    return {std::lerp(from.wind, to.wind, share), {std::cos(angle), std::sin(angle)}};
}

Anticipation::Anticipation(double delay) : delay_(delay) {
    if (!(delay >= 0.0 && delay <= 60.0))
        throw InvalidInput("anticipation", "is not a number of seconds from 0 to 60", "correct it");
}

void Anticipation::note(double seconds, const SeaState& shown) {
    notes_.push_back({seconds, shown});
    while (notes_.size() > 1 && notes_[1].seconds <= seconds - delay_) notes_.pop_front();
}

SeaState Anticipation::followed() const noexcept {
    if (notes_.empty()) return {};
    const double then = notes_.back().seconds - delay_;
    if (notes_.size() == 1 || then <= notes_[0].seconds) return notes_[0].state;
    const Note &a = notes_[0], &b = notes_[1];
    return between(a.state, b.state, std::min(1.0, (then - a.seconds) / (b.seconds - a.seconds)));
}

} // namespace lumorph::ambient
