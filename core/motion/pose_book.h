#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/pose_sequence.h"

namespace lumorph {

/// The poses of a device and its sequence, as a project keeps them. Strokes belong to actuators by name, so that a rig
/// that gets other actuators takes nothing from them: what it has is moved, what it has not is kept.
struct PoseBook {
    std::vector<std::string> actuators; ///< whose strokes the poses hold, in this order
    PoseSequence sequence;
    bool operator==(const PoseBook&) const = default;
};

/// Throws InvalidInput as requireSound does, and for actuators without a name, with the same, or too many.
void requireSound(const PoseBook& book);

/// The sequence for a rig of these actuators, in their order. Those that the book does not know stay at rest.
[[nodiscard]] PoseSequence sequenceFor(const PoseBook& book, std::span<const std::string> actuators);

/// How the book fits a rig.
struct PoseFit {
    std::vector<std::string> atRest; ///< of the rig; the poses know nothing of them
    std::vector<std::string> kept;   ///< of the poses; the rig does not have them
};
[[nodiscard]] PoseFit fitOf(const PoseBook& book, std::span<const std::string> actuators);

/// A name that no pose has: `wish`, or "wish 2" and so on.
[[nodiscard]] std::string freePoseName(const PoseBook& book, const std::string& wish);

/// Adds a pose of a rig of these actuators, or replaces the strokes of the one that is called so. Of actuators that the
/// rig does not have a new pose holds rest, and an old one what it held.
void keepPose(PoseBook& book, const std::string& name, std::span<const std::string> actuators,
              std::span<const double> strokes);
/// Throws InvalidInput where another pose is called so, or the name is empty or too long. Steps go along.
void renamePose(PoseBook& book, std::string_view name, const std::string& to);
/// With the steps that lead to it.
void removePose(PoseBook& book, std::string_view name);
/// Actuators whose names alone changed, place by place, keep their strokes.
void followRenames(PoseBook& book, std::span<const std::string> before, std::span<const std::string> after);

} // namespace lumorph
