#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/applications/ambient/simulated_year.h"
#include "app/applications/ambient/time_zone.h"
#include "app/applications/ambient/weather.h"
#include "app/applications/ambient/weather_file.h"
#include "core/base/error.h"

// The weather of the ambient display: a simulated year, and forecasts as Open-Meteo writes them.

namespace lumorph::ambient {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

WeatherHour hour(double temperature, double windFromDegrees = 0.0) {
    WeatherHour hour;
    hour.temperature = temperature;
    hour.windFrom = windFromDegrees * std::numbers::pi / 180.0;
    return hour;
}

TEST(AmbientWeather, ChangesEvenlyAndTheWindByTheShorterWay) {
    const Weather weather(1000.0, {hour(10.0, 350.0), hour(14.0, 20.0)});
    EXPECT_DOUBLE_EQ(weather.at(1000.0 + 900.0).temperature, 11.0);
    EXPECT_NEAR(
        std::remainder(weather.at(1000.0 + 1800.0).windFrom - 5.0 * std::numbers::pi / 180.0, 2.0 * std::numbers::pi),
        0.0, 1e-12);
    EXPECT_EQ(weather.at(0.0).temperature, 10.0) << "as it began";
    EXPECT_EQ(weather.at(1e9).temperature, 14.0) << "as it ended";
    const Weather again(0.0, {hour(10.0), hour(14.0)}, true);
    EXPECT_DOUBLE_EQ(again.at(1.5 * 3600.0).temperature, 12.0) << "back to the first";
    EXPECT_DOUBLE_EQ(again.at(-0.5 * 3600.0).temperature, 12.0);
}

TEST(AmbientWeather, SnowLiesUntilItMelts) {
    std::vector<WeatherHour> hours(10, hour(-2.0));
    for (std::size_t k = 0; k < 5; ++k) hours[k].snow = 1.0;
    hours.resize(60, hour(4.0));
    const Weather weather(0.0, hours);
    EXPECT_DOUBLE_EQ(weather.snowLying(9 * 3600.0), 5.0);
    EXPECT_LT(weather.snowLying(15 * 3600.0), 5.0);
    EXPECT_EQ(weather.snowLying(59 * 3600.0), 0.0);
}

TEST(AmbientWeather, RefusesWhatIsNone) {
    EXPECT_THROW(Weather(0.0, {}), InvalidInput);
    EXPECT_THROW(Weather(std::numeric_limits<double>::infinity(), {hour(1.0)}), InvalidInput);
    WeatherHour wrong;
    wrong.cloudCover = 1.5;
    EXPECT_THROW(Weather(0.0, {wrong}), InvalidInput);
    wrong = {};
    wrong.windSpeed = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(Weather(0.0, {wrong}), InvalidInput);
}

/// Means over the hours of a year that are asked for.
template <typename Which> double meanTemperatureOf(const Weather& weather, const Which& which) {
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < 8760; ++k) {
        if (!which(k / 24, k % 24)) continue;
        sum += weather.hours()[static_cast<std::size_t>(k)].temperature;
        ++count;
    }
    return sum / count;
}

TEST(AmbientYear, HasTheSeasonsAndDaysOfItsHemisphere) {
    const auto january = [](int day, int) { return day < 31; };
    const auto july = [](int day, int) { return day >= 181 && day < 212; };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Weather north = simulatedYear({52.52, 13.405, 3600.0}, seed);
        EXPECT_GT(meanTemperatureOf(north, july), 15.0);
        EXPECT_LT(meanTemperatureOf(north, july), 23.0);
        EXPECT_GT(meanTemperatureOf(north, january), -6.0);
        EXPECT_LT(meanTemperatureOf(north, january), 4.0);
        const Weather south = simulatedYear({-42.88, 147.33, 36'000.0}, seed);
        EXPECT_GT(meanTemperatureOf(south, january), meanTemperatureOf(south, july) + 6.0);
        const double afternoons = meanTemperatureOf(north, [](int, int h) { return h == 15; });
        EXPECT_GT(afternoons, meanTemperatureOf(north, [](int, int h) { return h == 4; }) + 3.0);
    }
}

TEST(AmbientYear, RainsBlowsAndSnowsAsOftenAsAYearDoes) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Weather year = simulatedYear({}, seed);
        int wet = 0, snowy = 0, foggy = 0, thundery = 0;
        double wind = 0.0, strongest = 0.0, rain = 0.0;
        for (const WeatherHour& hour : year.hours()) {
            wet += hour.rain > 0.1 ? 1 : 0;
            snowy += hour.snow > 0.05 ? 1 : 0;
            foggy += hour.visibility < 1000.0 ? 1 : 0;
            thundery += hour.thunder > 0.5 ? 1 : 0;
            wind += hour.windSpeed / 8760.0;
            strongest = std::max(strongest, hour.windSpeed);
            rain += hour.rain;
            if (hour.snow > 0.0) {
                ASSERT_LT(hour.temperature, 2.0);
            }
        }
        EXPECT_GT(wet, 8760 * 4 / 100) << seed;
        EXPECT_LT(wet, 8760 * 20 / 100) << seed;
        EXPECT_GT(rain, 200.0) << "mm a year";
        EXPECT_LT(rain, 1800.0) << "mm a year";
        EXPECT_GT(snowy, 5) << seed;
        EXPECT_GT(foggy, 10) << seed;
        EXPECT_LT(foggy, 900) << seed;
        EXPECT_GT(thundery, 5) << seed;
        EXPECT_GT(wind, 2.0) << seed;
        EXPECT_LT(wind, 6.0) << seed;
        EXPECT_GT(strongest, 14.0) << seed;
    }
    EXPECT_EQ(simulatedYear({}, 7), simulatedYear({}, 7));
    EXPECT_NE(simulatedYear({}, 7), simulatedYear({}, 8));
}

TEST(AmbientYear, ItsNotableDaysAreWhatTheyAreNotableFor) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Weather year = simulatedYear({}, seed);
        const std::vector<double> days = notableDays(year, {});
        ASSERT_EQ(days.size(), 5U);
        double clouds = 0.0, thunder = 0.0, visibility = 1e9, snow = 0.0, rain = 0.0;
        for (int h = 0; h < 24; ++h) {
            const auto at = [&](std::size_t day) { return year.at(days[day] + 3600.0 * h); };
            clouds += at(0).cloudCover / 24.0;
            thunder = std::max(thunder, at(1).thunder);
            visibility = std::min(visibility, at(2).visibility);
            snow += at(3).snow;
            rain += at(4).rain;
        }
        EXPECT_LT(clouds, 0.3) << seed;
        EXPECT_GT(thunder, 0.9) << seed;
        EXPECT_LT(visibility, 800.0) << seed;
        EXPECT_GT(snow, 3.0) << seed;
        EXPECT_GT(rain, 5.0) << seed;
    }
    EXPECT_EQ(notableDays(Weather(0.0, std::vector<WeatherHour>(72)), {}).size(), 3U) << "all of a few";
}

/// As the service answers, with its usual units.
json answer() {
    return json::parse(R"({
        "latitude": 52.52, "longitude": 13.42, "generationtime_ms": 0.2, "utc_offset_seconds": 7200,
        "timezone": "Europe/Berlin", "timezone_abbreviation": "GMT+2", "elevation": 38.0,
        "hourly_units": {"time": "iso8601", "temperature_2m": "°C", "precipitation": "mm", "snowfall": "cm",
                         "cloud_cover": "%", "visibility": "m", "wind_speed_10m": "km/h",
                         "wind_direction_10m": "°", "weather_code": "wmo code"},
        "hourly": {"time": ["2026-07-01T00:00", "2026-07-01T01:00", "2026-07-01T02:00"],
                   "temperature_2m": [15.5, 14.0, -1.0], "precipitation": [0.0, 2.5, 1.0],
                   "snowfall": [0.0, 0.0, 0.7], "cloud_cover": [10, 60, 100], "visibility": [24140, 9000, 400],
                   "wind_speed_10m": [3.6, 36.0, 72.0], "wind_direction_10m": [270, 180, 0],
                   "weather_code": [1, 95, 73]}})");
}

TEST(AmbientForecast, ReadsAnAnswerOfTheService) {
    const Forecast forecast = readForecast(answer().dump(), "answer");
    EXPECT_EQ(forecast.place, (Place{52.52, 13.42, 7200.0}));
    EXPECT_EQ(forecast.weather.begin(), 1'782'864'000.0 - 7200.0) << "2026-07-01 00:00 there";
    const auto& hours = forecast.weather.hours();
    ASSERT_EQ(hours.size(), 3U);
    EXPECT_EQ(hours[0].temperature, 15.5);
    EXPECT_DOUBLE_EQ(hours[1].windSpeed, 10.0);
    EXPECT_DOUBLE_EQ(hours[1].windFrom, std::numbers::pi);
    EXPECT_DOUBLE_EQ(hours[1].cloudCover, 0.6);
    EXPECT_EQ(hours[1].rain, 2.5);
    EXPECT_EQ(hours[1].thunder, 1.0);
    EXPECT_EQ(hours[2].snow, 0.7);
    EXPECT_NEAR(hours[2].rain, 0.0, 1e-12) << "precipitation holds the snow's water";
    EXPECT_EQ(hours[2].visibility, 400.0);
    EXPECT_EQ(hours[2].thunder, 0.0);
}

TEST(AmbientForecast, ReadsTheServicesOtherUnits) {
    json other = answer();
    other["hourly_units"]["time"] = "unixtime";
    other["hourly"]["time"] = {3600, 7200, 10'800};
    other["hourly_units"]["temperature_2m"] = "°F";
    other["hourly_units"]["precipitation"] = "inch";
    other["hourly_units"]["snowfall"] = "inch";
    other["hourly_units"]["visibility"] = "ft";
    other["hourly"]["temperature_2m"] = {32, 50, 14};
    other["hourly"]["precipitation"] = {0.1, 0.0, 0.0};
    other["hourly"]["snowfall"] = {0.0, 0.0, 1.0};
    const struct {
        const char* unit;
        double metresASecond;
    } rows[] = {{"m/s", 1.0}, {"mp/h", 0.44704}, {"kn", 0.514444}, {"km/h", 0.277778}};
    for (const auto& row : rows) {
        other["hourly_units"]["wind_speed_10m"] = row.unit;
        const Forecast read = readForecast(other.dump(), "other");
        EXPECT_EQ(read.weather.begin(), 3600.0);
        EXPECT_NEAR(read.weather.hours()[0].temperature, 0.0, 1e-12);
        EXPECT_NEAR(read.weather.hours()[1].temperature, 10.0, 1e-12);
        EXPECT_NEAR(read.weather.hours()[0].rain, 2.54, 1e-12);
        EXPECT_NEAR(read.weather.hours()[2].snow, 2.54, 1e-12);
        EXPECT_NEAR(read.weather.hours()[0].visibility, 24140 * 0.3048, 1e-9);
        EXPECT_NEAR(read.weather.hours()[1].windSpeed, 36.0 * row.metresASecond, 1e-4) << row.unit;
    }
}

TEST(AmbientForecast, DoesWithoutWhatNeedNotBeThere) {
    json little = answer();
    for (const char* key : {"snowfall", "visibility", "weather_code"}) little["hourly"].erase(key);
    for (const char* key : {"latitude", "utc_offset_seconds", "hourly_units"}) little.erase(key);
    const Forecast read = readForecast(little.dump(), "little");
    EXPECT_FALSE(read.place);
    EXPECT_EQ(read.weather.hours()[1].visibility, 24e3);
    json foggy = answer();
    foggy["hourly"].erase("visibility");
    foggy["hourly"]["weather_code"][0] = 45;
    EXPECT_LT(readForecast(foggy.dump(), "foggy").weather.hours()[0].visibility, 1000.0);
}

TEST(AmbientForecast, ShowsTheHoursThatAreKnown) {
    json gaps = answer();
    json& hourly = gaps["hourly"];
    hourly["time"] = json::array();
    for (int k = 0; k < 8; ++k) hourly["time"].push_back("2026-07-01T0" + std::to_string(k) + ":00");
    const json null;
    //                          0     1     2     3     4     5     6     7
    hourly["temperature_2m"] = {null, 10.0, 12.0, null, null, 18.0, 20.0, 22.0};
    hourly["precipitation"] = {0.0, 0.0, 1.0, 1.0, null, 4.0, 0.0, null};
    hourly["snowfall"] = {0.0, null, 0.0, 0.0, 0.0, 0.0, null, 0.0};
    hourly["cloud_cover"] = {0, 10, 20, 30, 40, 50, 60, 70};
    hourly["visibility"] = {1000, 2000, null, 4000, 5000, 6000, 7000, 8000};
    hourly["wind_speed_10m"] = {3.6, 3.6, 3.6, 3.6, 3.6, 3.6, 3.6, 3.6};
    hourly["wind_direction_10m"] = {0, 0, 350, null, null, 20, 0, 0};
    hourly["weather_code"] = {0, 0, 45, 0, 0, null, 95, 0};
    const Weather read = readForecast(gaps.dump(), "gaps").weather;
    EXPECT_EQ(read.begin(), 1'782'864'000.0 - 7200.0 + 3600.0) << "the first hour has no temperature";
    ASSERT_EQ(read.hours().size(), 6U) << "the last has no precipitation";
    const double temperatures[] = {10.0, 12.0, 14.0, 16.0, 18.0, 20.0};
    const double rains[] = {0.0, 1.0, 1.0, 2.5, 4.0, 0.0};
    const double winds[] = {0.0, 350.0, 0.0, 10.0, 20.0, 0.0};
    const double visibilities[] = {2000.0, 300.0, 4000.0, 5000.0, 6000.0, 7000.0};
    for (std::size_t k = 0; k < 6; ++k) {
        const WeatherHour& hour = read.hours()[k];
        EXPECT_NEAR(hour.temperature, temperatures[k], 1e-12) << k;
        EXPECT_NEAR(hour.rain, rains[k], 1e-12) << k;
        EXPECT_NEAR(std::remainder(hour.windFrom - winds[k] * std::numbers::pi / 180.0, 2.0 * std::numbers::pi), 0.0,
                    1e-12)
            << k;
        EXPECT_NEAR(hour.visibility, visibilities[k], 1e-9) << k << ": where it is null the code says fog, or nothing";
        EXPECT_EQ(hour.snow, 0.0);
        EXPECT_EQ(hour.thunder, k == 5 ? 1.0 : 0.0);
    }
}

/// Clocks of the European Union: forward on the last Sunday of March, back on that of October, both at 1:00 UTC.
std::vector<std::byte> zoneFileOf(const std::string& footer) {
    std::string file;
    for (int block = 0; block < 2; ++block) {
        file += "TZif2" + std::string(15, '\0');
        for (const char count : {0, 0, 0, 0, 1, 4}) file += std::string(3, '\0') + count;
        file += std::string("\0\0\x0E\x10\0\0", 6) + std::string("CET\0", 4); // 3600 s
    }
    file += "\n" + footer + "\n";
    const auto bytes = std::as_bytes(std::span(file));
    return {bytes.begin(), bytes.end()};
}

Place berlinByRule() {
    const auto zone = std::make_shared<const TimeZone>(zoneFileOf("CET-1CEST,M3.5.0,M10.5.0/3"), "Berlin");
    return {52.52, 13.41, 7200.0, zone};
}

double utcAt(const char* time) { return *timeFrom(time, 0.0); }

TEST(AmbientClocks, FollowTheZoneAcrossAChange) {
    const Place place = berlinByRule();
    EXPECT_EQ(offsetAt(place, utcAt("2026-10-25T00:59")), 7200.0);
    EXPECT_EQ(offsetAt(place, utcAt("2026-10-25T01:00")), 3600.0);
    EXPECT_EQ(offsetAt(place, utcAt("2026-03-29T00:59")), 3600.0);
    EXPECT_EQ(offsetAt(place, utcAt("2026-03-29T01:00")), 7200.0);
    EXPECT_EQ(offsetAt(place, utcAt("2040-07-01T00:00")), 7200.0);
    EXPECT_DOUBLE_EQ(localHour(place, utcAt("2026-10-25T13:00")), 14.0);
    EXPECT_DOUBLE_EQ(localHour(place, utcAt("2026-10-24T12:00")), 14.0);
    EXPECT_EQ(utcOf(place, utcAt("2026-10-25T14:00")), utcAt("2026-10-25T13:00"));
    EXPECT_EQ(utcOf(place, utcAt("2026-10-25T02:30")), utcAt("2026-10-25T00:30")) << "the first of two";
    EXPECT_EQ(utcOf(place, utcAt("2026-03-29T02:30")), utcAt("2026-03-29T01:30")) << "no clock shows that";
    EXPECT_EQ(localMidnight(place, utcAt("2026-10-25T20:00")), utcAt("2026-10-24T22:00"));
    EXPECT_EQ(localMidnight(place, utcAt("2026-10-25T23:00")), utcAt("2026-10-25T23:00"));
    // Days of 24, 25 and 24 hours.
    const std::vector<double> days =
        notableDays(Weather(utcAt("2026-10-23T22:00"), std::vector<WeatherHour>(72)), place);
    EXPECT_EQ(days,
              (std::vector<double>{utcAt("2026-10-23T22:00"), utcAt("2026-10-24T22:00"), utcAt("2026-10-25T23:00")}));
}

TEST(AmbientClocks, ReadTheRulesOfOtherZones) {
    const struct {
        const char *footer, *time;
        double hours;
    } rows[] = {
        {"<+0530>-5:30", "2026-07-01T00:00", 5.5},
        {"EST5EDT,M3.2.0,M11.1.0", "2026-03-08T06:59", -5.0},
        {"EST5EDT,M3.2.0,M11.1.0", "2026-03-08T07:00", -4.0},
        {"EST5EDT,M3.2.0,M11.1.0", "2026-11-01T05:59", -4.0},
        {"EST5EDT,M3.2.0,M11.1.0", "2026-11-01T06:00", -5.0},
        {"AEST-10AEDT,M10.1.0,M4.1.0/3", "2026-01-01T00:00", 11.0}, // summer over the end of the year
        {"AEST-10AEDT,M10.1.0,M4.1.0/3", "2026-07-01T00:00", 10.0},
        {"<-02>2<-01>,M3.5.0/-1,M10.5.0/0", "2026-03-29T00:59", -2.0},
        {"<-02>2<-01>,M3.5.0/-1,M10.5.0/0", "2026-03-29T01:00", -1.0},
        {"AAA0BBB,J60/0,J300/0", "2028-03-01T00:00", 1.0}, // the 60th day is March 1st, in leap years too
        {"AAA0BBB,J60/0,J300/0", "2028-02-29T23:59", 0.0},
        {"AAA0BBB,59/0,300/0", "2028-02-29T00:00", 1.0},
    };
    for (const auto& row : rows)
        EXPECT_EQ(TimeZone(zoneFileOf(row.footer), "zone").offsetAt(utcAt(row.time)), 3600.0 * row.hours)
            << row.footer << " " << row.time;
    for (const char* wrong :
         {"CET-1CEST,M3.5.0", "CET", "CET-1CEST,M13.5.0,M10.5.0", "<+05-5", "CET-1CEST,M3.5.0,M10.5.0/3x"})
        EXPECT_THROW(TimeZone(zoneFileOf(wrong), "zone"), DataError) << wrong;
    const std::vector<std::byte> whole = zoneFileOf("CET-1");
    for (std::size_t size = 0; size < 108; ++size)
        EXPECT_THROW(TimeZone(std::span(whole).first(size), "zone"), DataError) << size;
    for (const char* none : {"", "/etc/passwd", "../zoneinfo/UTC", "Nowhere/At_All", "Europe"})
        EXPECT_EQ(zoneNamed(none), nullptr) << none;
}

/// Small inputs of ../shared/data/cases, whose right values stand in FACTS.md there.
class WeatherCases : public ::testing::Test {
protected:
    static Forecast read(const char* name) {
        return readForecastFile(std::filesystem::path(LUMORPH_SHARED_DIR) / "data/cases/weather" / name);
    }
    void SetUp() override {
        if (!std::filesystem::exists(std::filesystem::path(LUMORPH_SHARED_DIR) / "data/cases"))
            GTEST_SKIP() << "without ../shared/data/cases";
    }
};

TEST_F(WeatherCases, NullsAtTheEndAreLeftOut) {
    const Weather plain = read("plain.json").weather, some = read("last-three-null.json").weather;
    ASSERT_EQ(plain.hours().size(), 72U);
    ASSERT_EQ(some.hours().size(), 69U);
    EXPECT_EQ(some.begin(), utcAt("2026-05-16T22:00"));
    EXPECT_EQ(some.at(utcAt("2026-05-19T18:00")).temperature, 17.0) << "20:00 there, the last that is known";
    for (std::size_t k = 0; k < 69; ++k) EXPECT_EQ(some.hours()[k], plain.hours()[k]);
}

TEST_F(WeatherCases, AForecastAskedInSummerTimeIsRightInWinterTime) {
    if (!zoneNamed("Europe/Berlin")) GTEST_SKIP() << "without tzdata";
    const Forecast forecast = read("berlin-asked-in-summer-time.json");
    EXPECT_EQ(forecast.weather.begin(), utcAt("2026-10-23T22:00")) << "times are two hours ahead of UTC throughout";
    EXPECT_EQ(forecast.weather.end(), utcAt("2026-10-26T21:00"));
    ASSERT_TRUE(forecast.place);
    EXPECT_EQ(utcOf(*forecast.place, utcAt("2026-10-25T14:00")), utcAt("2026-10-25T13:00"));
    EXPECT_DOUBLE_EQ(localHour(*forecast.place, utcAt("2026-10-25T13:00")), 14.0);
    // The rules that are written down here are those of the database.
    for (double time = utcAt("2026-01-01T00:00"); time < utcAt("2028-01-01T00:00"); time += 1800.0)
        ASSERT_EQ(offsetAt(*forecast.place, time), offsetAt(berlinByRule(), time)) << time;
}

TEST(AmbientForecast, NamesWhatIsWrong) {
    struct Row {
        std::string text, says;
    };
    const auto changed = [](const char* pointer, const json& value) {
        json root = answer();
        root[json::json_pointer(pointer)] = value;
        return root.dump();
    };
    const auto without = [](const char* section, const char* key) {
        json root = answer();
        (section ? root[section] : root).erase(key);
        return root.dump();
    };
    std::string torn = answer().dump();
    torn.resize(torn.size() / 2);
    std::string nan = answer().dump();
    nan.replace(nan.find("15.5"), 4, "NaN ");
    const Row rows[] = {
        {"", "is not valid JSON"},
        {torn, "is not valid JSON"},
        {nan, "is not valid JSON"},
        {"[]", "is not a JSON object"},
        {R"({"error": true, "reason": "Latitude must be in range of -90 to 90"})", "Latitude must be in range"},
        {R"({"error": true})", "an error of the service"},
        {without(nullptr, "hourly"), "has no \"hourly\""},
        {changed("/hourly", 3), "\"hourly\" is not an object"},
        {without("hourly", "time"), "has no hourly.time"},
        {without("hourly", "temperature_2m"), "has no hourly.temperature_2m"},
        {changed("/hourly/cloud_cover", "many"), "hourly.cloud_cover is not a list"},
        {changed("/hourly/time", json::array()), "hourly.time is empty"},
        {changed("/hourly/time/1", "yesterday"), "hourly.time[1] is no time"},
        {changed("/hourly/time/1", 5), "hourly.time[1] is no time"},
        {changed("/hourly/time/2", "2026-07-01T03:00"), "hourly.time[2] does not come an hour after"},
        {changed("/hourly/precipitation", {0.0, 1.0}), "hourly.precipitation has 2 values, and hourly.time 3"},
        {changed("/hourly/wind_speed_10m", {nullptr, nullptr, nullptr}), "has no hour of which"},
        {changed("/hourly/temperature_2m/0", "warm"), "hourly.temperature_2m[0] is not a number"},
        {changed("/hourly/temperature_2m/0", 1e300), "hourly.temperature_2m[0] is 1e+300, out of range"},
        {changed("/hourly/cloud_cover/0", 101), "hourly.cloud_cover[0] is 101, out of range"},
        {changed("/hourly/precipitation/0", -1), "hourly.precipitation[0] is -1, out of range"},
        {changed("/hourly_units/wind_speed_10m", "Bft"), "is \"Bft\"; use km/h, m/s, mp/h, kn"},
        {changed("/hourly_units/wind_speed_10m", 5), "hourly_units.wind_speed_10m is not a text"},
        {changed("/hourly_units", 5), "\"hourly_units\" is not an object"},
        {changed("/utc_offset_seconds", "two"), "\"utc_offset_seconds\" is not a number"},
        {changed("/latitude", 95.0), "\"latitude\" is not a number"},
    };
    for (const Row& row : rows) {
        try {
            (void)readForecast(row.text, "weather.json");
            ADD_FAILURE() << row.says;
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), "weather.json");
            EXPECT_THAT(error.what(), HasSubstr(row.says));
        }
    }
    EXPECT_THROW((void)readForecast(std::string(200, '['), "deep"), DataError);
    EXPECT_THROW((void)readForecastFile("/none/of/these.json"), Error);
}

} // namespace
} // namespace lumorph::ambient
