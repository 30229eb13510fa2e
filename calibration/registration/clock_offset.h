#pragma once

#include "calibration/registration/pose_track.h"

namespace lumorph {

/// By how much two clocks differ that watched the same turns.
struct ClockOffset {
    double seconds = 0.0;     ///< B's clock minus A's
    double correlation = 0.0; ///< of the angular speeds at that offset, at most 1
    double runnerUp = 0.0;    ///< evidence for the best offset elsewhere over that for this one: near 1 is ambiguous
};

/// From the angular speeds of two bodies that are rigidly joined, which no frame changes: the offset at which they
/// correlate best, to a fraction of `kSpeedStep`. The clocks may differ by any amount; the recordings have to share at
/// least a third of the shorter one. `correlation` is 0 where nothing turns.
[[nodiscard]] ClockOffset clockOffset(const PoseTrack& a, const PoseTrack& b);
inline constexpr double kSpeedStep = 0.02; ///< seconds between samples of angular speed

} // namespace lumorph
