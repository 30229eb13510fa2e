#pragma once

#include <cstdint>

#include "app/applications/navigation/map.h"
#include "core/base/progress.h"

namespace lumorph::navigation {

/// The bundled map: a valley eight kilometres wide that nobody has drawn. Mountains that rivers have worn, a river that
/// runs into a lake and leaves it, woods and meadows, a harbour town of some six hundred houses, hamlets, a castle.
/// From every sample water runs downhill to the river or the lake. The same seed gives the same valley. Takes about a
/// second. Throws Cancelled.
[[nodiscard]] Map bundledValley(std::uint64_t seed = 29, const Progress& progress = {});

} // namespace lumorph::navigation
