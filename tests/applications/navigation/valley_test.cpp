#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/navigation/rain.h"
#include "app/applications/navigation/search.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/solid.h"
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
        for (const glm::dvec2& corner : building.outline)
            ASSERT_FALSE(map.isWater(map.sampleAt(corner))) << glm::distance(corner, square) << " m from the square";
    }
    EXPECT_GE(houses, 100U);
    EXPECT_LE(houses, 850U);
    for (const Place& place : map.places) {
        EXPECT_GE(std::min(place.at.x, place.at.y), 0.0) << place.name.english;
        EXPECT_LE(std::max(place.at.x, place.at.y), 8192.0) << place.name.english;
    }
}

/// The distance to the nearest piece of any road, less half its width, and the way of that piece.
std::pair<double, glm::dvec2> nearestRoad(const Map& map, const glm::dvec2& place) {
    std::pair<double, glm::dvec2> nearest{1e9, {1.0, 0.0}};
    for (const Road& road : map.roads)
        for (std::size_t k = 0; k + 1 < road.line.size(); ++k) {
            const glm::dvec2 from = road.line[k], piece = road.line[k + 1] - from;
            const double length = glm::length(piece);
            if (length < 1e-9) continue;
            const glm::dvec2 way = piece / length;
            const glm::dvec2 off = place - from - std::clamp(glm::dot(place - from, way), 0.0, length) * way;
            const double distance = glm::length(off) - 0.5 * road.width;
            if (distance < nearest.first) nearest = {distance, way};
        }
    return nearest;
}

TEST(BundledValley, HousesStandAlongTheirStreetsAndDiffer) {
    const Map& map = valleyMap();
    std::size_t houses = 0, aligned = 0, onStreet = 0;
    std::map<Building::Roof, std::size_t> roofs;
    std::set<Paint> walls, tops;
    std::set<int> shades;
    std::set<long> heights; // decimetres
    for (const Building& building : map.buildings) {
        if (!building.windows || building.landmark) continue;
        ++houses;
        ++roofs[building.roof];
        walls.insert(building.walls);
        tops.insert(building.top);
        shades.insert(building.shade);
        heights.insert(std::lround(10.0 * (building.eaves - building.base)));
        const auto& o = building.outline;
        ASSERT_EQ(o.size(), 4U);
        const glm::dvec2 middle = 0.25 * (o[0] + o[1] + o[2] + o[3]);
        const auto [distance, way] = nearestRoad(map, middle);
        const double along = std::abs(glm::dot(glm::normalize(o[1] - o[0]), way));
        if (along > 0.96 || along < 0.28) ++aligned;
        for (const glm::dvec2& corner : o) // walls that two share are built a little into each other
            if (nearestRoad(map, glm::mix(corner, middle, 0.15)).first < -0.5) ++onStreet;
    }
    EXPECT_GE(houses, 500U);
    EXPECT_GE(aligned, houses * 9 / 10) << "the ridge runs along or across the street";
    EXPECT_EQ(onStreet, 0U);
    for (const auto roof : {Building::Roof::gable, Building::Roof::hip, Building::Roof::flat})
        EXPECT_GE(roofs[roof], houses / 40);
    EXPECT_GE(walls.size(), 6U);
    EXPECT_GE(tops.size(), 4U);
    EXPECT_EQ(shades.size(), static_cast<std::size_t>(kShades));
    EXPECT_GE(heights.size(), 20U);
    EXPECT_GE(map.trees.size(), 300U);
}

// The area vectors of a closed solid's faces add up to nothing: here to that of the floor, which is left out.
TEST(Solid, IsClosedUnderEachRoof) {
    const Map& map = valleyMap();
    const ViewGround ground(map, {map.places.front().at, 400.0, 0.0});
    for (const auto roof :
         {Building::Roof::flat, Building::Roof::gable, Building::Roof::pyramid, Building::Roof::hip}) {
        Building building;
        building.outline = rectangle(map.places.front().at, {0.6, 0.8}, 14.0, 9.0);
        building.base = 430.0;
        building.eaves = 436.0;
        building.ridge = roof == Building::Roof::flat ? 436.0 : 440.0;
        building.roof = roof;
        building.windows = true;
        building.grounded = false;
        glm::dvec3 sum(0.0);
        std::size_t walls = 0;
        for (const Face& face : solidOf(building, ground, 1.0)) {
            for (std::size_t k = 1; k + 1 < face.corners.size(); ++k)
                sum += 0.5 * glm::cross(glm::dvec3(face.corners[k] - face.corners[0]),
                                        glm::dvec3(face.corners[k + 1] - face.corners[0]));
            if (!face.windows) continue;
            ++walls;
            const float bays = glm::dot(face.corners[1] - face.corners[0], face.windows->bays);
            EXPECT_NEAR(bays, std::round(bays), 1e-3F) << "no window is cut";
            EXPECT_GE(bays, 2.999F);
            EXPECT_NEAR(glm::dot(face.corners.back() - face.corners[0], face.windows->storeys), 2.0F, 1e-3F);
        }
        const double metre = 0.21 / 400.0;
        EXPECT_EQ(walls, 4U);
        EXPECT_NEAR(sum.x, 0.0, 1e-9);
        EXPECT_NEAR(sum.z, 0.0, 1e-9);
        EXPECT_NEAR(sum.y, 14.0 * 9.0 * metre * metre, 1e-7) << static_cast<int>(roof);
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
