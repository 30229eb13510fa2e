#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How servos are stepped and how long that takes.
struct ServoPlanOptions {
    int steps = 16;              ///< of a servo's range, up and again down
    int fresh = 4;               ///< states at the end that no curve is made of
    double velocity = 0.25;      ///< strokes a second: slowly
    double settleSeconds = 0.5;  ///< after a motion, until nothing trembles any more
    int pictures = 12;           ///< of one pass of structured light: columns and rows, two sets of three phases each
    double pictureSeconds = 0.1; ///< of each, with what projector and camera lag
    std::uint32_t seed = 1;      ///< of the fresh states
};

/// One state to visit and to look at.
struct ServoStep {
    enum class Kind {
        rest, ///< all at the ends where they begin
        find, ///< one servo alone: which part moves?
        level,
        fresh
    };
    Kind kind = Kind::rest;
    std::vector<std::size_t> servos; ///< that are measured in this step, by actuator
    std::vector<double> commanded;   ///< one an actuator
    bool operator==(const ServoStep&) const = default;
};

struct ServoPlan {
    std::vector<ServoStep> steps;
    std::vector<std::vector<std::size_t>> groups; ///< servos that are stepped together
    double seconds = 0.0;                         ///< that all of it takes
};

/// Which servos can move at once, so that camera and projector still see each of them: in no group two that move the
/// same vertices, and none whose visible part shrinks by more than a seventh when the others of the group stand as it
/// does. Greedy, in the order of the actuators. `seen` says how many points of each actuator's part are seen in a
/// state. Throws Cancelled as `seen` does.
[[nodiscard]] std::vector<std::vector<std::size_t>>
servoGroups(const Rig& rig, const std::function<std::vector<int>(std::span<const double> strokes)>& seen);

/// At rest; each servo alone at half its range; each group through its levels and back; states that nothing is fitted
/// to. Throws InvalidInput for options out of range, groups that do not name each actuator once, or more actuators
/// than 64.
[[nodiscard]] ServoPlan planServos(const Rig& rig, std::vector<std::vector<std::size_t>> groups,
                                   const ServoPlanOptions& options = {});

/// Seconds from one state to the next and its pictures.
[[nodiscard]] double secondsOf(const ServoPlanOptions& options, std::span<const double> from,
                               std::span<const double> to);

} // namespace lumorph
