#pragma once

#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

namespace lumorph {

/// By how much two clocks differ that watched the same turns.
struct ClockOffset {
    double seconds = 0.0;     ///< B's clock minus A's, when B's says `middle`
    double drift = 0.0;       ///< seconds that B's clock gains on A's in one of its own; 0 where that is not known
    double middle = 0.0;      ///< of what both recorded, by B's clock
    double correlation = 0.0; ///< of the angular speeds at that offset, at most 1
    double runnerUp = 0.0;    ///< evidence for the best offset elsewhere over that for this one: near 1 is ambiguous

    /// A's clock, when B's says this.
    [[nodiscard]] double toA(double bSeconds) const noexcept {
        return bSeconds - seconds - drift * (bSeconds - middle);
    }
};

/// From the angular speeds of two bodies that are rigidly joined, which no frame changes: the offset at which they
/// correlate best, to a fraction of `kSpeedStep`. The clocks may differ by any amount; the recordings have to share at
/// least a third of the shorter one. Of recordings that share a minute or more it also finds the drift, up to
/// `kMostDrift`, by the offsets of parts. `correlation` is 0 where nothing turns. Throws Cancelled.
[[nodiscard]] ClockOffset clockOffset(const PoseTrack& a, const PoseTrack& b, const Progress& progress = {});
inline constexpr double kMostDrift = 3e-4; ///< of a clock of a computer or a camera; more is a jump
inline constexpr double kSpeedStep = 0.02; ///< seconds between samples of angular speed

} // namespace lumorph
