#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/ambient/place.h"
#include "app/applications/ambient/sun.h"
#include "core/base/error.h"

// The sun of the ambient display against published values; at places and times for which none are at hand, against the
// formulas of low precision in Meeus, Astronomical Algorithms, chapters 12, 13 and 25, written out once more.

namespace lumorph::ambient {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

/// Seconds since 1970 by Meeus' Julian day (chapter 7).
double utcOf(int year, int month, double day, double hour) {
    if (month <= 2) {
        --year;
        month += 12;
    }
    const int century = year / 100;
    const double julian = std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + 2 - century +
                          std::floor(century / 4.0) - 1524.5;
    return (julian - 2'440'587.5) * 86'400.0 + hour * 3600.0;
}

/// Chapter 25, "low accuracy" (0.01 degrees), with sidereal time of chapter 12 and chapter 13's horizon.
SkyPosition literalSun(double latitude, double longitude, double utc) {
    const double julian = utc / 86'400.0 + 2'440'587.5;
    const double t = (julian + 69.0 / 86'400.0 - 2'451'545.0) / 36'525.0;
    const double mean = 280.46646 + 36'000.76983 * t + 0.0003032 * t * t;
    const double anomaly = (357.52911 + 35'999.05029 * t - 0.0001537 * t * t) * kRadian;
    const double centre = (1.914602 - 0.004817 * t) * std::sin(anomaly) +
                          (0.019993 - 0.000101 * t) * std::sin(2.0 * anomaly) + 0.000289 * std::sin(3.0 * anomaly);
    const double node = (125.04 - 1934.136 * t) * kRadian;
    const double apparent = (mean + centre - 0.00569 - 0.00478 * std::sin(node)) * kRadian;
    const double tilt = (23.439291 - 0.0130042 * t + 0.00256 * std::cos(node)) * kRadian;
    const double ascension = std::atan2(std::cos(tilt) * std::sin(apparent), std::cos(apparent));
    const double declination = std::asin(std::sin(tilt) * std::sin(apparent));
    const double ut = (julian - 2'451'545.0) / 36'525.0;
    const double sidereal = 280.46061837 + 360.98564736629 * (julian - 2'451'545.0) + 0.000387933 * ut * ut;
    const double hour = (sidereal + longitude) * kRadian - ascension;
    const double phi = latitude * kRadian;
    const double fromSouth =
        std::atan2(std::sin(hour), std::cos(hour) * std::sin(phi) - std::tan(declination) * std::cos(phi));
    return {fromSouth + std::numbers::pi,
            std::asin(std::sin(phi) * std::sin(declination) + std::cos(phi) * std::cos(declination) * std::cos(hour))};
}

double degreesBetween(const SkyPosition& a, const SkyPosition& b) {
    const Place north{45.0, 0.0, 0.0};
    return std::acos(std::min(1.0, glm::dot(towards(north, a), towards(north, b)))) / kRadian;
}

// I. Reda, A. Andreas, Solar Position Algorithm for Solar Radiation Applications, NREL/TP-560-34302, table A5.1: the
// topocentric zenith 50.11162 holds 0.0162 degrees of refraction, which ours leaves out.
TEST(AmbientSun, IsWhereNrelsExampleSays) {
    const SkyPosition sun = sunAt({39.742476, -105.1786, -7.0 * 3600.0}, utcOf(2003, 10, 17, 19.0 + 30.5 / 60.0));
    EXPECT_NEAR(sun.elevation / kRadian, 90.0 - 50.11162, 0.02);
    EXPECT_NEAR(sun.azimuth / kRadian, 194.34024, 0.005);
}

// Seen from the pole its elevation is its declination. Meeus, example 25.b (1992 October 13.0 TD), and the moments of
// equinoxes and solstices as almanacs have them.
TEST(AmbientSun, HasThePublishedDeclinations) {
    const struct {
        double utc, declination;
    } rows[] = {
        {utcOf(1992, 10, 13, 0.0) - 59.0, -7.0 - 47.0 / 60.0 - 1.74 / 3600.0},
        {utcOf(2026, 3, 20, 14.0 + 46.0 / 60.0), 0.0},
        {utcOf(2026, 6, 21, 8.0 + 25.0 / 60.0), 23.436},
        {utcOf(2026, 9, 23, 0.0 + 5.0 / 60.0), 0.0},
        {utcOf(2026, 12, 21, 20.0 + 50.0 / 60.0), -23.436},
    };
    for (const auto& row : rows)
        EXPECT_NEAR(sunAt({90.0, 0.0, 0.0}, row.utc).elevation / kRadian, row.declination, 0.005) << row.declination;
}

// Ten published positions. NOAA's Solar Calculator (gml.noaa.gov/grad/solcalc), to 0.01 degrees and with refraction, of
// which ours has none: Saemundsson's formula (Meeus, chapter 16) takes it away here. JPL's Horizons (ssd.jpl.nasa.gov,
// DE431, topocentric and airless), printed on 2019-04-13 for latitude and longitude 0. It knows UT1, which the formulas
// take UTC for: 0.1 s then, 0.0004 degrees.
TEST(AmbientSun, IsWherePublishedTablesSayInBothHemispheres) {
    const double noaa = utcOf(2012, 12, 22, 12.0);
    const auto equinox = [](double hour) { return utcOf(2019, 3, 20, hour); };
    const struct {
        const char* source;
        double latitude, utc, azimuth, elevation;
        bool refracted;
    } rows[] = {
        {"NOAA, 41 S", -41.0, noaa, 359.09, 72.44, true},
        {"NOAA, 3 S", -3.0, noaa, 180.79, 69.57, true},
        {"NOAA, 3 N", 3.0, noaa, 180.62, 63.57, true},
        {"NOAA, 41 N", 41.0, noaa, 180.30, 25.60, true},
        {"Horizons, the night before", 0.0, utcOf(2019, 3, 19, 1.0), 93.2877, -76.9790, false},
        {"Horizons, 06:50", 0.0, equinox(6.0 + 50.0 / 60.0), 90.2534, 10.5897, false},
        {"Horizons, 08:30", 0.0, equinox(8.5), 90.2726, 35.5951, false},
        {"Horizons, 10:00", 0.0, equinox(10.0), 90.3727, 58.1001, false},
        {"Horizons, 13:30", 0.0, equinox(13.5), 269.6043, 69.3859, false},
        {"Horizons, 15:30", 0.0, equinox(15.5), 269.8624, 39.3790, false},
    };
    for (const auto& row : rows) {
        const SkyPosition sun = sunAt({row.latitude, 0.0, 0.0}, row.utc);
        const double minutes = 1.02 / std::tan((row.elevation + 10.3 / (row.elevation + 5.11)) * kRadian);
        const SkyPosition published{row.azimuth * kRadian,
                                    (row.elevation - (row.refracted ? minutes / 60.0 : 0.0)) * kRadian};
        EXPECT_LT(degreesBetween(sun, published), 0.015) << row.source;
    }
}

// Tables of sunrise and sunset for 2019 of the Astronomical Applications Department of the U.S. Naval Observatory, to
// the minute: location W150 00, S60 00 and location W081 00, N29 00, Universal Time.
TEST(AmbientSun, RisesAndSetsInTheMinuteThatTheNavalObservatorySays) {
    const Place south{-60.0, -150.0, -10.0 * 3600.0}, north{29.0, -81.0, -5.0 * 3600.0};
    const struct {
        const Place& place;
        int month, day;
        bool rises;
        int hour, minute; ///< of UT; of the next day where a sunset belongs to the evening before in UT
        bool nextDay;
    } rows[] = {
        {south, 1, 1, true, 12, 43, false},   {south, 1, 1, false, 7, 23, true},
        {south, 3, 20, true, 16, 0, false},   {south, 3, 20, false, 4, 13, true},
        {south, 6, 21, true, 19, 6, false},   {south, 6, 21, false, 0, 58, true},
        {south, 10, 15, true, 14, 38, false}, {south, 10, 15, false, 4, 55, true},
        {north, 1, 1, true, 12, 18, false},   {north, 1, 1, false, 22, 38, false},
        {north, 3, 20, true, 11, 28, false},  {north, 3, 20, false, 23, 35, false},
        {north, 6, 21, true, 10, 26, false},  {north, 6, 21, false, 0, 26, true},
        {north, 10, 15, true, 11, 25, false}, {north, 10, 15, false, 22, 54, false},
    };
    for (const auto& row : rows) {
        const double published = utcOf(2019, row.month, row.day + (row.nextDay ? 1 : 0), row.hour + row.minute / 60.0);
        const double midnight = utcOf(2019, row.month, row.day, 0.0) - row.place.utcOffset;
        const SunTimes times = sunTimes(row.place, midnight);
        ASSERT_TRUE(times.rise && times.set);
        const double ours = row.rises ? *times.rise : *times.set;
        // Rounded to the minute there, and 5 s for what the table's own theory may differ by.
        EXPECT_NEAR(ours, published, 35.0) << "latitude " << row.place.latitude << ", " << row.month << "/" << row.day
                                           << (row.rises ? " rise" : " set");
    }
}

TEST(AmbientSun, AgreesWithTheLiteralFormulasEverywhere) {
    const struct {
        const char* name;
        double latitude, longitude, utc;
    } rows[] = {
        {"Berlin, summer noon", 52.52, 13.405, utcOf(2026, 6, 21, 11.1)},
        {"Berlin, winter morning", 52.52, 13.405, utcOf(2026, 12, 21, 7.5)},
        {"Sydney, summer afternoon", -33.87, 151.21, utcOf(2026, 1, 10, 5.0)},
        {"Sydney, winter noon", -33.87, 151.21, utcOf(2026, 7, 1, 2.0)},
        {"Quito, equinox", -0.18, -78.47, utcOf(2026, 3, 20, 17.0)},
        {"Tromso, midnight sun", 69.65, 18.96, utcOf(2026, 6, 21, 23.0)},
        {"Ushuaia, autumn", -54.80, -68.30, utcOf(2026, 4, 15, 15.0)},
        {"Tokyo, evening", 35.68, 139.69, utcOf(2030, 9, 1, 8.5)},
        {"Cape Town, spring", -33.92, 18.42, utcOf(2024, 10, 5, 6.0)},
        {"Honolulu, before noon", 21.31, -157.86, utcOf(2028, 2, 29, 21.0)},
    };
    double worst = 0.0;
    for (const auto& row : rows) {
        const double off = degreesBetween(sunAt({row.latitude, row.longitude, 0.0}, row.utc),
                                          literalSun(row.latitude, row.longitude, row.utc));
        EXPECT_LT(off, 0.1) << row.name;
        worst = std::max(worst, off);
    }
    RecordProperty("worstDegrees", std::to_string(worst));
    EXPECT_LT(worst, 0.03);
}

/// By bisection of the literal formulas; negative where the sun does not cross.
double literalCrossing(double latitude, double longitude, double midnight, bool rises) {
    const auto below = [&](double t) { return literalSun(latitude, longitude, t).elevation < -0.833 * kRadian; };
    for (double t = midnight; t < midnight + 86'400.0; t += 600.0) {
        if (below(t) == below(t + 600.0) || below(t) != rises) continue;
        double from = t, to = t + 600.0;
        for (int k = 0; k < 14; ++k) (below(0.5 * (from + to)) == rises ? from : to) = 0.5 * (from + to);
        return 0.5 * (from + to);
    }
    return -1.0;
}

TEST(AmbientSun, RisesAndSetsWithinAMinuteOverAYear) {
    const Place places[] = {{52.52, 13.405, 3600.0}, {-33.87, 151.21, 36'000.0}, {60.17, 24.94, 7200.0}};
    double worst = 0.0;
    for (const Place& place : places) {
        for (int day = 0; day < 365; day += 3) {
            const double midnight = utcOf(2026, 1, 1.0 + day, 0.0) - place.utcOffset;
            const SunTimes times = sunTimes(place, midnight);
            ASSERT_TRUE(times.rise && times.set) << day;
            for (const bool rises : {true, false}) {
                const double literal = literalCrossing(place.latitude, place.longitude, midnight, rises);
                const double off = std::abs((rises ? *times.rise : *times.set) - literal);
                ASSERT_LT(off, 60.0) << "latitude " << place.latitude << ", day " << day;
                worst = std::max(worst, off);
            }
        }
    }
    RecordProperty("worstSeconds", std::to_string(worst));
    EXPECT_LT(worst, 30.0);
}

TEST(AmbientSun, IsTheSameWhateverWasAskedBefore) {
    const Place berlin;
    const double noon = utcOf(2026, 5, 17, 11.0);
    const SkyPosition first = sunAt(berlin, noon);
    const Moon moon = moonAt(berlin, noon);
    (void)sunAt(berlin, noon + 4000.0);
    EXPECT_EQ(sunAt(berlin, noon).azimuth, first.azimuth);
    (void)sunAt(berlin, noon - 4000.0);
    EXPECT_EQ(moonAt(berlin, noon).position.elevation, moon.position.elevation);
}

TEST(AmbientSun, NeitherRisesNorSetsInThePolarNightAndDay) {
    const Place tromso{69.65, 18.96, 3600.0};
    EXPECT_FALSE(sunTimes(tromso, localMidnight(tromso, utcOf(2026, 12, 21, 12.0))).rise);
    EXPECT_FALSE(sunTimes(tromso, localMidnight(tromso, utcOf(2026, 6, 21, 12.0))).set);
    EXPECT_LT(sunAt(tromso, utcOf(2026, 12, 21, 10.7)).elevation, kHorizon);
    EXPECT_GT(sunAt(tromso, utcOf(2026, 6, 21, 22.7)).elevation, 0.0);
}

// Full moons and new moons of 2026: January 3rd 10:03, August 28th 04:18 (an eclipse of the moon); August 12th 17:37
// (an eclipse of the sun: the moon stands before it).
TEST(AmbientSun, TheMoonIsFullAndNewWhenAlmanacsSay) {
    const Place burgos{42.34, -3.70, 3600.0};
    EXPECT_GT(moonAt(burgos, utcOf(2026, 1, 3, 10.05)).lit, 0.99);
    EXPECT_GT(moonAt(burgos, utcOf(2026, 8, 28, 4.3)).lit, 0.99);
    const double eclipse = utcOf(2026, 8, 12, 18.49); // greatest over Burgos
    EXPECT_LT(moonAt(burgos, eclipse).lit, 0.01);
    EXPECT_LT(degreesBetween(moonAt(burgos, eclipse).position, sunAt(burgos, eclipse)), 0.3);
}

TEST(AmbientPlace, IsReadAndWhatIsNoneIsRefused) {
    EXPECT_EQ(placeFrom("52.52,13.405"), (Place{52.52, 13.405, 3600.0}));
    EXPECT_EQ(placeFrom("-33.87,151.21,11"), (Place{-33.87, 151.21, 39'600.0}));
    for (const char* wrong :
         {"", "52", "52,", "a,b", "52,13,1,1", "91,0", "0,181", "0,0,15", "nan,0", "52;13", "52,13 "})
        EXPECT_THROW((void)placeFrom(wrong), InvalidInput) << wrong;
}

TEST(AmbientPlace, ClocksAreAheadOfUtc) {
    const Place berlin;
    const double noon = utcOf(2026, 5, 17, 11.0);
    EXPECT_DOUBLE_EQ(localHour(berlin, noon), 12.0);
    EXPECT_DOUBLE_EQ(localMidnight(berlin, noon), utcOf(2026, 5, 16, 23.0));
    EXPECT_EQ(timeFrom("2026-05-17T12:00", 3600.0), noon);
    for (const char* wrong :
         {"", "2026-05-17", "2026-13-17T12:00", "2026-02-30T12:00", "2026-05-17T24:00", "2026-05-17T12:00Z"})
        EXPECT_FALSE(timeFrom(wrong, 0.0)) << wrong;
}

// Who stands before it looks towards the noon sun.
TEST(AmbientPlace, TheNoonSunStandsOppositeInBothHemispheres) {
    for (const double latitude : {50.0, -35.0}) {
        const Place place{latitude, 0.0, 0.0};
        const glm::dvec3 noon = towards(place, sunAt(place, utcOf(2026, 3, 20, 12.1)));
        EXPECT_LT(noon.z, -0.4) << "beyond the far rim";
        const glm::dvec3 morning = towards(place, sunAt(place, utcOf(2026, 3, 20, 8.0)));
        EXPECT_EQ(morning.x<0.0, latitude> 0.0) << "it goes to the right in the north, to the left in the south";
    }
}

} // namespace
} // namespace lumorph::ambient
