#pragma once

#include "app/applications/ambient/scenery.h"
#include "core/loop/show_caption.h"

namespace lumorph::ambient {

/// Day, hour, weather and what is to come, for who wants to read it: the tablet itself says it without a word. Times
/// are rounded down to `quantum` seconds.
[[nodiscard]] ShowCaption captionOf(const View& view, double quantum, double forecastAge = 0.0);

} // namespace lumorph::ambient
