#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/clock.h"

namespace lumorph {

/// Tells times of another machine's clock by ours, from questions that it answered with its time: it was asked and
/// answered between two moments of ours, and of the last few answers the quickest is the most exact.
class ClockMatch {
public:
    /// Answers that took longer than half a second, or less than no time, are left out.
    void add(Microseconds sent, Microseconds received, std::uint64_t ticks, std::uint64_t hertz);
    /// Empty while nothing is known, and for what is more than a day off.
    [[nodiscard]] std::optional<Microseconds> localOf(std::uint64_t ticks) const;
    void clear() noexcept { count_ = 0; }

private:
    struct Answer {
        Microseconds middle{0};
        Microseconds took{0};
        std::uint64_t ticks = 0;
        std::uint64_t hertz = 1;
    };
    /// As many as one a second are still without drift: 16 s of two clocks that differ by 50 ppm are 0.8 ms.
    std::array<Answer, 16> answers_;
    std::size_t count_ = 0; ///< ever; the newest is at (count - 1) % 16
};

} // namespace lumorph
