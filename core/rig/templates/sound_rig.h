#pragma once

#include "core/base/progress.h"
#include "core/rig/rig.h"

namespace lumorph {

/// Looks a rig over in a few joint states, at rest and with all actuators moved. Throws InvalidInput naming the
/// actuator in whose way something stands, unless the mesh is a closed solid there that does not cross itself;
/// Cancelled.
void requireSound(const Rig& rig, const Progress& progress = {});

} // namespace lumorph
