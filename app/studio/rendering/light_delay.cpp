#include "app/studio/rendering/light_delay.h"

#include <algorithm>
#include <utility>

namespace lumorph::studio {

namespace {

constexpr double kSmoothing = 0.05;

} // namespace

void LightDelay::add(double milliseconds) noexcept {
    const bool isLong = milliseconds > kLongest;
    const bool wasLong = std::exchange(isLong_, isLong);
    if (isLong && !wasLong) return;
    usual_ += (usual_ == 0.0 ? 1.0 : kSmoothing) * (std::min(milliseconds, kLongest) - usual_);
}

} // namespace lumorph::studio
