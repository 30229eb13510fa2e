#include "app/applications/ambient/simulated_year.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace lumorph::ambient {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kHoursOfYear = 8760;
constexpr double kBeginOf2026 = 1'767'225'600.0; ///< January 1st, 00:00 UTC
constexpr double kAnHour = 3600.0;
constexpr double kTopOfSummer = 200.0; ///< day of the year, in the north

/// Chance that is the same with every library.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    [[nodiscard]] double share() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    [[nodiscard]] double normal() { return std::sqrt(-2.0 * std::log(1.0 - share())) * std::cos(2.0 * kPi * share()); }

private:
    std::mt19937_64 engine_;
};

/// A series of standard deviation 1 that forgets itself within so many hours.
std::vector<double> wander(Dice& dice, double hours) {
    const double keeps = std::exp(-1.0 / hours);
    const double adds = std::sqrt(1.0 - keeps * keeps);
    std::vector<double> series(kHoursOfYear);
    double value = dice.normal();
    for (double& next : series) next = value = keeps * value + adds * dice.normal();
    return series;
}

/// What passes with fronts, 0 to 1, and which way the wind has turned by them.
struct Fronts {
    std::vector<double> force, turn;
};
Fronts passFronts(Dice& dice) {
    Fronts fronts{std::vector<double>(kHoursOfYear, 0.0), std::vector<double>(kHoursOfYear, 0.0)};
    constexpr double kPause = 58.0; // hours between two, in the mean, after the shortest
    for (double middle = 20.0; middle < kHoursOfYear; middle += 22.0 - kPause * std::log(1.0 - dice.share())) {
        const double strength = 0.3 + 0.7 * dice.share();
        const double hours = 2.5 + 5.0 * dice.share();
        for (int k = 0; k < kHoursOfYear; ++k) {
            const double after = (k - middle) / hours;
            if (std::abs(after) > 6.0) continue;
            const auto at = static_cast<std::size_t>(k);
            fronts.force[at] = std::max(fronts.force[at], strength * std::exp(-0.5 * after * after));
            fronts.turn[at] += 0.9 * strength * std::tanh(after) * std::exp(-0.1 * after * after);
        }
    }
    return fronts;
}

struct Season {
    double warmth;    ///< -1 in the depth of winter to 1 at the top of summer
    double day;       ///< -1 at night's coldest to 1 in the afternoon
    double localTime; ///< hours
};
Season seasonOf(const Place& place, int hour) {
    const double side = place.latitude >= 0.0 ? 1.0 : -1.0;
    const double localTime = hour % 24;
    return {side * std::cos(2.0 * kPi * (hour / 24.0 - kTopOfSummer) / 365.0),
            std::cos(2.0 * kPi * (localTime - 15.0) / 24.0), localTime};
}

double meanTemperature(const Place& place, const Season& season) {
    const double far = std::min(std::abs(place.latitude), 70.0);
    return 27.0 - 0.34 * far + (0.19 * far) * season.warmth;
}

struct Moods {
    std::vector<double> warm, windy, veering, cloudy, damp; ///< each of standard deviation 1
};

void addPrecipitation(WeatherHour& hour, double force, const Season& season) {
    const double wet = std::max(force - 0.38, 0.0) / 0.62;
    const double most = 4.0 + 5.0 * std::max(season.warmth, 0.0);
    (hour.temperature < 0.6 ? hour.snow : hour.rain) = most * wet * std::sqrt(wet);
    if (hour.snow > 0.0) hour.snow = std::min(0.7 * hour.snow, 4.0);
    const bool sultry = hour.temperature > 13.0 || (force > 0.93 && hour.temperature > 5.0);
    hour.thunder = force > 0.72 && sultry ? std::min(1.0, (force - 0.72) / 0.08) : 0.0;
    if (hour.thunder > 0.0) hour.windSpeed += 3.5 * hour.thunder;
}

void addFog(WeatherHour& hour, double damp, double force, const Season& season) {
    constexpr double kClear = 24e3;
    hour.visibility = kClear / (1.0 + 0.6 * hour.rain + 2.5 * hour.snow);
    // It comes after midnight, and the sun takes it by noon.
    const double night =
        std::clamp(std::min((season.localTime - 1.0) / 3.0, (11.5 - season.localTime) / 2.0), 0.0, 1.0);
    const double calm = std::clamp((5.2 - hour.windSpeed) / 2.5, 0.0, 1.0);
    const double humid = std::clamp((damp - 0.35 + 0.35 * (1.0 - std::abs(season.warmth))) / 0.5, 0.0, 1.0);
    const double fog = night * calm * humid * std::clamp(1.0 - 4.0 * force, 0.0, 1.0);
    hour.visibility = std::min(hour.visibility, kClear * std::pow(0.008, fog));
}

WeatherHour hourOf(const Place& place, int number, const Moods& moods, const Fronts& fronts) {
    const auto k = static_cast<std::size_t>(number);
    const Season season = seasonOf(place, number);
    const double force = fronts.force[k];
    WeatherHour hour;
    hour.cloudCover = std::clamp(0.28 + 0.26 * moods.cloudy[k] + 1.3 * force - 0.10 * season.warmth, 0.0, 1.0);
    hour.temperature = meanTemperature(place, season) + 3.2 * moods.warm[k] - 3.0 * force +
                       (2.0 + 2.4 * (0.5 + 0.5 * season.warmth)) * (1.0 - 0.6 * hour.cloudCover) * season.day;
    const double breeze = 2.6 + 1.1 * moods.windy[k] + 0.9 * (1.0 - hour.cloudCover) * std::max(season.day, 0.0);
    hour.windSpeed = std::max(0.4, breeze - 0.4 * season.warmth) + 11.5 * force * force;
    hour.windFrom = 1.35 * kPi + 0.9 * moods.veering[k] + fronts.turn[k]; // mostly from the west
    if (place.latitude < 0.0) hour.windFrom = kPi - hour.windFrom;
    addPrecipitation(hour, force, season);
    addFog(hour, moods.damp[k], force, season);
    return hour;
}

/// Sums over one day that say what it is notable for.
struct DaySums {
    double fair = 0.0, storm = 0.0, fog = 0.0, snow = 0.0, rain = 0.0;
};
DaySums sumsOf(const Weather& weather, double midnight) {
    DaySums sums;
    for (int h = 0; h < 24; ++h) {
        const WeatherHour hour = weather.at(midnight + h * kAnHour);
        const bool light = h >= 7 && h <= 19;
        sums.fair += (light ? 1.0 - hour.cloudCover : 0.0) + 0.02 * hour.temperature - 0.3 * hour.rain -
                     (hour.visibility < 5e3 ? 0.4 : 0.0) - 0.02 * hour.windSpeed;
        sums.storm += light && h >= 10 ? 10.0 * hour.thunder + 0.05 * hour.windSpeed : 0.0;
        sums.fog += h >= 5 && h <= 10 ? 1.0 / (300.0 + hour.visibility) : 0.0;
        sums.snow += light ? hour.snow : 0.0;
        sums.rain += light ? std::min(hour.rain, 4.0) - 5.0 * hour.thunder : 0.0;
    }
    return sums;
}

} // namespace

Weather simulatedYear(const Place& place, std::uint64_t seed) {
    Dice dice(seed);
    const Fronts fronts = passFronts(dice);
    // Each has its own memory: spells of warmth last days, gusts hours.
    Moods moods{wander(dice, 80.0), wander(dice, 10.0), wander(dice, 24.0), wander(dice, 14.0), wander(dice, 40.0)};
    std::vector<WeatherHour> hours;
    hours.reserve(kHoursOfYear);
    for (int k = 0; k < kHoursOfYear; ++k) hours.push_back(hourOf(place, k, moods, fronts));
    return {kBeginOf2026 - place.utcOffset, std::move(hours), true};
}

std::vector<double> notableDays(const Weather& weather, const Place& place) {
    constexpr double kADay = 24.0 * kAnHour;
    constexpr std::size_t kFew = 16;
    std::vector<double> days;
    // A day on which clocks change has 23 or 25 hours.
    for (double day = localMidnight(place, weather.begin()); day < weather.end();
         day = localMidnight(place, day + 1.5 * kADay))
        days.push_back(day);
    if (days.empty()) days.push_back(localMidnight(place, weather.begin()));
    if (days.size() <= kFew) return days;
    constexpr std::array<double DaySums::*, 5> kinds = {&DaySums::fair, &DaySums::storm, &DaySums::fog, &DaySums::snow,
                                                        &DaySums::rain};
    std::array<double, 5> notable{};
    std::array<double, 5> most{};
    most.fill(-1e9);
    for (const double day : days) {
        const DaySums sums = sumsOf(weather, day);
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            if (sums.*kinds[k] <= most[k]) continue;
            most[k] = sums.*kinds[k];
            notable[k] = day;
        }
    }
    return {notable.begin(), notable.end()};
}

} // namespace lumorph::ambient
