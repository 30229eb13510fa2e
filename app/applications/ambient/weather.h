#pragma once

#include <vector>

namespace lumorph::ambient {

/// The weather at one time.
struct WeatherHour {
    double temperature = 15.0; ///< degrees Celsius
    double windSpeed = 3.0;    ///< metres a second, 10 m over the ground
    double windFrom = 0.0;     ///< bearing from which it blows, radians clockwise from north
    double rain = 0.0;         ///< mm an hour
    double snow = 0.0;         ///< fresh snow, cm an hour
    double cloudCover = 0.2;   ///< share of the sky
    double visibility = 24e3;  ///< metres
    double thunder = 0.0;      ///< 1: a thunderstorm, 0: none
    bool operator==(const WeatherHour&) const = default;
};

/// Some hours of weather, one after another: a plain value.
class Weather {
public:
    /// The first hour's time, seconds since 1970 UTC. One that repeats begins anew after its end; another goes on with
    /// its last hour, and began with its first. Throws InvalidInput for no hours, more than kMostHours, and values that
    /// are not finite or out of range, naming the hour.
    Weather(double begin, std::vector<WeatherHour> hours, bool repeats = false);
    static constexpr std::size_t kMostHours = 200'000;

    /// Between two hours it changes evenly, the wind by the shorter way around.
    [[nodiscard]] WeatherHour at(double utc) const noexcept;
    /// How much snow lies, cm: what has fallen since the first hour, less what has melted.
    [[nodiscard]] double snowLying(double utc) const noexcept;

    [[nodiscard]] double begin() const noexcept { return begin_; }
    [[nodiscard]] double end() const noexcept; ///< of its last hour
    [[nodiscard]] const std::vector<WeatherHour>& hours() const noexcept { return hours_; }
    bool operator==(const Weather&) const = default;

private:
    /// Two hours and the share of the second.
    struct Between {
        std::size_t first, second;
        double share;
    };
    [[nodiscard]] Between between(double utc) const noexcept;

    double begin_;
    std::vector<WeatherHour> hours_;
    bool repeats_;
    std::vector<double> lying_; ///< cm, one an hour
};

} // namespace lumorph::ambient
