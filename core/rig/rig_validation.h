#pragma once

#include "core/rig/rig.h"

namespace lumorph {

/// Throws InvalidInput naming the actuator and the remedy unless the parts fit together.
void validate(const RigParts& parts);

inline constexpr std::size_t kMaxActuators = 65'000;

} // namespace lumorph
