#pragma once

#include <string>
#include <vector>

#include "calibration/delays/measured_delay.h"
#include "core/base/progress.h"

namespace lumorph {

/// A servo that is told to step, and what a camera sees of its part.
struct StepRecording {
    struct Step {
        double seconds = 0.0;   ///< when the command was given
        double commanded = 0.0; ///< stroke in [0, 1]
    };
    struct Sample {
        double seconds = 0.0; ///< middle of the exposure, by the clock of the commands
        double stroke = 0.0;  ///< where the part is seen, 0 at rest and 1 at the end of its range
    };
    std::string servo;           ///< its name, for messages
    std::vector<Step> steps;     ///< by time; the first only brings it to where it begins
    std::vector<Sample> samples; ///< by time, until the part rests after the last step
};

/// A servo's lag, and what else its steps tell.
struct StepLag {
    MeasuredDelay lag;
    double velocity = 0.0; ///< strokes a second
    double play = 0.0;     ///< strokes that the horn goes after a turn before the part follows
};

/// Strokes between which a servo is stepped: where the camera tells them best.
struct StepRange {
    double low = 0.1, high = 0.9;
};
/// Steps by which lag, speed and play can be told from one another: up in two steps and down in two, `rounds` times.
/// After a turn the horn crosses the play before the part moves; in the second step of the same direction it does not.
/// Each is held until a servo of this `velocity` (strokes a second) has long arrived, and a little longer by chance, so
/// that a camera sees all phases. The same for the same seed.
[[nodiscard]] std::vector<StepRecording::Step> planSteps(double velocity, double begin, unsigned seed,
                                                         const StepRange& range = {}, int rounds = 3);

/// Seconds after a step of `way` strokes at which a servo of this velocity rests, whatever its lag.
[[nodiscard]] double restAfter(double way, double velocity);

/// From a command to its motion: a horn that starts a dead time after its command and moves at one speed, and a part
/// that follows it with play, fitted to all steps at once (least squares over lag, speed and play). Where the part
/// rests before and after a step is taken from what was seen, so that a curve that is not straight does no harm. Sigma
/// by leaving out one step after the other.
///
/// Throws CaptureRefused: `camera_slow`, `clock_jumps`, `not_a_number`, `too_few_views` for fewer than four steps that
/// the camera saw, and of the servo `servo_dead`, `servo_reversed`, `servo_jammed`; Cancelled.
[[nodiscard]] StepLag solveStepLag(const StepRecording& recording, const Progress& progress = {});

} // namespace lumorph
