#pragma once

#include <cstddef>
#include <string>

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

} // namespace lumorph
