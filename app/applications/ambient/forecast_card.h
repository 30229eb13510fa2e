#pragma once

#include "app/applications/ambient/weather.h"
#include "core/base/image.h"

namespace lumorph {
class Font;
}

namespace lumorph::ambient {

/// What a glance at the sky of some hours says; the worst of it.
enum class WeatherSign { sun, moon, sunAndCloud, moonAndCloud, cloud, fog, rain, snow, thunder };

[[nodiscard]] WeatherSign signOf(const WeatherHour& weather, bool day) noexcept;

/// What a card of the forecast says.
struct ForecastCard {
    WeatherSign sign = WeatherSign::sun;
    int hour = 0;    ///< of the clock, 0 to 23
    int degrees = 0; ///< Celsius
    bool operator==(const ForecastCard&) const = default;
};

inline constexpr glm::ivec2 kCardPixels{160, 208};

/// Light on a dark plate with round corners: the hour, the sign, the degrees.
[[nodiscard]] Image pictureOf(const ForecastCard& card, const Font& font);

} // namespace lumorph::ambient
