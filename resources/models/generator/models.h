#pragma once

#include "core/rig/rig.h"

namespace lumorph {

/// The tablet of the paper (R1): 21 x 15 x 2 cm, a flexible sheet on a fixed housing. Six actuators
/// bend its four corners and the middles of its long edges upwards by up to 90 degrees.
[[nodiscard]] Rig tabletRig();

/// A display of 30 x 30 square pins that slide 10 cm out of a base plate.
[[nodiscard]] Rig pinDisplayRig();

/// A strip of four links: a skin whose three joints curl it upwards.
[[nodiscard]] Rig ribbonRig();

/// A slab whose top swells in three places: morph targets.
[[nodiscard]] Rig hillsRig();

} // namespace lumorph
