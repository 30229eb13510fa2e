#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// Servos that somebody holds, or that are stuck: where the board reads their positions, such a servo is far from all
/// the places that it was told of late. Pure.
class HeldServos {
public:
    static constexpr double kFar = 0.1;              ///< strokes
    static constexpr Microseconds kArrives{600'000}; ///< by then a servo is where it was told to be, and was read there
    static constexpr Microseconds kHeldFor{300'000}; ///< so long it must be far
    static constexpr Microseconds kFreeFor{2'000'000}; ///< so long it must be where it is told again, and go along

    /// What the link says `now`; call it ten times a second or more often.
    void look(const LinkStatus& status, Microseconds now);
    void forget();
    /// In order.
    [[nodiscard]] const std::vector<std::size_t>& held() const noexcept { return held_; }

private:
    /// All places of some time.
    struct Range {
        double least = 1e9;
        double most = -1e9;
        void take(double place) {
            least = std::min(least, place);
            most = std::max(most, place);
        }
        [[nodiscard]] double width() const { return most - least; }
    };
    struct Servo {
        std::deque<std::pair<Microseconds, double>> told; ///< strokes, of the time that it has to arrive
        std::optional<Microseconds> changing;             ///< since when it seems to be what it was not
        Range went, meant; ///< where it was read, and where it was told to be, since then
        bool held = false;
    };
    static void look(Servo& servo, const ServoStatus& status, Microseconds now);

    std::vector<Servo> servos_;
    std::vector<std::size_t> held_;
};

} // namespace lumorph::studio
