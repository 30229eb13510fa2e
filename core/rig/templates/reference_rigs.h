#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What a device's shape resolution is compared with: a phone-sized one with four corners, the paper's tablet and a
/// pin display of 30 x 30, by these names ("phone", "tablet", "pins").
[[nodiscard]] std::vector<Rig> referenceRigs(const Progress& progress = {});

} // namespace lumorph
