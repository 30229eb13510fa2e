#pragma once

#include <span>
#include <vector>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Where a servo really is, as a stroke, when it is told `commanded` and was really at `previous`. Gears with play
/// (a generalised play operator: Krasnosel'skii and Pokrovskii, "Systems with Hysteresis"): the horn follows the rising
/// curve where that pushes it up, the falling one where that pushes it down, and between the two it stays. So the
/// result depends on the turns of the way, not on its speed. A curve that does not rise is taken as level there.
/// A servo without points does what it is told.
[[nodiscard]] double realStroke(const MeasuredServo& servo, double commanded, double previous) noexcept;

/// The strokes that a servo really reaches; 0 to 1 for one without points.
struct StrokeRange {
    double low = 0.0, high = 1.0;
    bool operator==(const StrokeRange&) const = default;
};
[[nodiscard]] StrokeRange reachOf(const MeasuredServo& servo) noexcept;

/// Seconds from a command to its motion, one an actuator; 0 where that was not measured.
[[nodiscard]] std::vector<double> lagsOf(std::span<const Actuator> actuators, std::span<const MeasuredServo> servos);

/// The measured servos of a rig, by its actuators. Turns strokes that are really wanted into commands, and commands
/// into real strokes. A plain value without a state: what was before is given to it.
class ServoCurves {
public:
    /// A wish that turns back by less does not move the servo, strokes: the play would be taken up for nothing.
    static constexpr double kTurn = 1e-3;

    ServoCurves() = default;
    /// Actuators without a measured servo of their name do what they are told.
    ServoCurves(std::span<const Actuator> actuators, std::span<const MeasuredServo> servos);

    /// No servo of this rig was measured: commands are real strokes.
    [[nodiscard]] bool empty() const noexcept { return servos_.empty(); }
    /// The commands after which the actuators really stand at `wanted`, or as near as they come. `real` and
    /// `commanded` say where they are: who must go up is led by the rising curve, who must go down by the falling one,
    /// and who is there keeps its command, so that play is taken up once, where the direction turns. One number an
    /// actuator in all.
    [[nodiscard]] std::vector<double> commandsFor(std::span<const double> wanted, std::span<const double> real,
                                                  std::span<const double> commanded) const;
    /// Where the actuators really are at these commands; `real` comes in as where they were before, on a way on which
    /// no command turned.
    void follow(std::span<const double> commanded, std::span<double> real) const noexcept;
    /// Commands at which the actuators stand still at `real`, in the middle of their play.
    [[nodiscard]] std::vector<double> commandsAt(std::span<const double> real) const;
    /// Strokes that are wanted, within what the actuators reach.
    void limit(std::span<double> wanted) const noexcept;
    /// What the actuators reach, one each; empty where no servo was measured.
    [[nodiscard]] std::span<const StrokeRange> reach() const noexcept { return reach_; }

private:
    std::vector<MeasuredServo> servos_; ///< one an actuator, without points where it was not measured
    std::vector<StrokeRange> reach_;    ///< of them; its ends in order
};

} // namespace lumorph
