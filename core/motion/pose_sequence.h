#pragma once

#include <span>
#include <string>
#include <vector>

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

/// Throws InvalidInput that names the pose or step: no steps or too many, a name that is empty, twice there or nowhere,
/// strokes that are not `actuators` numbers in [0, 1], times that are not from 0 to kMaxStepSeconds.
void requirePlayable(const PoseSequence& sequence, std::size_t actuators);

/// Seconds from its beginning to its end, or of one round.
[[nodiscard]] double durationOf(const PoseSequence& sequence) noexcept;

/// Where the device is to be, `seconds` >= 0 after the beginning: one stroke an actuator. `from` is where it stood at
/// the beginning: the first way of the first round leads from there. After the end a sequence that is no loop stays in
/// its last pose. The sequence is playable and `from` has as many strokes.
[[nodiscard]] std::vector<double> strokesAt(const PoseSequence& sequence, std::span<const double> from, double seconds);

/// The same sequence, each travel made as long as the actuators' velocity limits need, so that a device that keeps them
/// is where it is to be: `from` as in strokesAt, for the first. Throws InvalidInput where the counts do not match.
[[nodiscard]] PoseSequence withinLimits(PoseSequence sequence, std::span<const double> from,
                                        std::span<const MotionLimits> limits);

} // namespace lumorph
