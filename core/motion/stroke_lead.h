#pragma once

#include <deque>
#include <span>
#include <vector>

#include "core/motion/motion.h"

namespace lumorph {

/// Commands for strokes that are wanted from frame to frame and whose future is not known: ahead of them by as much as
/// the soft motion under the limits lags behind a steady change, as far as they have changed steadily of late. Strokes
/// that stay are commanded as they are. Causal counterpart of `MotionPlanner`.
class StrokeLead {
public:
    explicit StrokeLead(std::span<const MotionLimits> limits);

    /// Nothing is known of what was wanted before, such as with another target.
    void restart() noexcept { past_.clear(); }
    /// Strokes in [0, 1] that are wanted now, `seconds` after those before; returns the commands. Throws InvalidInput
    /// when the count or the time is wrong.
    std::span<const double> step(std::span<const double> wanted, double seconds);

private:
    struct Wanted {
        double seconds = 0.0; ///< since the one before
        std::vector<double> strokes;
    };
    [[nodiscard]] double trendOf(std::size_t actuator) const noexcept;

    std::vector<double> lags_; ///< seconds, one an actuator
    std::deque<Wanted> past_;  ///< the newest last
    std::vector<double> commands_;
};

} // namespace lumorph
