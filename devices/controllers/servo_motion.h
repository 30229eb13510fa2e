#pragma once

namespace lumorph {

/// How one servo may move, in strokes and seconds.
struct ServoMotionLimits {
    double velocity = 1.0;
    double speedUp = 8.0; ///< acceleration that motions are planned with, no more than `brake`
    double brake = 8.0;   ///< greatest acceleration of all
};

struct ServoMotion {
    double position = 0.0;
    double velocity = 0.0;
};

/// One step towards a target, however long the next steps will be: the velocity, once it is within its limit, stays
/// there; it changes by at most brake x seconds; and where it could be stopped before a place by `brake` alone, it
/// still can after the step. So a servo never passes a target that stands still, nor the end of its range.
[[nodiscard]] ServoMotion movedServo(ServoMotion now, double target, double seconds,
                                     const ServoMotionLimits& limits) noexcept;

} // namespace lumorph
