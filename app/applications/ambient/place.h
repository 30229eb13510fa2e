#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "app/applications/ambient/time_zone.h"

namespace lumorph::ambient {

/// Where and by which clock the display tells time and weather.
struct Place {
    double latitude = 52.52;                   ///< degrees, north positive
    double longitude = 13.405;                 ///< degrees, east positive
    double utcOffset = 3600.0;                 ///< seconds by which its clocks are ahead of UTC, where no zone says it
    std::shared_ptr<const TimeZone> zone = {}; ///< whose clocks it has; null: they never change
    /// The zone follows from where it is.
    bool operator==(const Place& other) const {
        return latitude == other.latitude && longitude == other.longitude && utcOffset == other.utcOffset;
    }
};

/// "LAT,LON" or "LAT,LON,HOURS" in degrees and hours ahead of UTC; without hours those of the longitude. Throws
/// InvalidInput for another form and for numbers out of range.
[[nodiscard]] Place placeFrom(std::string_view text);

/// Throws InvalidInput for numbers that are not finite or out of range.
void checkPlace(const Place& place);

/// Times are seconds since 1970-01-01 00:00 UTC, without leap seconds.
/// Seconds by which the clocks are ahead of UTC at a time.
[[nodiscard]] double offsetAt(const Place& place, double utc) noexcept;
/// When the clocks show a local time, seconds since 1970 as if it were UTC: the first time where they show it twice;
/// where they never do, as if they had not changed.
[[nodiscard]] double utcOf(const Place& place, double local) noexcept;
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
