#pragma once

#include <cstdint>
#include <vector>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/valley_plan.h"

namespace lumorph::navigation {

/// The hamlets of the valley.
[[nodiscard]] std::vector<Place> hamletsOf(const ValleyPlan& plan);

/// Puts what people have made into the valley: a harbour town with its church, hamlets, roads, bridges, fields, a
/// castle, jetties and boats, and their names. The ground is there already.
void settle(Map& map, const ValleyPlan& plan, std::uint64_t seed);

} // namespace lumorph::navigation
