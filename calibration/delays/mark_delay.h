#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "calibration/delays/measured_delay.h"
#include "core/base/progress.h"

namespace lumorph {

/// A body that is moved by hand and the projected mark that follows it, as one camera sees both.
struct MarkRecording {
    struct Picture {
        double seconds = 0.0; ///< middle of the exposure; by any clock
        glm::dvec3 body{0.0}; ///< place of the body, metres
        glm::dvec3 mark{0.0}; ///< place of its mark, metres in the same frame; it may lie beside by a constant
    };
    std::vector<Picture> pictures; ///< by time
    double shownSeconds = 0.0;     ///< how long a projected picture stays: half of that it is late in the mean
};

/// From a motion to its light, without any prediction: the lag at which the mark goes the body's way best. Both ways
/// are smoothed alike, so that noise and a camera of 30 pictures a second do not shift them. Sigma by leaving out one
/// tenth of the recording after another.
///
/// Throws CaptureRefused: `camera_slow`, `clock_jumps`, `not_a_number`, `nothing_moves` for a body that moves less than
/// 2 cm or slower than 3 cm/s, `model_does_not_fit` for a mark that does not follow, `motion_periodic` where several
/// lags explain it; Cancelled.
[[nodiscard]] MeasuredDelay solveMarkDelay(const MarkRecording& recording, const Progress& progress = {});

} // namespace lumorph
