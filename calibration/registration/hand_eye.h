#pragma once

#include <string>
#include <vector>

#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

namespace lumorph {

/// Two bodies joined rigidly, each tracked in its own world by its own clock: how they hang together. At B's time t,
///     worldBFromB(t) * bFromA = worldBFromWorldA * worldAFromA(toA(t)).
struct HandEye {
    Pose bFromA;             ///< takes coordinates of body A to body B
    Pose worldBFromWorldA;   ///< likewise of their worlds
    double timeOffset = 0.0; ///< seconds: B's clock minus A's, when B's says `middle`
    double clockDrift = 0.0; ///< seconds that B's clock gains on A's in one of its own
    double middle = 0.0;     ///< of the recordings, by B's clock
    /// A's clock, when B's says this.
    [[nodiscard]] double toA(double bSeconds) const noexcept {
        return bSeconds - timeOffset - clockDrift * (bSeconds - middle);
    }

    double medianTurn = 0.0;  ///< radians that single poses of B differ from what A says
    double medianShift = 0.0; ///< metres, likewise; of B's place in its world
    std::size_t poses = 0;    ///< of the recording with fewer, that A and B both saw

    /// How far bFromA of the first half of the recording lies from that of the second: what counts in the end.
    double halvesTurn = 0.0, halvesShift = 0.0; ///< radians, metres

    double turnSigma = 0.0, shiftSigma = 0.0, offsetSigma = 0.0; ///< of bFromA, radians and metres; seconds
    double driftSigma = 0.0;
    std::vector<Finding> warnings;
};

/// Finds it without a guess: clocks, which may drift, by angular speed, rotation and place in closed form from relative
/// motions (as Park and Martin 1994), then all together, robust, by the noise that the recordings themselves show.
/// Sigmas come from leaving out one eighth of the recording after another, so that noise which lasts counts.
///
/// Where they fit badly, other readings are tried. With a warning it is solved by: quaternions with w first
/// (`quaternion_order`); times in milli-, micro- or nanoseconds, or in frames where the other has seconds
/// (`time_unit`); a body that turned about its own origin, which leaves its unit and handedness unknown
/// (`turns_in_place`). One recording that has the world in the body's frame is refused (`inverted`): which of the two
/// it is makes no difference to the fit.
///
/// Throws CaptureRefused: `clocks_unknown` (nothing correlates), `motion_degenerate` with the motion that is missing,
/// `mirrored` (one of the worlds is left-handed), `wrong_units` (near the ratio of two units), `inverted`, `time_unit`
/// (both count frames), `model_does_not_fit` (they are not joined, or a tracker swapped bodies); Cancelled.
[[nodiscard]] HandEye solveHandEye(const PoseTrack& a, const PoseTrack& b, const Progress& progress = {});

} // namespace lumorph
