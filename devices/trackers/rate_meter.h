#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/clock.h"

namespace lumorph {

/// How often something happens, over the last second; up to 2048 times.
class RateMeter {
public:
    void note(Microseconds now) { times_[count_++ % times_.size()] = now; }

    [[nodiscard]] double perSecond(Microseconds now) const {
        constexpr Microseconds kWindow{1'000'000};
        const std::size_t held = std::min(count_, times_.size());
        std::size_t recent = 0;
        while (recent < held && now - times_[(count_ - 1 - recent) % times_.size()] < kWindow) ++recent;
        if (recent < 2) return static_cast<double>(recent);
        const Microseconds span = times_[(count_ - 1) % times_.size()] - times_[(count_ - recent) % times_.size()];
        // What is spread over the window tells its rate by its steps; a burst counts as what came in a second.
        if (span < kWindow / 2) return static_cast<double>(recent);
        return 1e6 * static_cast<double>(recent - 1) / static_cast<double>(span.count());
    }

private:
    std::array<Microseconds, 2048> times_{};
    std::size_t count_ = 0; ///< ever
};

} // namespace lumorph
