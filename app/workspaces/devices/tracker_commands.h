#pragma once

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Commands around trackers: simulated bodies, a board by camera and its page to print, axes in the views.
void addTrackerCommands(Studio& studio);

} // namespace lumorph::studio
