#include "devices/trackers/clock_match.h"

#include <algorithm>
#include <cmath>

namespace lumorph {

namespace {

constexpr Microseconds kSlowest{500'000};
constexpr double kFarthestSeconds = 86'400.0;

} // namespace

void ClockMatch::add(Microseconds sent, Microseconds received, std::uint64_t ticks, std::uint64_t hertz) {
    const Microseconds took = received - sent;
    if (took < Microseconds{0} || took > kSlowest || hertz == 0) return;
    answers_[count_++ % answers_.size()] = {sent + took / 2, took, ticks, hertz};
}

std::optional<Microseconds> ClockMatch::localOf(std::uint64_t ticks) const {
    if (count_ == 0) return std::nullopt;
    const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, answers_.size()));
    const Answer& best =
        *std::min_element(answers_.begin(), end, [](const Answer& a, const Answer& b) { return a.took < b.took; });
    // Of unsigned numbers, so that a difference of any two is defined; read as signed it is the shorter way.
    const auto apart = static_cast<double>(static_cast<std::int64_t>(ticks - best.ticks));
    const double seconds = apart / static_cast<double>(best.hertz);
    if (std::abs(seconds) > kFarthestSeconds) return std::nullopt;
    return best.middle + Microseconds(std::llround(1e6 * seconds));
}

} // namespace lumorph
