#pragma once

#include <vector>

#include "calibration/delays/measured_delay.h"
#include "core/base/progress.h"

namespace lumorph {

/// Flashes of a projector and what a camera saw of them, all by the clock of the loop that asked for them.
struct FlashRecording {
    struct Flash {
        double on = 0.0, off = 0.0; ///< seconds: frames that asked for light, and for black again
    };
    struct Picture {
        double seconds = 0.0;    ///< when the exposure of its first row began
        double brightness = 0.0; ///< mean of the region in which the flash is seen, in any unit that is linear in light
    };
    std::vector<Flash> flashes;    ///< by time; dark between them
    std::vector<Picture> pictures; ///< by time; those that were lost are missing
    double exposure = 0.01;        ///< seconds that each row is exposed
    /// Seconds by which the first and last row of the region are exposed after the first of the picture: 0 for a camera
    /// with a global shutter.
    double firstRow = 0.0, lastRow = 0.0;
    /// Standard deviation, seconds, of an unknown offset that all picture times share: of a camera without time stamps,
    /// whose transfer time counts as delay.
    double arrivalSigma = 0.0;
};

/// When flashes were asked for, so that a camera of whatever rate sees their edges at all phases: `count` of them from
/// `begin` on, on for about an eighth of a second, at times that do not repeat. The same for the same seed.
[[nodiscard]] std::vector<FlashRecording::Flash> planFlashes(int count, double begin, unsigned seed);

/// From a frame to its light: the delay at which the share of each exposure that the light was on explains the
/// brightness of all pictures best (least squares over delay, black and white). A picture that is exposed while light
/// comes or goes tells when to a fraction of its exposure; the others only say before or after. Sigma by leaving out
/// one flash after the other, so that a delay that is not the same for all of them counts.
///
/// Throws CaptureRefused: `camera_slow`, `clock_jumps`, `not_a_number`; `too_few_views` for fewer than 8 flashes during
/// the pictures; `flash_not_seen` where the brightness does not follow the flashes; `motion_periodic` where several
/// delays explain it. Cancelled.
[[nodiscard]] MeasuredDelay solveFlashDelay(const FlashRecording& recording, const Progress& progress = {});

} // namespace lumorph
