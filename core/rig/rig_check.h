#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/rig/rig.h"

namespace lumorph {

/// One thing that goes wrong with a rig in motion, and where.
struct RigFinding {
    /// The gravest first: after the first four the solid is none, and what lies inside is a guess.
    enum class Kind {
        open,      ///< a seam of the mesh gapes, or it has a hole at rest
        inverted,  ///< a closed piece has turned inside out, or triangles are squeezed flat
        crossing,  ///< what the actuators move crosses itself
        collision, ///< what they move runs into something that does not move with it
        stretch,   ///< an edge of the surface that looks up at rest gets too long
        speed,     ///< a point gets too fast
    };
    Kind kind = Kind::open;
    std::vector<std::size_t> actuators; ///< all that have to move for it, ascending; none: at rest
    std::vector<double> first;          ///< strokes at which it begins, one an actuator of the rig
    std::vector<double> worst;          ///< strokes of the state looked at in which it is worst; of crossings, the last
    double amount = 0.0;                ///< at the worst, see unitOf()
    double limit = 0.0;                 ///< up to which it is no fault
    glm::vec3 place{0.0F};              ///< a point of the device where it is, metres, in the worst state
    std::string sentence;
    std::string remedy;
};

/// "open", "inverted", "crossing", "collision", "stretch" or "speed".
[[nodiscard]] const char* nameOf(RigFinding::Kind kind);
/// Of `amount` and `limit`: metres that a seam gapes or along which surfaces meet, "triangles" that are turned, "1" for
/// a stretch (0.1 is a tenth longer), metres a second.
[[nodiscard]] const char* unitOf(RigFinding::Kind kind);

struct RigCheckOptions {
    /// How much longer than at rest an edge of the surface may get. Knitted fabric with elastane gives about its own
    /// length; woven cloth a tenth or two, paper and card next to nothing.
    double maxStretch = 1.0;
    /// Metres a second. Robots move no faster with people in reach while they are set up: "reduced speed", ISO 10218-1.
    double maxSpeed = 0.25;
    int states = 100;       ///< joint states, extremes among them; at least half as many random ones
    std::uint64_t seed = 1; ///< which
};

struct RigCheck {
    std::vector<RigFinding> findings; ///< the gravest kind first, in a kind the worst
    int levelsLookedAt = 0;           ///< of single actuators
    int pairsLookedAt = 0;            ///< of actuators that can meet
    int jointStates = 0;              ///< extremes of all actuators, and random ones
};

/// Looks at each actuator alone, at every level (33 strokes at least, 129 at most); at the pairs of actuators that can
/// meet, both to the full, and one beside the other at its end; at all extremes jointly (of up to six actuators, or
/// as many random ones) and at random joint states. Of each fault it finds where it begins, between the last sound
/// state looked at and the first bad one, by bisection; of many actuators, the fewest that make it. What is wrong at
/// rest is found once, without actuators: pieces of the mesh that overlap there do so by design. Throws InvalidInput
/// for limits below zero or not finite; Cancelled.
[[nodiscard]] RigCheck checkRig(const Rig& rig, const RigCheckOptions& options = {}, const Progress& progress = {});

} // namespace lumorph
