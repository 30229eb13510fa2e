#include "app/applications/ambient/weather_file.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/plain_text.h"

namespace lumorph::ambient {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr double kSecondsOfHour = 3600.0;
constexpr const char* kAskAgain =
    "ask Open-Meteo for hourly=temperature_2m,precipitation,snowfall,cloud_cover,visibility,wind_speed_10m,"
    "wind_direction_10m,weather_code";

/// What a value of a unit is in ours: value * scale + shift.
struct Unit {
    const char* name;
    double scale, shift = 0.0;
};

/// A series of the file.
struct Series {
    const char* key;
    double min, max;         ///< in our units
    std::vector<Unit> units; ///< the first is the service's own choice
    bool required = true;
};

const std::array<Series, 8>& allSeries() {
    constexpr double kInch = 25.4;
    static const std::array<Series, 8> series{{
        {"temperature_2m", -100.0, 70.0, {{"°C", 1.0}, {"°F", 5.0 / 9.0, -160.0 / 9.0}}},
        {"precipitation", 0.0, 1000.0, {{"mm", 1.0}, {"inch", kInch}}},
        {"cloud_cover", 0.0, 1.0, {{"%", 0.01}}},
        {"wind_speed_10m", 0.0, 150.0, {{"km/h", 1.0 / 3.6}, {"m/s", 1.0}, {"mp/h", 0.44704}, {"kn", 1852.0 / 3600.0}}},
        {"wind_direction_10m", 0.0, 2.0 * std::numbers::pi + 1e-9, {{"°", std::numbers::pi / 180.0}}},
        {"snowfall", 0.0, 1000.0, {{"cm", 1.0}, {"inch", 0.1 * kInch}}, false},
        {"visibility", 0.0, 1e6, {{"m", 1.0}, {"ft", 0.3048}}, false},
        {"weather_code", 0.0, 99.0, {{"wmo code", 1.0}}, false},
    }};
    return series;
}
enum SeriesIndex : std::size_t { kTemperature, kPrecipitation, kClouds, kWind, kWindFrom, kSnow, kVisibility, kCode };

/// The file with its name, for errors.
class Reader {
public:
    Reader(const json& root, std::string name) : root_(root), name_(std::move(name)) {}

    [[noreturn]] void refuse(const std::string& why, const std::string& remedy = kAskAgain) const {
        throw DataError(name_, why, remedy);
    }
    [[nodiscard]] const json& root() const { return root_; }
    [[nodiscard]] const json& section(const char* key) const {
        if (!root_.contains(key)) refuse(std::string("has no \"") + key + "\"");
        if (!root_.at(key).is_object()) refuse(std::string("\"") + key + "\" is not an object");
        return root_.at(key);
    }
    /// A list of `hourly`; null where it is missing and may be.
    [[nodiscard]] const json* list(const char* key, bool required) const {
        const json& hourly = section("hourly");
        if (!hourly.contains(key)) {
            if (required) refuse(std::string("has no hourly.") + key);
            return nullptr;
        }
        if (!hourly.at(key).is_array()) refuse(std::string("hourly.") + key + " is not a list");
        return &hourly.at(key);
    }
    [[nodiscard]] std::string unitOf(const char* key, const char* usual) const {
        if (!root_.contains("hourly_units")) return usual;
        const json& units = section("hourly_units");
        if (!units.contains(key)) return usual;
        if (!units.at(key).is_string()) refuse(std::string("hourly_units.") + key + " is not a text");
        return units.at(key).get<std::string>();
    }
    /// A number at the top; `otherwise` where it is missing.
    [[nodiscard]] double number(const char* key, double otherwise, double most) const {
        if (!root_.contains(key)) return otherwise;
        const json& value = root_.at(key);
        if (!value.is_number() || std::abs(value.get<double>()) > most)
            refuse(std::string("\"") + key + "\" is not a number from " + std::to_string(-most) + " to " +
                   std::to_string(most));
        return value.get<double>();
    }

private:
    const json& root_;
    std::string name_;
};

std::string placeOf(const char* key, std::size_t k) {
    return std::string("hourly.") + key + "[" + std::to_string(k) + "]";
}

/// When the first hour is, UTC; the others follow one after another.
double beginOf(const Reader& reader, const json& times, double utcOffset) {
    if (times.empty()) reader.refuse("hourly.time is empty");
    if (times.size() > Weather::kMostHours) reader.refuse("has too many hours", "ask for fewer days");
    const bool unix = reader.unitOf("time", "iso8601") == "unixtime";
    const auto at = [&](std::size_t k) {
        if (!unix) {
            const std::string text = times[k].is_string() ? times[k].get<std::string>() : std::string();
            const std::optional<double> time = timeFrom(text, utcOffset);
            if (!time) reader.refuse(placeOf("time", k) + " is no time", "write it as 2026-05-17T14:00");
            return *time;
        }
        if (!times[k].is_number() || std::abs(times[k].get<double>()) > 1e11)
            reader.refuse(placeOf("time", k) + " is no time", "write seconds since 1970");
        return times[k].get<double>();
    };
    const double begin = at(0);
    for (std::size_t k = 1; k < times.size(); ++k)
        if (at(k) != begin + kSecondsOfHour * static_cast<double>(k))
            reader.refuse(placeOf("time", k) + " does not come an hour after the one before", "give every hour once");
    return begin;
}

const Unit& unitOf(const Reader& reader, const Series& series) {
    const std::string name = reader.unitOf(series.key, series.units.front().name);
    std::string known;
    for (const Unit& unit : series.units) {
        if (name == unit.name) return unit;
        known += (known.empty() ? "" : ", ") + std::string(unit.name);
    }
    reader.refuse(std::string("hourly_units.") + series.key + " is \"" + name.substr(0, 40) + "\"", "use " + known);
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// In our units, kUnknown for null; empty where the file has none and need not.
std::vector<double> valuesOf(const Reader& reader, const Series& series, std::size_t count) {
    const json* list = reader.list(series.key, series.required);
    if (!list) return {};
    if (list->size() != count)
        reader.refuse(std::string("hourly.") + series.key + " has " + std::to_string(list->size()) +
                          " values, and hourly.time " + std::to_string(count),
                      "give as many of each");
    const Unit& unit = unitOf(reader, series);
    std::vector<double> values;
    for (const json& value : *list) {
        const std::string place = placeOf(series.key, values.size());
        if (value.is_null()) {
            values.push_back(kUnknown);
            continue;
        }
        if (!value.is_number()) reader.refuse(place + " is not a number");
        const double number = value.get<double>() * unit.scale + unit.shift;
        if (!(number >= series.min && number <= series.max))
            reader.refuse(place + " is " + value.dump() + ", out of range", "correct it, or its unit in hourly_units");
        values.push_back(number);
    }
    return values;
}

/// WMO code table 4677, as the service uses it.
bool isFog(double code) { return code == 45.0 || code == 48.0; }
bool isThunder(double code) { return code >= 95.0; }

using AllValues = std::array<std::vector<double>, 8>;

bool isKnown(const AllValues& values, std::size_t hour) {
    for (std::size_t s = 0; s < values.size(); ++s)
        if (allSeries()[s].required && std::isnan(values[s][hour])) return false;
    return true;
}

/// From one known hour to the next each value changes evenly, the wind by the shorter way; both ends are known.
void fillGaps(std::vector<double>& values, bool turns) {
    for (std::size_t k = 1; k < values.size(); ++k) {
        if (!std::isnan(values[k])) continue;
        std::size_t next = k;
        while (std::isnan(values[next])) ++next;
        const double from = values[k - 1];
        const double way = turns ? std::remainder(values[next] - from, 2.0 * std::numbers::pi) : values[next] - from;
        for (std::size_t i = k; i < next; ++i)
            values[i] = from + way * static_cast<double>(i - k + 1) / static_cast<double>(next - k + 1);
    }
}

/// The hours of which all is known that has to be, and those between them; `begin` becomes that of the first. The end
/// of a forecast reaches beyond what some of its models know.
std::size_t cutToKnown(const Reader& reader, AllValues& values, double& begin) {
    const std::size_t count = values[kTemperature].size();
    std::size_t first = 0, end = count;
    while (first < count && !isKnown(values, first)) ++first;
    if (first == count)
        reader.refuse("has no hour of which temperature, precipitation, clouds and wind are all known",
                      "ask for hours that are known");
    while (!isKnown(values, end - 1)) --end;
    begin += kSecondsOfHour * static_cast<double>(first);
    for (std::size_t s = 0; s < values.size(); ++s) {
        if (values[s].empty()) continue;
        values[s] = {values[s].begin() + static_cast<std::ptrdiff_t>(first),
                     values[s].begin() + static_cast<std::ptrdiff_t>(end)};
        if (allSeries()[s].required) fillGaps(values[s], s == kWindFrom);
    }
    return end - first;
}

/// `otherwise` where the file has none, or none for this hour.
double valueOr(const std::vector<double>& values, std::size_t hour, double otherwise) {
    return values.empty() || std::isnan(values[hour]) ? otherwise : values[hour];
}

/// `begin` becomes the time of the first that is known.
std::vector<WeatherHour> hoursOf(const Reader& reader, std::size_t all, double& begin) {
    AllValues values;
    for (std::size_t s = 0; s < values.size(); ++s) values[s] = valuesOf(reader, allSeries()[s], all);
    const std::size_t count = cutToKnown(reader, values, begin);
    std::vector<WeatherHour> hours(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double code = valueOr(values[kCode], k, 0.0);
        WeatherHour& hour = hours[k];
        hour.temperature = values[kTemperature][k];
        hour.cloudCover = values[kClouds][k];
        hour.windSpeed = values[kWind][k];
        hour.windFrom = values[kWindFrom][k];
        hour.snow = valueOr(values[kSnow], k, 0.0);
        // Precipitation holds melted snow: 7 cm of snow are 10 mm of water, says the service.
        hour.rain = std::max(0.0, values[kPrecipitation][k] - hour.snow / 0.7);
        if (hour.rain < 0.1 && hour.snow > 0.0) hour.rain = 0.0;
        hour.visibility = valueOr(values[kVisibility], k, isFog(code) ? 300.0 : 24e3);
        hour.thunder = isThunder(code) ? 1.0 : 0.0;
    }
    return hours;
}

/// Times are written with the offset of the day on which the forecast was asked for, also where clocks change in it;
/// the zone says what they show.
std::shared_ptr<const TimeZone> zoneOf(const json& root) {
    const bool named = root.contains("timezone") && root.at("timezone").is_string();
    return named ? zoneNamed(root.at("timezone").get<std::string>()) : nullptr;
}

} // namespace

Forecast readForecast(std::string_view text, const std::string& name) {
    if (text.size() > kMostBytes) throw DataError(name, "is larger than 16 MiB", "ask for fewer days");
    if (const std::string problem = jsonProblem(text); !problem.empty()) throw DataError(name, problem, kAskAgain);
    const json root = json::parse(text, nullptr, false);
    const Reader reader(root, name);
    if (!root.is_object()) reader.refuse("is not a JSON object");
    if (root.contains("error")) {
        const bool says = root.contains("reason") && root.at("reason").is_string();
        reader.refuse("is an error of the service: " +
                      (says ? root.at("reason").get<std::string>().substr(0, 300) : std::string("no reason given")));
    }
    const double offset = reader.number("utc_offset_seconds", 0.0, 14.0 * kSecondsOfHour);
    const json& times = *reader.list("time", true);
    double begin = beginOf(reader, times, offset);
    std::vector<WeatherHour> hours = hoursOf(reader, times.size(), begin);
    Forecast forecast{Weather(begin, std::move(hours)), {}};
    if (root.contains("latitude") && root.contains("longitude"))
        forecast.place =
            Place{reader.number("latitude", 0.0, 90.0), reader.number("longitude", 0.0, 180.0), offset, zoneOf(root)};
    return forecast;
}

Forecast readForecastFile(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMostBytes);
    const PlainText text(bytes);
    return readForecast(text.view(), file.string());
}

} // namespace lumorph::ambient
