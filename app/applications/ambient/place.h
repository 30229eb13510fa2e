#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

namespace lumorph::ambient {

/// Where and by which clock the display tells time and weather.
struct Place {
    double latitude = 52.52;   ///< degrees, north positive
    double longitude = 13.405; ///< degrees, east positive
    double utcOffset = 3600.0; ///< seconds by which its clocks are ahead of UTC
    bool operator==(const Place&) const = default;
};

/// "LAT,LON" or "LAT,LON,HOURS" in degrees and hours ahead of UTC; without hours those of the longitude. Throws
/// InvalidInput for another form and for numbers out of range.
[[nodiscard]] Place placeFrom(std::string_view text);

/// Throws InvalidInput for numbers that are not finite or out of range.
void checkPlace(const Place& place);

/// Times are seconds since 1970-01-01 00:00 UTC, without leap seconds.
/// The hour that clocks show, in [0, 24).
[[nodiscard]] double localHour(const Place& place, double utc) noexcept;
/// When the day of a time began.
[[nodiscard]] double localMidnight(const Place& place, double utc) noexcept;

/// A local time as 2026-05-17T14:00 in seconds since 1970 UTC; nothing for another form.
[[nodiscard]] std::optional<double> timeFrom(const std::string& text, double utcOffset);

/// A compass bearing (radians, clockwise from north) as a direction in x and z of the device: whoever stands before it
/// looks towards the noon sun, as through a window: south in the north, and north in the south.
[[nodiscard]] glm::dvec2 onDevice(const Place& place, double bearing) noexcept;

} // namespace lumorph::ambient
