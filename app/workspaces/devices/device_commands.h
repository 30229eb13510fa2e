#pragma once

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds the commands of the Devices workspace; connect, start and slow are in the palette everywhere.
void addDeviceCommands(Studio& studio);

} // namespace lumorph::studio
