#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// The plane across the middle of the rest mesh (x, or z) on whose other side an actuator is to stand.
enum class MirrorPlane { acrossX, acrossZ };

struct MirroredActuator {
    RigParts parts;
    std::size_t actuator = 0; ///< the one that now stands on the other side
    bool added = false;       ///< false: it was there before, and moves as the first one does now
};

/// A rig with the mirror image of one of its actuators. Where another actuator moves just the mirrored vertices, that
/// one takes over deformer, range, weights and velocity; else a new one, without a channel, is added at the end. Each
/// vertex's image is the vertex within 0.5 mm of the mirrored place. Throws InvalidInput naming the actuator where the
/// mesh has no such vertices, where the image is the actuator itself, for joints of a skin, and for parts that are no
/// rig.
[[nodiscard]] MirroredActuator mirroredActuator(const RigParts& parts, std::size_t actuator, MirrorPlane plane);

/// The plane across which an actuator's part lies farther from the middle.
[[nodiscard]] MirrorPlane mirrorPlaneOf(const RigParts& parts, std::size_t actuator);

struct ActuatorCopies {
    RigParts parts;
    std::vector<std::size_t> actuators; ///< the copies, in the order of their places
    int added = 0;                      ///< of them; the others were there before
};

inline constexpr int kMostCopies = 200;

/// A rig in which one of its actuators stands `count` times (2 to 200, itself among them) around the upright line
/// through the middle of the rest mesh's box, at even angles. What is said of a mirror image holds for each copy.
[[nodiscard]] ActuatorCopies copiesAround(const RigParts& parts, std::size_t actuator, int count);
/// The same along a line: each copy is `step` (metres) from the one before.
[[nodiscard]] ActuatorCopies copiesAlong(const RigParts& parts, std::size_t actuator, int count, const glm::vec3& step);

} // namespace lumorph
