#pragma once

#include <span>
#include <vector>

namespace lumorph {

/// Limits of one actuator's motion (R19), in strokes: 1 is the full range.
struct MotionLimits {
    double maxVelocity = 1.0;    ///< strokes a second, 1e-6 to 1e6
    double dampingRatio = 1.0;   ///< 1 (critical) to 1000, so that it cannot oscillate
    double settleSeconds = 0.15; ///< time constant of the approach, 1e-6 to 1e6
};

/// Where an actuator is and how fast it moves, in strokes.
struct MotionState {
    double position = 0.0; ///< in [0, 1]
    double velocity = 0.0; ///< strokes a second
};

/// Moves from `now` towards `target` in [0, 1] for `seconds` >= 0 under the limits: a damped
/// second-order approach, x'' = (target - x) / settle^2 - 2 damping x' / settle, whose speed is held
/// at maxVelocity while it would be higher. Solved in closed form, so that one step and ten thousand
/// steps of the same total time agree within 1e-9 strokes.
///
/// A motion starts softly, and it approaches a constant target from one side only: it never turns
/// back, never passes it and never leaves [0, 1]. For that a velocity that a new target makes wrong is
/// dropped at once, wholly where it leads away from the target, down to |target - x| times the faster
/// decay rate where it would pass it, and to maxVelocity where the limit was lowered. Deceleration
/// has no other limit.
///
/// Throws InvalidInput for a state, a target, a time or limits that are NaN, infinite or out of range.
[[nodiscard]] MotionState advance(MotionState now, double target, double seconds, const MotionLimits& limits);

/// All actuators of a device, for the frame loop. Holds the estimated physical state; starts at rest.
class MotionModel {
public:
    /// Throws InvalidInput when a limit is out of range.
    explicit MotionModel(std::vector<MotionLimits> limits);
    /// Moves every actuator towards its target and returns the new positions, strokes. Throws
    /// InvalidInput, and moves nothing, when the count, one target or the time is wrong.
    std::span<const double> step(std::span<const double> targets, double seconds);
    [[nodiscard]] std::span<const double> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<const double> velocities() const noexcept { return velocities_; }
    /// Takes over positions that were read back from the device; velocities become 0. Throws
    /// InvalidInput, and changes nothing, when the count or one position is wrong.
    void reset(std::span<const double> positions);
    /// Goes on from a motion under other limits: positions and velocities, one each. Throws InvalidInput, and changes
    /// nothing, when a count or a number is wrong.
    void resume(std::span<const double> positions, std::span<const double> velocities);

private:
    std::vector<MotionLimits> limits_;
    std::vector<double> positions_;
    std::vector<double> velocities_;
};

} // namespace lumorph
