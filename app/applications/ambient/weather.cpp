#include "app/applications/ambient/weather.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"

namespace lumorph::ambient {
namespace {

constexpr double kSecondsAnHour = 3600.0;
constexpr double kMeltsADegree = 0.12; ///< cm of snow an hour for each degree over zero

struct Bound {
    const char* name;
    double WeatherHour::*value;
    double min, max;
};
constexpr Bound kBounds[] = {
    {"temperature", &WeatherHour::temperature, -100.0, 70.0},
    {"wind speed", &WeatherHour::windSpeed, 0.0, 150.0},
    {"wind direction", &WeatherHour::windFrom, -100.0, 100.0},
    {"rain", &WeatherHour::rain, 0.0, 1000.0},
    {"snow", &WeatherHour::snow, 0.0, 1000.0},
    {"cloud cover", &WeatherHour::cloudCover, 0.0, 1.0},
    {"visibility", &WeatherHour::visibility, 0.0, 1e6},
    {"thunder", &WeatherHour::thunder, 0.0, 1.0},
};

void checkHour(const WeatherHour& hour, std::size_t number) {
    for (const Bound& bound : kBounds) {
        const double value = hour.*bound.value;
        if (value >= bound.min && value <= bound.max) continue;
        throw InvalidInput("weather, hour " + std::to_string(number + 1),
                           std::string(bound.name) + " is " + std::to_string(value), "correct it");
    }
}

/// From the first hour on; for weather that repeats it goes around twice, so that the winter before counts.
std::vector<double> lyingOf(const std::vector<WeatherHour>& hours, bool repeats) {
    std::vector<double> lying(hours.size(), 0.0);
    double depth = 0.0;
    for (int round = 0; round < (repeats ? 2 : 1); ++round) {
        for (std::size_t k = 0; k < hours.size(); ++k) {
            depth += hours[k].snow - kMeltsADegree * std::max(hours[k].temperature, 0.0) - 0.02 * hours[k].rain;
            depth = std::max(depth, 0.0);
            lying[k] = depth;
        }
    }
    return lying;
}

double turnBetween(double from, double to, double share) {
    return from + share * std::remainder(to - from, 2.0 * std::numbers::pi);
}

} // namespace

Weather::Weather(double begin, std::vector<WeatherHour> hours, bool repeats)
    : begin_(begin), hours_(std::move(hours)), repeats_(repeats) {
    if (!std::isfinite(begin)) throw InvalidInput("weather", "has no beginning", "say when its first hour is");
    if (hours_.empty() || hours_.size() > kMostHours)
        throw InvalidInput("weather", "has " + std::to_string(hours_.size()) + " hours",
                           "give 1 to " + std::to_string(kMostHours));
    for (std::size_t k = 0; k < hours_.size(); ++k) checkHour(hours_[k], k);
    lying_ = lyingOf(hours_, repeats_);
}

double Weather::end() const noexcept { return begin_ + kSecondsAnHour * static_cast<double>(hours_.size() - 1); }

Weather::Between Weather::between(double utc) const noexcept {
    const auto count = static_cast<double>(hours_.size());
    double hour = std::isfinite(utc) ? (utc - begin_) / kSecondsAnHour : 0.0;
    hour = repeats_ ? hour - count * std::floor(hour / count) : std::clamp(hour, 0.0, count - 1.0);
    const auto first = std::min(static_cast<std::size_t>(hour), hours_.size() - 1);
    const std::size_t second = first + 1 < hours_.size() ? first + 1 : repeats_ ? 0 : first;
    return {first, second, hour - static_cast<double>(first)};
}

WeatherHour Weather::at(double utc) const noexcept {
    const auto [first, second, share] = between(utc);
    const WeatherHour &a = hours_[first], &b = hours_[second];
    WeatherHour now;
    for (const Bound& bound : kBounds) now.*bound.value = std::lerp(a.*bound.value, b.*bound.value, share);
    now.windFrom = turnBetween(a.windFrom, b.windFrom, share);
    // Fog thickens by shares, not by metres.
    now.visibility = std::exp(std::lerp(std::log1p(a.visibility), std::log1p(b.visibility), share)) - 1.0;
    return now;
}

double Weather::snowLying(double utc) const noexcept {
    const auto [first, second, share] = between(utc);
    return std::lerp(lying_[first], lying_[second], share);
}

} // namespace lumorph::ambient
