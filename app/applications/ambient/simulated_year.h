#pragma once

#include <cstdint>
#include <vector>

#include "app/applications/ambient/place.h"
#include "app/applications/ambient/weather.h"

namespace lumorph::ambient {

/// A year of weather as it might be at a place of temperate climate, hour by hour from local midnight of January 1st,
/// 2026, which repeats: seasons of its hemisphere, daily courses, fronts that pass with wind, rain and snow, thunder in
/// warm ones, and fog on calm mornings. The same seed gives the same year.
[[nodiscard]] Weather simulatedYear(const Place& place, std::uint64_t seed);

/// Local midnights of the days that a visitor should see: of a year those that are most fair, stormy, foggy, snowy and
/// rainy, in that order; of up to sixteen days all.
[[nodiscard]] std::vector<double> notableDays(const Weather& weather, const Place& place);

} // namespace lumorph::ambient
