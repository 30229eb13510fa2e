#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "app/applications/ambient/place.h"
#include "app/applications/ambient/weather.h"

namespace lumorph::ambient {

/// Weather and the place it is of, where its source names one.
struct Forecast {
    Weather weather;
    std::optional<Place> place;
};

/// Reads a forecast in Open-Meteo's JSON (open-meteo.com/en/docs): `hourly` with `time`, `temperature_2m`,
/// `precipitation`, `cloud_cover`, `wind_speed_10m` and `wind_direction_10m`, and where it has them `snowfall`,
/// `visibility` and `weather_code`, each a list as long as `time`, hour after hour; `hourly_units` says in which of the
/// service's units. Hours at the beginning and the end of which something that has to be is null are left out, others
/// between two that are known are filled in. `name` stands in errors. Throws DataError naming the key and the remedy
/// for all that is not so and for numbers out of range, and with the service's own reason for an answer that is an
/// error.
[[nodiscard]] Forecast readForecast(std::string_view text, const std::string& name);
[[nodiscard]] Forecast readForecastFile(const std::filesystem::path& file);

} // namespace lumorph::ambient
