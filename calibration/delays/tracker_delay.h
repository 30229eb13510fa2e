#pragma once

#include "calibration/delays/measured_delay.h"
#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

namespace lumorph {

/// By how much a tracker's poses are older than they say: the same body (or two that are joined) seen by the tracker
/// and by a camera, whose poses are of the middle of their exposures, both by one clock. Negative where the tracker's
/// poses are younger, as of one that predicts. Nothing need be known of worlds and bodies (hand_eye.h), and the sigma
/// comes from leaving out one eighth of the recording after another.
///
/// Throws CaptureRefused as soundTrack and solveHandEye do, and: `camera_slow` for fewer than eight poses of the camera
/// a second, `nothing_moves` for a body that is turned by less than 10 degrees, `motion_periodic` where several delays
/// explain the motion, `clock_jumps` where both clocks differ by more than half a second; Cancelled.
[[nodiscard]] MeasuredDelay solveTrackerDelay(const PoseTrack& tracker, const PoseTrack& camera,
                                              const Progress& progress = {});

} // namespace lumorph
