#pragma once

#include <span>
#include <vector>

namespace lumorph {

/// Limits of one actuator's motion (R19), in strokes: 1 is the full range.
struct MotionLimits {
    double maxVelocity = 1.0;    ///< strokes a second, > 0
    double dampingRatio = 1.0;   ///< >= 1 so that it cannot oscillate; 1 is critical
    double settleSeconds = 0.15; ///< time constant of the approach, > 0
};

/// Where an actuator is and how fast it moves, in strokes.
struct MotionState {
    double position = 0.0;
    double velocity = 0.0;
};

/// Moves from `now` towards `target` for `seconds` under the limits: a damped second-order approach
/// whose speed never exceeds maxVelocity, integrated so that the frame rate does not matter. Stays
/// within [0, 1]; never passes a constant target by more than 1 % of the step.
/// Throws InvalidInput for a target, a time or limits that are NaN, infinite or out of range; the
/// caller's state is then unchanged.
[[nodiscard]] MotionState advance(MotionState now, double target, double seconds, const MotionLimits& limits);

/// All actuators of a device, for the frame loop. Holds the estimated physical state.
class MotionModel {
public:
    explicit MotionModel(std::vector<MotionLimits> limits);
    /// Moves every actuator towards its target and returns the new positions, strokes.
    /// Throws InvalidInput (and moves nothing) when one target is not finite or the count is wrong.
    std::span<const double> step(std::span<const double> targets, double seconds);
    [[nodiscard]] std::span<const double> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<const double> velocities() const noexcept { return velocities_; }
    /// Takes over positions that were read back from the device; velocities become 0.
    void reset(std::span<const double> positions);

private:
    std::vector<MotionLimits> limits_;
    std::vector<double> positions_;
    std::vector<double> velocities_;
};

} // namespace lumorph
