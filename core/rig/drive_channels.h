#pragma once

#include <vector>

#include "core/rig/rig.h"

namespace lumorph {

/// Where the servo of each actuator is connected to a board whose numbers begin at `first`. Rigs count their channels
/// from 0: where one lies below `first`, all are shifted so that the least is `first`; else they stay as the rig tells
/// them. A channel that the rig does not tell is the least free one. One number an actuator; a rig that tells a number
/// twice has it twice here.
[[nodiscard]] std::vector<int> boardChannels(const Rig& rig, int first);

} // namespace lumorph
