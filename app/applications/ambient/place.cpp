#include "app/applications/ambient/place.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/error.h"

namespace lumorph::ambient {
namespace {

constexpr double kDay = 86'400.0;
constexpr double kHour = 3600.0;
constexpr double kMostHours = 14.0; ///< that any clock is ahead of UTC or behind
constexpr const char* kPlaceRemedy = "write LAT,LON or LAT,LON,HOURS, such as 52.52,13.41,1";

/// `count` becomes the number of fields; at most three are read.
std::array<double, 3> numbersOf(std::string_view text, std::size_t& count) {
    std::array<double, 3> numbers{};
    const InvalidInput wrong("place '" + std::string(text.substr(0, 80)) + "'", "is no place", kPlaceRemedy);
    for (count = 0; count < numbers.size(); ++count) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), numbers[count]);
        if (error != std::errc()) throw wrong;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty()) {
            ++count;
            break;
        }
        if (text.front() != ',' || count + 1 == numbers.size()) throw wrong;
        text.remove_prefix(1);
    }
    if (count < 2) throw wrong;
    return numbers;
}

void requireWithin(const char* what, double value, double most) {
    if (std::abs(value) <= most) return; // NaN is not
    throw InvalidInput(std::string(what) + " of the place",
                       "is not a number from " + std::to_string(-most) + " to " + std::to_string(most), kPlaceRemedy);
}

} // namespace

void checkPlace(const Place& place) {
    requireWithin("latitude", place.latitude, 90.0);
    requireWithin("longitude", place.longitude, 180.0);
    requireWithin("seconds ahead of UTC", place.utcOffset, kMostHours * kHour);
}

Place placeFrom(std::string_view text) {
    std::size_t count = 0;
    const auto [latitude, longitude, hours] = numbersOf(text, count);
    Place place{latitude, longitude, kHour * (count == 3 ? hours : std::round(longitude / 15.0))};
    checkPlace(place);
    return place;
}

std::optional<double> timeFrom(const std::string& text, double utcOffset) {
    int year = 0, used = 0;
    unsigned month = 0, day = 0, hour = 0, minute = 0;
    if (std::sscanf(text.c_str(), "%4d-%2u-%2uT%2u:%2u%n", &year, &month, &day, &hour, &minute, &used) != 5) return {};
    const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
    if (static_cast<std::size_t>(used) != text.size() || !date.ok() || hour > 23 || minute > 59) return {};
    const auto days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
    return kDay * days + kHour * hour + 60.0 * minute - utcOffset;
}

double offsetAt(const Place& place, double utc) noexcept {
    return place.zone ? place.zone->offsetAt(utc) : place.utcOffset;
}

double utcOf(const Place& place, double local) noexcept {
    // No zone changes its clocks twice in two days.
    const double before = offsetAt(place, local - kDay), after = offsetAt(place, local + kDay);
    for (const double offset : {before, after})
        if (offsetAt(place, local - offset) == offset) return local - offset;
    return local - before;
}

double localMidnight(const Place& place, double utc) noexcept {
    return utcOf(place, kDay * std::floor((utc + offsetAt(place, utc)) / kDay));
}

double localHour(const Place& place, double utc) noexcept {
    const double local = utc + offsetAt(place, utc);
    return (local - kDay * std::floor(local / kDay)) / kHour;
}

glm::dvec2 onDevice(const Place& place, double bearing) noexcept {
    const double side = place.latitude >= 0.0 ? 1.0 : -1.0;
    return {-side * std::sin(bearing), side * std::cos(bearing)};
}

} // namespace lumorph::ambient
