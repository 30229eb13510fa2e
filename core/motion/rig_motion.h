#pragma once

#include "core/motion/motion.h"
#include "core/rig/rig.h"

namespace lumorph {

/// Limits of a rig's actuators, in its order.
[[nodiscard]] std::vector<MotionLimits> motionLimits(const Rig& rig);

} // namespace lumorph
