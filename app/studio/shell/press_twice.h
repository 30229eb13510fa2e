#pragma once

#include <optional>

#include "core/base/clock.h"

namespace lumorph::studio {

/// Tells the second of two presses within 600 ms. A third in a row begins anew.
class PressTwice {
public:
    static constexpr Microseconds kWithin{600'000};

    /// True where this press is the second.
    bool press(Microseconds now) {
        const bool second = first_ && now - *first_ <= kWithin;
        first_ = second ? std::nullopt : std::optional(now);
        return second;
    }
    /// Another key came between.
    void reset() { first_.reset(); }

private:
    std::optional<Microseconds> first_;
};

} // namespace lumorph::studio
