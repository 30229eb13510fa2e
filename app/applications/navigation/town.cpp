#include "app/applications/navigation/town.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

using Line = std::vector<glm::dvec2>;
constexpr Paint kRoofs[] = {Paint::tile, Paint::tile, Paint::brick, Paint::rust, Paint::ochre, Paint::slate};
constexpr Paint kWalls[] = {Paint::white, Paint::cream, Paint::cream, Paint::sand, Paint::rose};
constexpr std::size_t kMostHouses = 330;

/// Builds on what is there, and remembers where there is no room any more.
class Builder {
public:
    Builder(Map& map, const ValleyPlan& plan, std::uint64_t seed) : map_(map), plan_(plan), seed_(seed) {}

    void town();
    void hamlets();
    void castle();
    void fields();

private:
    [[nodiscard]] double chance() { return chanceOf({++drawn_, 0}, seed_ + 77); }
    template <typename T, std::size_t N> const T& oneOf(const T (&choices)[N]) {
        return choices[std::min(N - 1, static_cast<std::size_t>(chance() * static_cast<double>(N)))];
    }
    [[nodiscard]] double ground(const glm::dvec2& place) const { return map_.heights.at(place, 0.0); }
    [[nodiscard]] double lowestUnder(const Line& outline) const;
    [[nodiscard]] bool free(const Line& outline, double gap) const;
    [[nodiscard]] glm::dvec2 inTown(double along, double inland) const;
    Building& add(Line outline, double height, double roof, Building::Roof kind);
    bool house(const glm::dvec2& at, const glm::dvec2& along, double length, double depth);
    void housesAlong(const Line& street, double width, double reach);
    void road(Line through, double width);
    void church(const glm::dvec2& at, const glm::dvec2& along, double size);
    void harbour();
    void bridge(const Line& road, double width);
    void boat(const glm::dvec2& at, const glm::dvec2& along);

    Map& map_;
    const ValleyPlan& plan_;
    std::uint64_t seed_;
    int drawn_ = 0;
    std::vector<Line> taken_;
    std::vector<Road> streets_;
};

double Builder::lowestUnder(const Line& outline) const {
    double low = ground(outline.front());
    for (const glm::dvec2& corner : outline) low = std::min(low, ground(corner));
    return low;
}

bool Builder::free(const Line& outline, double gap) const {
    glm::dvec2 centre(0.0);
    for (const glm::dvec2& corner : outline) centre += corner / static_cast<double>(outline.size());
    for (const glm::dvec2& corner : outline) {
        const double water = map_.waterAt(corner);
        if (water > ground(corner) - 0.6) return false;
        for (const Road& street : streets_)
            if (nearestOn(street.line, corner).distance < 0.5 * street.width + gap) return false;
    }
    return std::ranges::none_of(taken_, [&](const Line& other) {
        return glm::distance(other.front(), centre) < 120.0 && overlap(other, outline);
    });
}

/// Follows the shore: metres along it from the town's middle, and inland from the water.
glm::dvec2 Builder::inTown(double along, double inland) const {
    const glm::dvec2 middle = plan_.town - plan_.lake;
    const double angle = std::atan2(middle.y, middle.x) + along / glm::length(middle);
    const glm::dvec2 way(std::cos(angle), std::sin(angle));
    // The farther from the water, the less of its bays.
    const double radius =
        std::lerp(plan_.shoreAt(angle), glm::length(middle) - 185.0, std::clamp(inland / 500.0, 0.0, 0.7));
    return plan_.lake + (radius + inland) * way;
}

Building& Builder::add(Line outline, double height, double roof, Building::Roof kind) {
    Building building;
    building.base = lowestUnder(outline);
    building.eaves = building.base + height;
    building.ridge = building.eaves + roof;
    building.roof = kind;
    taken_.push_back(outline);
    building.outline = std::move(outline);
    map_.buildings.push_back(std::move(building));
    return map_.buildings.back();
}

bool Builder::house(const glm::dvec2& at, const glm::dvec2& along, double length, double depth) {
    Line outline = rectangle(at, along, length, depth);
    if (!free(outline, 0.6)) return false;
    Line wide = rectangle(at, along, length + 2.0, depth + 2.0);
    const double storeys = 1.0 + std::floor(2.4 * chance());
    Building& building = add(std::move(outline), 1.6 + 2.9 * storeys, 0.42 * depth, Building::Roof::gable);
    taken_.back() = std::move(wide);
    building.walls = oneOf(kWalls);
    building.top = oneOf(kRoofs);
    return true;
}

/// Houses stand with their eaves to the street, closest in the town's middle.
void Builder::housesAlong(const Line& street, double width, double reach) {
    double next = 6.0, passed = 0.0;
    for (std::size_t k = 0; k + 1 < street.size(); ++k) {
        const double length = glm::distance(street[k], street[k + 1]);
        const glm::dvec2 along = (street[k + 1] - street[k]) / std::max(length, 1e-9);
        for (; next < passed + length; next += 14.5 + 7.0 * chance())
            for (const double side : {-1.0, 1.0}) {
                const double front = 10.5 + 4.5 * chance(), depth = 9.0 + 3.5 * chance(), set = 1.5 + 2.0 * chance();
                const glm::dvec2 across(-along.y, along.x);
                const glm::dvec2 at =
                    street[k] + (next - passed) * along + side * (0.5 * width + set + 0.5 * depth) * across;
                const double far = glm::distance(at, plan_.town) / reach;
                if (map_.buildings.size() < kMostHouses && chance() > far * far * far) house(at, along, front, depth);
            }
        passed += length;
    }
}

void Builder::road(Line through, double width) {
    Road made;
    made.line = smoothLine(through, 15.0);
    made.width = width;
    bridge(made.line, width);
    streets_.push_back(made);
    map_.roads.push_back(std::move(made));
}

/// Where a road meets the river, a deck of stone carries it.
void Builder::bridge(const Line& line, double width) {
    std::size_t first = line.size(), last = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (!map_.isWater(map_.sampleAt(line[k]))) continue;
        first = std::min(first, k);
        last = k;
    }
    if (first >= line.size() || last - first > 8) return;
    const glm::dvec2 from = line[first > 1 ? first - 2 : 0], to = line[std::min(last + 2, line.size() - 1)];
    Line outline = rectangle(0.5 * (from + to), glm::normalize(to - from), glm::distance(from, to), width + 2.0);
    const double top = std::max(ground(from), ground(to)) + 0.9;
    Building& deck = add(std::move(outline), 0.0, 0.0, Building::Roof::flat);
    deck.base = top - 1.4;
    deck.eaves = deck.ridge = top;
    deck.walls = Paint::stone;
    deck.top = Paint::sand;
    deck.landmark = true;
    deck.grounded = false;
}

/// A nave with its tower, the tower's helmet pointed.
void Builder::church(const glm::dvec2& at, const glm::dvec2& along, double size) {
    Building& nave =
        add(rectangle(at, along, 1.7 * size, 0.75 * size), 0.55 * size, 0.42 * size, Building::Roof::gable);
    nave.walls = Paint::white;
    nave.top = Paint::slate;
    nave.landmark = true;
    const glm::dvec2 before = at - 1.1 * size * along;
    Building& tower =
        add(rectangle(before, along, 0.5 * size, 0.5 * size), 1.25 * size, 0.95 * size, Building::Roof::pyramid);
    tower.walls = Paint::white;
    tower.top = Paint::copper;
    tower.landmark = true;
}

void Builder::boat(const glm::dvec2& at, const glm::dvec2& along) {
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
    map_.buildings.push_back(hull);
    Building sail;
    sail.outline = rectangle(at, along, 6.0, 0.5);
    sail.grounded = false;
    sail.base = level + 2.2;
    sail.eaves = sail.base + 0.4;
    sail.ridge = sail.base + 10.0;
    sail.roof = Building::Roof::pyramid;
    sail.walls = sail.top = Paint::sail;
    map_.buildings.push_back(sail);
}

/// Jetties, store houses, a light and boats.
void Builder::harbour() {
    for (const double along : {-120.0, -40.0, 50.0}) {
        const glm::dvec2 from = inTown(along, 12.0), to = inTown(along, -62.0);
        const glm::dvec2 way = glm::normalize(to - from);
        Building& jetty =
            add(rectangle(0.5 * (from + to), way, glm::distance(from, to), 5.0), 0.0, 0.0, Building::Roof::flat);
        jetty.grounded = false;
        jetty.base = ValleyPlan::kLakeLevel - 1.5;
        jetty.eaves = jetty.ridge = ValleyPlan::kLakeLevel + 1.5;
        jetty.walls = jetty.top = Paint::wood;
        for (const double out : {18.0, 34.0, 50.0})
            boat(from + (out + 12.0) * way + (chance() < 0.5 ? 7.5 : -7.5) * glm::dvec2(-way.y, way.x), way);
    }
    const glm::dvec2 head = inTown(175.0, -20.0);
    Building& mole = add(rectangle(inTown(175.0, 12.0), plan_.inland, 90.0, 10.0), 0.0, 0.0, Building::Roof::flat);
    mole.grounded = false;
    mole.base = ValleyPlan::kLakeLevel - 4.0;
    mole.eaves = mole.ridge = ValleyPlan::kLakeLevel + 2.2;
    mole.walls = mole.top = Paint::stone;
    Building& light = add(roundOutline(head, 3.6, 8), 0.0, 0.0, Building::Roof::pyramid);
    light.grounded = false;
    light.base = ValleyPlan::kLakeLevel;
    light.eaves = light.base + 19.0;
    light.ridge = light.eaves + 6.0;
    light.walls = Paint::white;
    light.top = Paint::brick;
    light.landmark = true;
    for (int k = 0; k < 9; ++k) {
        const double angle = chance() * 2.0 * std::numbers::pi;
        const glm::dvec2 way(std::cos(angle), std::sin(angle));
        boat(inTown(-260.0 + 640.0 * chance(), -110.0 - 420.0 * chance()), way);
    }
    map_.places.push_back({{"Harbour", "Hafen"}, inTown(0.0, 8.0), 420.0, 3});
    map_.places.push_back({{"Lighthouse", "Leuchtturm"}, head, 420.0, 4});
}

void Builder::town() {
    const glm::dvec2 square = plan_.town;
    const glm::dvec2 along = glm::normalize(inTown(40.0, 185.0) - inTown(-40.0, 185.0));
    map_.parcels.push_back({rectangle(square, along, 84.0, 60.0), {0.86F, 0.80F, 0.70F}, 0.0F});
    taken_.push_back(rectangle(square, along, 78.0, 54.0));
    church(square + 62.0 * plan_.inland + 12.0 * along, along, 22.0);
    Building& hall = add(rectangle(square - 42.0 * along, plan_.inland, 30.0, 15.0), 12.0, 8.0, Building::Roof::gable);
    hall.walls = Paint::rose;
    hall.top = Paint::slate;
    hall.landmark = true;
    Building& well = add(roundOutline(square, 3.0, 8), 1.5, 3.5, Building::Roof::pyramid);
    well.walls = Paint::stone;
    well.top = Paint::copper;
    const auto ring = [&](double inland, double from, double to) {
        Line line;
        for (double at = from; at < to + 1.0; at += 40.0) line.push_back(inTown(at, inland));
        return line;
    };
    road({inTown(0.0, 22.0), inTown(0.0, 100.0), square, inTown(0.0, 320.0), inTown(-30.0, 520.0),
          hamletsOf(plan_)[1].at},
         8.0);
    road(ring(22.0, -330.0, 400.0), 8.0);
    road(ring(150.0, -360.0, 390.0), 6.5);
    for (const double inland : {78.0, 228.0, 305.0, 385.0})
        road(ring(inland, -330.0 + 0.3 * inland, 360.0 - 0.35 * inland), 5.0);
    for (const double lane : {-235.0, -118.0, 112.0, 215.0, 310.0})
        road({inTown(lane, 22.0), inTown(lane + 8.0, 160.0), inTown(0.9 * lane, 300.0), inTown(0.75 * lane, 400.0)},
             5.0);
    harbour();
    const std::vector<Road> town = streets_;
    for (const Road& street : town) housesAlong(street.line, street.width, 480.0);
    map_.places.push_back({"Merinhaven", square, 900.0, 0});
    map_.places.push_back({{"Saint Alba's church", "Sankt-Alba-Kirche"}, square + 62.0 * plan_.inland, 330.0, 3});
    map_.places.push_back({{"Lake Merin", "Merinsee"}, plan_.lake + glm::dvec2(250.0, 150.0), 3600.0, 0});
}

/// A dozen houses and a chapel each, and the roads to them.
void Builder::hamlets() {
    for (const Place& hamlet : hamletsOf(plan_)) {
        const double turn = 2.0 * std::numbers::pi * chance();
        const glm::dvec2 along(std::cos(turn), std::sin(turn));
        church(hamlet.at, along, 10.0);
        for (int k = 0; k < 60; ++k) {
            const double angle = 2.0 * std::numbers::pi * chance(), far = 28.0 + 95.0 * chance();
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            if (chance() < 0.4)
                house(hamlet.at + far * way, chance() < 0.5 ? along : glm::dvec2(-along.y, along.x), 13.0, 9.5);
        }
        map_.places.push_back(hamlet);
    }
    const std::vector<Place> at = hamletsOf(plan_);
    const auto beside = [&](double share, double off) {
        const auto k = static_cast<std::size_t>(share * static_cast<double>(plan_.river.size() - 2));
        const glm::dvec2 way = glm::normalize(plan_.river[k + 1] - plan_.river[k]);
        return plan_.river[k] + off * glm::dvec2(-way.y, way.x);
    };
    const auto ashore = [&](double angle) {
        angle += std::atan2(plan_.town.y - plan_.lake.y, plan_.town.x - plan_.lake.x);
        return plan_.shorePoint(angle) + 75.0 * glm::dvec2(std::cos(angle), std::sin(angle));
    };
    road({inTown(330.0, 150.0), beside(0.8, 75.0), beside(0.72, 75.0), at[0].at}, 7.0);
    road({at[0].at, beside(0.5, 80.0), beside(0.4, 70.0), beside(0.3, 75.0), at[2].at}, 6.0);
    road({beside(0.8, 75.0), beside(0.8, -75.0), ashore(0.9), ashore(1.3), ashore(1.7), ashore(2.1), at[3].at}, 7.0);
    map_.places.push_back({{"River Orra", "Fluss Orra"}, beside(0.62, 0.0), 1500.0, 2});
}

/// On a height over the lake.
void Builder::castle() {
    glm::dvec2 best = plan_.town;
    double most = 0.0;
    for (int k = 0; k < 900; ++k) {
        const glm::dvec2 at =
            plan_.town + 1500.0 * glm::dvec2(2.0 * chanceOf({k, 1}, seed_) - 1.0, 2.0 * chanceOf({k, 2}, seed_) - 1.0);
        const double far = glm::distance(at, plan_.town), over = ground(at) - ValleyPlan::kLakeLevel;
        if (far < 700.0 || far > 1500.0 || over < 50.0 || over > 260.0) continue;
        const double stands = ground(at) - map_.heights.at(at, 300.0); // over the land around
        if (stands > most) {
            most = stands;
            best = at;
        }
    }
    const auto part = [&](Line outline, double height, double roof, Building::Roof kind, Paint top) {
        Building& made = add(std::move(outline), height, roof, kind);
        made.walls = Paint::stone;
        made.top = top;
        made.landmark = true;
    };
    const Line corners = roundOutline(best, 34.0, 6);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        part(rectangle(0.5 * (a + b), glm::normalize(b - a), glm::distance(a, b), 3.0), 11.0, 0.0, Building::Roof::flat,
             Paint::stone);
        part(roundOutline(a, 5.0, 8), 17.0, 7.0, Building::Roof::pyramid, Paint::brick);
    }
    part(rectangle(best, {0.8, 0.6}, 16.0, 16.0), 34.0, 11.0, Building::Roof::pyramid, Paint::brick);
    part(rectangle(best + glm::dvec2(-14.0, 10.0), {0.8, -0.6}, 22.0, 10.0), 13.0, 6.0, Building::Roof::gable,
         Paint::brick);
    map_.places.push_back({{"Castle Harrow", "Burg Harrow"}, best, 620.0, 2});
}

/// Meadows and crops on flat ground around the settlements.
void Builder::fields() {
    constexpr glm::vec3 kCrops[] = {{0.80F, 0.72F, 0.38F}, {0.62F, 0.68F, 0.30F}, {0.72F, 0.60F, 0.38F},
                                    {0.50F, 0.62F, 0.28F}, {0.85F, 0.78F, 0.46F}, {0.44F, 0.56F, 0.27F}};
    constexpr double kCell = 118.0;
    for (int j = 0; j < static_cast<int>(ValleyPlan::kSide / kCell); ++j)
        for (int i = 0; i < static_cast<int>(ValleyPlan::kSide / kCell); ++i) {
            const glm::dvec2 at =
                kCell * (glm::dvec2(i, j) + 0.5 +
                         0.12 * glm::dvec2(chanceOf({i, j}, seed_ + 41), chanceOf({j, i}, seed_ + 42)));
            const double turn = 1.2 * noiseAt(at / 900.0, seed_ + 43);
            const glm::dvec2 along(std::cos(turn), std::sin(turn));
            const Line outline = rectangle(at, along, 62.0 + 44.0 * chanceOf({i, j}, seed_ + 44),
                                           60.0 + 40.0 * chanceOf({i, j}, seed_ + 45));
            const double over = ground(at) - ValleyPlan::kLakeLevel;
            if (over > 170.0 || glm::length(map_.heights.slopeAt(at, 60.0)) > 0.13 || map_.woodsAt(at) > 0.25) continue;
            if (glm::distance(at, plan_.town) < 560.0 || chanceOf({i, j}, seed_ + 46) < 0.22) continue;
            const bool wet = std::ranges::any_of(
                outline, [&](const glm::dvec2& p) { return !std::isnan(map_.waterAt(p)) || map_.woodsAt(p) > 0.5; });
            if (wet || !free(outline, 3.0)) continue;
            const auto crop = static_cast<std::size_t>(6.0 * chanceOf({i, j}, seed_ + 47));
            map_.parcels.push_back({outline, kCrops[crop], 0.35F});
        }
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
    builder.town();
    builder.hamlets();
    builder.castle();
    builder.fields();
}

} // namespace lumorph::navigation
