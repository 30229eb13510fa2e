#pragma once

#include <string>

#include "app/applications/navigation/map_import.h"
#include "core/loop/show_caption.h"

namespace lumorph::navigation {

/// What was read of a map of one's own, for who brought it: how much of what, and what could not be taken as it is. Its
/// notes are as the report has them; of many the first ones.
[[nodiscard]] ShowCaption importCaption(const MapReport& report, const std::string& name);

} // namespace lumorph::navigation
