#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/navigation/rain.h"
#include "app/applications/navigation/search.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/valley.h"

// The bundled map: water runs down it, houses stand on dry ground, and places are found by their names.

namespace lumorph::navigation {
namespace {

const Map& valleyMap() {
    static const Map map = bundledValley();
    return map;
}

TEST(BundledValley, IsTheSameEachTime) {
    const Map again = bundledValley();
    EXPECT_EQ(again.heights.heights(), valleyMap().heights.heights());
    EXPECT_EQ(again.buildings.size(), valleyMap().buildings.size());
}

TEST(BundledValley, HasATownOfHousesOnDryGround) {
    const Map& map = valleyMap();
    std::size_t houses = 0;
    const glm::dvec2 square = map.places[*find(map.places, "Merinhaven")].at;
    for (const Building& building : map.buildings) {
        ASSERT_GE(doubleArea(building.outline), 0.0);
        if (building.grounded && glm::distance(building.outline.front(), square) < 700.0) ++houses;
        if (!building.grounded) continue;
        for (const glm::dvec2& corner : building.outline) ASSERT_FALSE(map.isWater(map.sampleAt(corner)));
    }
    EXPECT_GE(houses, 100U);
    EXPECT_LE(houses, 400U);
    for (const Place& place : map.places) {
        EXPECT_GE(std::min(place.at.x, place.at.y), 0.0) << place.name.english;
        EXPECT_LE(std::max(place.at.x, place.at.y), 8192.0) << place.name.english;
    }
}

/// Literally: the lowest slope of eight, again and again, on the map's own samples.
bool endsInWater(const Map& map, glm::ivec2 at) {
    const int side = map.heights.samples().x;
    for (int steps = 0; steps < 20000; ++steps) {
        const std::size_t k =
            static_cast<std::size_t>(at.y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(at.x);
        if (map.water[k] > map.heights.heights()[k]) return true;
        glm::ivec2 best = at;
        double steepest = 0.0;
        for (int y = std::max(at.y - 1, 0); y <= std::min(at.y + 1, side - 1); ++y)
            for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, side - 1); ++x) {
                const double fall = static_cast<double>(map.heights.heights()[k]) -
                                    static_cast<double>(map.heights.heights()[static_cast<std::size_t>(y * side + x)]);
                const double slope = fall / (8.0 * std::hypot(x - at.x, y - at.y));
                if ((x != at.x || y != at.y) && slope > steepest) {
                    steepest = slope;
                    best = {x, y};
                }
            }
        if (best == at) return false;
        at = best;
    }
    return false;
}

TEST(BundledValley, WaterRunsFromEverywhereIntoRiverOrLake) {
    for (int y = 3; y < 1025; y += 31)
        for (int x = 5; x < 1025; x += 37) EXPECT_TRUE(endsInWater(valleyMap(), {x, y})) << x << " " << y;
}

TEST(Rain, DropsGoTheSteepestWay) {
    const Map& map = valleyMap();
    const MapView view{{2500.0, 2500.0}, 3000.0, 0.3};
    Rain rain(4);
    for (int k = 0; k < 60; ++k) rain.advance(map, view, glm::dvec2(0.0), 1.0 / 60.0);
    ASSERT_FALSE(rain.drops().empty());
    for (int k = 0; k < 60 * 20; ++k) {
        rain.advance(map, view, std::nullopt, 1.0 / 60.0);
        for (const Rain::Drop& drop : rain.drops()) ASSERT_TRUE(endsInWater(map, drop.to));
    }
    EXPECT_GT(rain.reachedWater(), 0U);
}

TEST(Find, ForgivesSlipsAccentsAndWordsLeftOut) {
    const std::vector<Place> places{{"Merinhaven", {}, 1, 0},
                                    {"Saint Alba's church", {}, 1, 0},
                                    {{"Castle Harrow", "Burg Harrow"}, {}, 1, 0},
                                    {"Ölsund", {}, 1, 0}};
    const struct {
        const char* name;
        int place;
    } rows[] = {{"Merinhaven", 0},    {"merinhaven", 0},  {"merin", 0},  {"Merinhafen", 0},
                {"church", 1},        {"saint albas", 1}, {"castle", 2}, {"harow", 2},
                {"HARROW castle", 2}, {"olsund", 3},      {"Ölsund", 3}, {"Burg Harrow", 2},
                {"burg", 2},          {"Paris", -1},      {"", -1},      {"   ", -1}};
    for (const auto& row : rows) {
        const auto found = find(places, row.name);
        EXPECT_EQ(found ? static_cast<int>(*found) : -1, row.place) << row.name;
    }
}

TEST(Flight, BeginsAndEndsWhereItShall) {
    const MapView from{{1000.0, 2000.0}, 900.0, 3.0}, to{{7000.0, 5000.0}, 400.0, -3.0};
    const Flight flight(from, to);
    EXPECT_LT(glm::distance(flight.at(0.0).centre, from.centre), 1e-6);
    EXPECT_NEAR(flight.at(0.0).width, from.width, 1e-6);
    EXPECT_EQ(flight.at(flight.seconds()), to);
    EXPECT_GT(flight.at(0.5 * flight.seconds()).width, 2000.0) << "it rises to see where it goes";
    double most = 0.0, turned = 0.0;
    for (int k = 0; k < 600; ++k) {
        const MapView a = flight.at(flight.seconds() * k / 600.0), b = flight.at(flight.seconds() * (k + 1) / 600.0);
        most = std::max(most, glm::distance(a.centre, b.centre) / a.width);
        if (k < 599) turned += b.turn - a.turn;
    }
    EXPECT_LT(most, 0.02) << "of its width in a 600th of the way";
    EXPECT_NEAR(turned, 0.283, 0.05) << "the shorter way round";
}

} // namespace
} // namespace lumorph::navigation
