#include "app/applications/navigation/town.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/builder.h"
#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

using Line = std::vector<glm::dvec2>;
constexpr std::size_t kMostHouses = 740;
constexpr glm::vec3 kPaving{0.66F, 0.62F, 0.56F}, kStreet{0.62F, 0.59F, 0.54F}, kCountryRoad{0.80F, 0.75F, 0.65F};

void boat(Builder& builder, const glm::dvec2& at, const glm::dvec2& along) {
    const glm::dvec2 across(-along.y, along.x);
    const double level = ValleyPlan::kLakeLevel;
    Building hull;
    hull.outline = {at - 4.5 * along - 1.5 * across, at + 2.0 * along - 1.8 * across, at + 6.0 * along,
                    at + 2.0 * along + 1.8 * across, at - 4.5 * along + 1.5 * across};
    hull.grounded = false;
    hull.base = level - 0.3;
    hull.eaves = hull.ridge = level + 1.5;
    hull.walls = Paint::wood;
    hull.top = Paint::sand;
    builder.map().buildings.push_back(hull);
    Building sail;
    sail.outline = rectangle(at, along, 6.0, 0.5);
    sail.grounded = false;
    sail.base = level + 2.2;
    sail.eaves = sail.base + 0.4;
    sail.ridge = sail.base + 10.0;
    sail.roof = Building::Roof::pyramid;
    sail.walls = sail.top = Paint::sail;
    builder.map().buildings.push_back(sail);
}

/// Jetties, store houses, a light and boats.
void harbour(Builder& builder) {
    const ValleyPlan& plan = builder.plan();
    for (const double along : {-120.0, -40.0, 50.0}) {
        const glm::dvec2 from = builder.inTown(along, 12.0), to = builder.inTown(along, -62.0);
        const glm::dvec2 way = glm::normalize(to - from);
        Building& jetty = builder.add(rectangle(0.5 * (from + to), way, glm::distance(from, to), 5.0), 0.0, 0.0,
                                      Building::Roof::flat);
        jetty.grounded = false;
        jetty.base = ValleyPlan::kLakeLevel - 1.5;
        jetty.eaves = jetty.ridge = ValleyPlan::kLakeLevel + 1.5;
        jetty.walls = jetty.top = Paint::wood;
        for (const double out : {18.0, 34.0, 50.0})
            boat(builder, from + (out + 12.0) * way + (builder.chance() < 0.5 ? 7.5 : -7.5) * glm::dvec2(-way.y, way.x),
                 way);
    }
    const glm::dvec2 head = builder.inTown(175.0, -20.0);
    Building& mole =
        builder.add(rectangle(builder.inTown(175.0, 12.0), plan.inland, 90.0, 10.0), 0.0, 0.0, Building::Roof::flat);
    mole.grounded = false;
    mole.base = ValleyPlan::kLakeLevel - 4.0;
    mole.eaves = mole.ridge = ValleyPlan::kLakeLevel + 2.2;
    mole.walls = mole.top = Paint::stone;
    Building& light = builder.add(roundOutline(head, 3.6, 8), 0.0, 0.0, Building::Roof::pyramid);
    light.grounded = false;
    light.base = ValleyPlan::kLakeLevel;
    light.eaves = light.base + 19.0;
    light.ridge = light.eaves + 6.0;
    light.walls = Paint::white;
    light.top = Paint::brick;
    light.landmark = true;
    for (int k = 0; k < 9; ++k) {
        const double angle = builder.chance() * 2.0 * std::numbers::pi;
        const glm::dvec2 way(std::cos(angle), std::sin(angle));
        boat(builder, builder.inTown(-260.0 + 640.0 * builder.chance(), -110.0 - 420.0 * builder.chance()), way);
    }
    builder.map().places.push_back({{"Harbour", "Hafen"}, builder.inTown(0.0, 8.0), 420.0, 3});
    builder.map().places.push_back({{"Lighthouse", "Leuchtturm"}, head, 420.0, 4});
}

/// A building that everybody knows: it stands out of the rows.
Building& big(Builder& builder, Line outline, double height, double roof, Building::Roof kind, Paint walls, Paint top) {
    Building& made = builder.add(std::move(outline), height, roof, kind);
    made.walls = walls;
    made.top = top;
    made.windows = made.landmark = true;
    return made;
}

/// The market square with the town hall, its well and the church in its yard.
void square(Builder& builder) {
    const ValleyPlan& plan = builder.plan();
    const glm::dvec2 square = plan.town;
    const glm::dvec2 along = glm::normalize(builder.inTown(40.0, 185.0) - builder.inTown(-40.0, 185.0));
    builder.map().parcels.push_back({rectangle(square, along, 84.0, 60.0), kPaving, 0.0F});
    builder.take(rectangle(square, along, 78.0, 54.0));
    const glm::dvec2 church = square + 62.0 * plan.inland + 12.0 * along;
    const Line yard = rectangle(church, along, 86.0, 40.0);
    builder.map().parcels.push_back({yard, {0.42F, 0.50F, 0.29F}, 0.0F, 1.2});
    builder.church(church, along, 23.0);
    for (int k = 0; k < 14; ++k)
        builder.tree(church + 80.0 * (builder.chance() - 0.5) * along +
                         (k % 2 == 0 ? 1.0 : -1.0) * (13.0 + 4.0 * builder.chance()) * plan.inland,
                     7.0 + 3.0 * builder.chance());
    builder.take(yard);
    big(builder, rectangle(square - 42.0 * along, plan.inland, 30.0, 15.0), 12.0, 8.0, Building::Roof::hip, Paint::rose,
        Paint::slate);
    Building& belfry = big(builder, rectangle(square - 42.0 * along, along, 5.5, 5.5), 23.0, 8.0,
                           Building::Roof::pyramid, Paint::rose, Paint::copper);
    belfry.windows = false;
    Building& well = builder.add(roundOutline(square, 3.0, 8), 1.5, 3.5, Building::Roof::pyramid);
    well.walls = Paint::stone;
    well.top = Paint::copper;
    for (const double off : {-28.0, -14.0, 14.0, 28.0}) // limes along the sunny side
        builder.map().trees.push_back({square + off * along + 23.0 * plan.inland, 8.0});
}

/// Store houses at the quay, a school, and an abbey around its court.
void bigHouses(Builder& builder) {
    const auto alongAt = [&](double along, double inland) {
        return glm::normalize(builder.inTown(along + 10.0, inland) - builder.inTown(along - 10.0, inland));
    };
    for (const double along : {-210.0, -178.0, -146.0, 96.0, 128.0})
        big(builder, rectangle(builder.inTown(along, 39.0), alongAt(along, 39.0), 22.0, 14.0), 11.0, 6.5,
            Building::Roof::gable, Paint::brick, Paint::slate);
    big(builder, rectangle(builder.inTown(-175.0, 268.0), alongAt(-175.0, 268.0), 44.0, 15.0), 12.5, 6.5,
        Building::Roof::hip, Paint::straw, Paint::rust);
    const glm::dvec2 court = builder.inTown(165.0, 345.0), along = alongAt(165.0, 345.0);
    builder.map().parcels.push_back({rectangle(court, along, 40.0, 30.0), {0.44F, 0.52F, 0.30F}, 0.0F});
    const glm::dvec2 across(-along.y, along.x);
    for (const double side : {-1.0, 1.0}) {
        big(builder, rectangle(court + side * 18.0 * across, along, 50.0, 10.0), 9.0, 5.0, Building::Roof::gable,
            Paint::cream, Paint::tile);
        big(builder, rectangle(court + side * 21.0 * along, across, 28.0, 9.0), 9.0, 4.5, Building::Roof::gable,
            Paint::cream, Paint::tile);
    }
    builder.tree(court, 9.0);
}

/// A main street from the quay over the square to the land, streets along the shore and lanes between them.
void townStreets(Builder& builder) {
    const ValleyPlan& plan = builder.plan();
    const auto at = [&](double along, double inland) { return builder.inTown(along, inland); };
    const auto shoreStreet = [&](double inland, double from, double to) {
        Line line;
        for (double along = from; along < to + 1.0; along += 40.0) line.push_back(at(along, inland));
        return line;
    };
    builder.road({at(0.0, 22.0), at(0.0, 100.0), plan.town, at(0.0, 320.0), at(-30.0, 520.0), hamletsOf(plan)[1].at},
                 8.0, kStreet);
    builder.road(shoreStreet(22.0, -330.0, 400.0), 9.0, kPaving);
    builder.road(shoreStreet(150.0, -360.0, 390.0), 6.5, kStreet);
    for (const double inland : {78.0, 228.0, 305.0, 385.0})
        builder.road(shoreStreet(inland, -330.0 + 0.3 * inland, 360.0 - 0.35 * inland), 5.0, kStreet);
    for (const double lane : {-235.0, -118.0, 112.0, 215.0, 310.0})
        builder.road({at(lane, 22.0), at(lane + 8.0, 160.0), at(0.9 * lane, 300.0), at(0.75 * lane, 400.0)}, 4.5,
                     kStreet);
}

/// From the town up the river, and around the lake.
void countryRoads(Builder& builder) {
    const ValleyPlan& plan = builder.plan();
    const std::vector<Place> places = hamletsOf(plan);
    const auto beside = [&](double share, double off) {
        const auto k = static_cast<std::size_t>(share * static_cast<double>(plan.river.size() - 2));
        const glm::dvec2 way = glm::normalize(plan.river[k + 1] - plan.river[k]);
        return plan.river[k] + off * glm::dvec2(-way.y, way.x);
    };
    const auto ashore = [&](double angle) {
        angle += std::atan2(plan.town.y - plan.lake.y, plan.town.x - plan.lake.x);
        return plan.shorePoint(angle) + 75.0 * glm::dvec2(std::cos(angle), std::sin(angle));
    };
    const auto road = [&](Line through, double width) { builder.road(std::move(through), width, kCountryRoad); };
    road({builder.inTown(330.0, 150.0), beside(0.8, 75.0), beside(0.72, 75.0), places[0].at}, 7.0);
    road({places[0].at, beside(0.5, 80.0), beside(0.4, 70.0), beside(0.3, 75.0), places[2].at}, 6.0);
    road({beside(0.8, 75.0), beside(0.8, -75.0), ashore(0.9), ashore(1.3), ashore(1.7), ashore(2.1), places[3].at},
         7.0);
    builder.map().places.push_back({{"River Orra", "Fluss Orra"}, beside(0.62, 0.0), 1500.0, 2});
}

void townHouses(Builder& builder, const std::vector<Road>& streets) {
    const ValleyPlan& plan = builder.plan();
    for (const Road& street : streets)
        builder.housesAlong(street.line, street.width, {plan.town, 480.0, 0.62, kMostHouses});
    std::vector<Place>& places = builder.map().places;
    places.push_back({"Merinhaven", plan.town, 900.0, 0});
    places.push_back({{"Saint Alba's church", "Sankt-Alba-Kirche"}, plan.town + 62.0 * plan.inland, 330.0, 3});
    places.push_back({{"Lake Merin", "Merinsee"}, plan.lake + glm::dvec2(250.0, 150.0), 3600.0, 0});
}

/// The first of the two lanes that cross in a hamlet.
glm::dvec2 laneOf(const Builder& builder, int hamlet) {
    const double turn = 2.0 * std::numbers::pi * chanceOf({hamlet, 6}, builder.seed() + 78);
    return {std::cos(turn), std::sin(turn)};
}

void hamletLanes(Builder& builder) {
    const std::vector<Place> places = hamletsOf(builder.plan());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const glm::dvec2 along = laneOf(builder, static_cast<int>(k)), at = places[k].at;
        for (const glm::dvec2& way : {along, glm::dvec2(-along.y, along.x)})
            builder.road({at - 115.0 * way, at + 14.0 * glm::dvec2(-way.y, way.x), at + 125.0 * way}, 4.0,
                         kCountryRoad);
    }
}

/// Two dozen farms around a chapel each.
void hamletHouses(Builder& builder) {
    const std::vector<Place> places = hamletsOf(builder.plan());
    const std::vector<Road> roads = builder.streets();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const glm::dvec2 along = laneOf(builder, static_cast<int>(k)), across(-along.y, along.x);
        for (const glm::dvec2& way : {along + across, along - across, -along + across, -along - across}) {
            const glm::dvec2 at = places[k].at + 24.0 * way;
            if (!builder.free(rectangle(at, along, 34.0, 18.0), 1.0)) continue;
            builder.church(at, along, 11.0);
            break;
        }
        const Quarter quarter{places[k].at, 170.0, 0.0, builder.map().buildings.size() + 26};
        for (auto road = roads.rbegin(); road != roads.rend(); ++road) // the lanes first
            builder.housesAlong(road->line, road->width, quarter);
        builder.map().places.push_back(places[k]);
    }
}

/// On a height over the lake.
void castle(Builder& builder) {
    const ValleyPlan& plan = builder.plan();
    glm::dvec2 best = plan.town;
    double most = 0.0;
    for (int k = 0; k < 900; ++k) {
        const glm::dvec2 at = plan.town + 1500.0 * glm::dvec2(2.0 * chanceOf({k, 1}, builder.seed()) - 1.0,
                                                              2.0 * chanceOf({k, 2}, builder.seed()) - 1.0);
        const double far = glm::distance(at, plan.town), over = builder.ground(at) - ValleyPlan::kLakeLevel;
        if (far < 700.0 || far > 1500.0 || over < 50.0 || over > 260.0) continue;
        const double stands = builder.ground(at) - builder.map().heights.at(at, 300.0); // over the land around
        if (stands > most) {
            most = stands;
            best = at;
        }
    }
    const auto part = [&](Line outline, double height, double roof, Building::Roof kind, Paint top) {
        Building& made = builder.add(std::move(outline), height, roof, kind);
        made.walls = Paint::stone;
        made.top = top;
        made.landmark = true;
    };
    const std::vector<glm::dvec2> corners = roundOutline(best, 34.0, 6);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        part(rectangle(0.5 * (a + b), glm::normalize(b - a), glm::distance(a, b), 3.0), 11.0, 0.0, Building::Roof::flat,
             Paint::stone);
        part(roundOutline(a, 5.0, 8), 17.0, 7.0, Building::Roof::pyramid, Paint::brick);
    }
    part(rectangle(best, {0.8, 0.6}, 16.0, 16.0), 34.0, 11.0, Building::Roof::pyramid, Paint::brick);
    part(rectangle(best + glm::dvec2(-14.0, 10.0), {0.8, -0.6}, 22.0, 10.0), 13.0, 6.0, Building::Roof::gable,
         Paint::brick);
    builder.map().places.push_back({{"Castle Harrow", "Burg Harrow"}, best, 620.0, 2});
}

} // namespace

std::vector<Place> hamletsOf(const ValleyPlan& plan) {
    const auto beside = [&](double share, double off) {
        const auto k = static_cast<std::size_t>(share * static_cast<double>(plan.river.size() - 2));
        const glm::dvec2 way = glm::normalize(plan.river[k + 1] - plan.river[k]);
        return plan.river[k] + off * glm::dvec2(-way.y, way.x);
    };
    const auto ashore = [&](double angle) {
        return plan.shorePoint(angle) + 120.0 * glm::dvec2(std::cos(angle), std::sin(angle));
    };
    const double town = std::atan2(plan.town.y - plan.lake.y, plan.town.x - plan.lake.x);
    return {{"Fennick", beside(0.6, 190.0), 620.0, 2},
            {{"Upper Mill", "Obermühle"}, plan.town + 1150.0 * plan.inland + glm::dvec2(-160.0, 60.0), 620.0, 2},
            {"Stonewater", beside(0.22, 170.0), 620.0, 2},
            {"Lowmoor", ashore(town + 2.6), 620.0, 2}};
}

void settle(Map& map, const ValleyPlan& plan, std::uint64_t seed) {
    Builder builder(map, plan, seed);
    square(builder);
    townStreets(builder);
    const std::vector<Road> streets = builder.streets();
    countryRoads(builder);
    hamletLanes(builder);
    harbour(builder);
    bigHouses(builder);
    townHouses(builder, streets);
    hamletHouses(builder);
    castle(builder);
    const std::vector<Road> roads = builder.streets();
    for (const Road& road : roads)
        if (road.color == kCountryRoad) builder.avenue(road, 15.0);
    builder.avenue(roads.front(), 15.0);
    layFields(builder);
}

} // namespace lumorph::navigation
