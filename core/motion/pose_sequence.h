#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "core/motion/motion.h"

namespace lumorph {

/// A joint state with a name.
struct NamedPose {
    std::string name;
    std::vector<double> strokes; ///< one in [0, 1] an actuator
    bool operator==(const NamedPose&) const = default;
};

/// How a way between two poses is covered, `u` in [0, 1] of its time giving the share of the way.
enum class Easing {
    linear,      ///< u
    smooth,      ///< 3 u^2 - 2 u^3: starts and ends at rest
    minimumJerk, ///< 10 u^3 - 15 u^4 + 6 u^5, as hands move (Flash and Hogan 1985): no jump of the acceleration
};

/// The share of the way, 0 to 1; `u` is held in [0, 1].
[[nodiscard]] double eased(Easing easing, double u) noexcept;
/// How many times as fast as evenly the way is covered where it is fastest: 1, 1.5 or 1.875.
[[nodiscard]] double peakSpeed(Easing easing) noexcept;
/// The largest acceleration of a way of length 1 in time 1: 6 (smooth) or 10 / sqrt(3) (minimumJerk). 0 for linear,
/// which has its whole speed at once, so that no time is long enough.
[[nodiscard]] double peakAcceleration(Easing easing) noexcept;

/// One step of a sequence: the way to a pose, and how long it is held.
struct PoseStep {
    std::string pose;
    double travelSeconds = 1.0;
    double holdSeconds = 0.0;
    Easing easing = Easing::minimumJerk;
    bool operator==(const PoseStep&) const = default;
};

/// Named poses, one after the other, in time. Played once it begins in the last place that the caller names and ends
/// in the last pose; in a loop the way to the first pose leads from the last one.
struct PoseSequence {
    std::vector<NamedPose> poses;
    std::vector<PoseStep> steps;
    bool loop = false;
    bool operator==(const PoseSequence&) const = default;
};

inline constexpr double kMaxStepSeconds = 3600.0; ///< of one travel or hold
inline constexpr std::size_t kMaxPoseSteps = 1000;
inline constexpr std::size_t kMaxPoses = 250;
inline constexpr std::size_t kMaxPoseName = 100; ///< bytes

/// Throws InvalidInput that names the pose or step: too many of them, a name that is empty, too long, twice there or
/// nowhere, strokes that are not `actuators` numbers in [0, 1], times that are not from 0 to kMaxStepSeconds.
void requireSound(const PoseSequence& sequence, std::size_t actuators);
/// The same, and there is a step to play.
void requirePlayable(const PoseSequence& sequence, std::size_t actuators);

/// Seconds from its beginning to its end, or of one round.
[[nodiscard]] double durationOf(const PoseSequence& sequence) noexcept;

/// Where the device is to be, `seconds` >= 0 after the beginning: one stroke an actuator. `from` is where it stood at
/// the beginning: the first way of the first round leads from there. After the end a sequence that is no loop stays in
/// its last pose. The sequence is playable and `from` has as many strokes.
[[nodiscard]] std::vector<double> strokesAt(const PoseSequence& sequence, std::span<const double> from, double seconds);

/// What an actuator may do on its way from pose to pose, in strokes.
struct PoseLimits {
    double maxVelocity = 1.0;                                         ///< a second
    double maxAcceleration = std::numeric_limits<double>::infinity(); ///< a second, a second
};
/// Velocities alone, as a rig says them.
[[nodiscard]] std::vector<PoseLimits> poseLimits(std::span<const MotionLimits> limits);

/// The same sequence, each travel made as long as the actuators' limits need, so that a device that keeps them is where
/// it is to be: `from` as in strokesAt, for the first. Of linear ways only the velocity is looked at
/// (peakAcceleration). Throws InvalidInput where the counts do not match.
[[nodiscard]] PoseSequence withinLimits(PoseSequence sequence, std::span<const double> from,
                                        std::span<const PoseLimits> limits);

/// A sequence that plays.
struct PosePlay {
    PoseSequence sequence;        ///< playable
    std::vector<double> from;     ///< as in strokesAt
    Microseconds since{0};        ///< when it began, by the clock of who plays it
    std::optional<double> heldAt; ///< seconds from its beginning at which it waits
    bool operator==(const PosePlay&) const = default;
};
/// How far it has come, seconds from its beginning; of a loop over all rounds.
[[nodiscard]] double secondsOf(const PosePlay& play, Microseconds now) noexcept;
/// Whether it is somewhere else a moment later.
[[nodiscard]] bool movesOn(const PosePlay& play, Microseconds now) noexcept;

} // namespace lumorph
