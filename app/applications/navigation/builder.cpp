#include "app/applications/navigation/builder.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr Paint kRoofs[] = {Paint::tile, Paint::tile, Paint::brick, Paint::tile,
                            Paint::rust, Paint::rust, Paint::slate};
constexpr Paint kWalls[] = {Paint::white, Paint::cream, Paint::cream, Paint::sand,
                            Paint::rose,  Paint::straw, Paint::dove,  Paint::sage};
constexpr glm::vec3 kGardens[] = {
    {0.40F, 0.48F, 0.27F}, {0.46F, 0.53F, 0.31F}, {0.36F, 0.44F, 0.25F}, {0.52F, 0.47F, 0.35F}};
constexpr double kPartyWall = 0.7; ///< metres by which neighbours may share a wall

glm::dvec2 middleOf(const std::vector<glm::dvec2>& outline) {
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& corner : outline) middle += corner / static_cast<double>(outline.size());
    return middle;
}

double lengthOf(const std::vector<glm::dvec2>& line) {
    double length = 0.0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) length += glm::distance(line[k], line[k + 1]);
    return length;
}

struct OnLine {
    glm::dvec2 at, along;
};

OnLine pointOn(const std::vector<glm::dvec2>& line, double passed) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const double length = glm::distance(line[k], line[k + 1]);
        if (passed <= length || k + 2 == line.size()) {
            const glm::dvec2 along = (line[k + 1] - line[k]) / std::max(length, 1e-9);
            return {line[k] + passed * along, along};
        }
        passed -= length;
    }
    return {line.front(), {1.0, 0.0}};
}

} // namespace

bool Builder::free(const Line& outline, double gap) const {
    const glm::dvec2 middle = middleOf(outline);
    Line points = outline; // a street may lead between the corners
    points.push_back(middle);
    for (std::size_t k = 0; k < outline.size(); ++k)
        points.push_back(0.5 * (outline[k] + outline[(k + 1) % outline.size()]));
    for (const glm::dvec2& point : points) {
        if (map_.waterAt(point) > ground(point) - 0.6) return false;
        for (const Road& street : streets_)
            if (nearestOn(street.line, point).distance < 0.5 * street.width + gap) return false;
    }
    return std::ranges::none_of(taken_, [&](const Line& other) {
        return glm::distance(other.front(), middle) < 160.0 && overlap(other, outline);
    });
}

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
    building.base = ground(outline.front());
    for (const glm::dvec2& corner : outline) building.base = std::min(building.base, ground(corner));
    building.eaves = building.base + height;
    building.ridge = building.eaves + roof;
    building.roof = kind;
    building.shade = static_cast<std::uint8_t>(kShades * chanceOf({static_cast<int>(map_.buildings.size()), 9}, seed_));
    taken_.push_back(outline);
    building.outline = std::move(outline);
    map_.buildings.push_back(std::move(building));
    return map_.buildings.back();
}

bool Builder::house(const glm::dvec2& at, const glm::dvec2& along, double length, double depth, double storeys) {
    Line body = rectangle(at, along, length - kPartyWall, depth - kPartyWall);
    const Line outline = rectangle(at, along, length, depth);
    if (std::ranges::any_of(outline, [&](const glm::dvec2& corner) { return map_.isWater(map_.sampleAt(corner)); }) ||
        !free(body, 0.0))
        return false;
    const double kind = chance(), steep = 0.36 + 0.16 * chance();
    const auto roof = kind < 0.74 ? Building::Roof::gable : kind < 0.95 ? Building::Roof::hip : Building::Roof::flat;
    const double rises = roof == Building::Roof::flat ? 0.0 : steep * std::min(length, depth);
    Building& building = add(outline, 0.8 + 2.9 * storeys + 0.7 * chance(), rises, roof);
    taken_.back() = std::move(body);
    building.walls = oneOf(kWalls);
    building.top = roof == Building::Roof::flat ? Paint::stone : oneOf(kRoofs);
    building.windows = true;
    return true;
}

/// What belongs to a house outside the closed rows: grass or beds, and a tree or two.
void Builder::garden(const Plot& plot, double begins) {
    const double deep = 13.0 + 8.0 * chance(), wide = plot.front + 0.8 * plot.gap;
    const glm::dvec2 at = plot.at + (begins + 0.5 * deep) * plot.out;
    const Line outline = rectangle(at, plot.along, wide, deep);
    if (!free(outline, 0.5)) return;
    map_.parcels.push_back({outline, oneOf(kGardens), 0.0F, 1.1});
    for (int k = chance() < 0.5 ? 1 : 2; k > 0; --k)
        tree(at + wide * 0.7 * (chance() - 0.5) * plot.along + deep * 0.7 * (chance() - 0.5) * plot.out,
             5.0 + 4.0 * chance());
}

void Builder::plot(const Plot& plot, const Quarter& quarter) {
    const double far = glm::distance(plot.at, quarter.middle) / quarter.reach;
    const bool closed = far < quarter.closed;
    const double depth = closed ? 10.5 + 2.5 * chance() : 9.0 + 2.5 * chance();
    const double set = 0.5 * plot.width + (closed ? 1.2 + 0.5 * chance() : 3.0 + 3.5 * chance());
    const double storeys =
        closed ? 2.0 + std::floor(2.3 * chance() + 0.5 * (1.0 - far)) : 1.0 + std::floor(2.0 * chance());
    if (map_.buildings.size() >= quarter.most || chance() < far * far * far) return;
    if (!house(plot.at + (set + 0.5 * depth) * plot.out, plot.along, plot.front, depth, storeys)) return;
    const double behind = set + depth;
    if (!closed) return garden(plot, behind);
    if (chance() < 0.4) { // a wing in the court
        const double reaches = 7.0 + 5.0 * chance();
        house(plot.at + (behind + 0.5 * reaches - 0.4) * plot.out + 0.2 * plot.front * plot.along, plot.out, reaches,
              5.5, std::max(1.0, storeys - 1.0));
    } else if (chance() < 0.5) {
        tree(plot.at + (behind + 6.0) * plot.out, 6.0 + 3.0 * chance());
    }
}

void Builder::housesAlong(const Line& street, double width, const Quarter& quarter) {
    const double length = lengthOf(street);
    for (const double side : {-1.0, 1.0})
        for (double next = 5.0; next < length - 5.0;) {
            const double far = glm::distance(pointOn(street, next).at, quarter.middle) / quarter.reach;
            if (far >= 1.0) {
                next += 15.0;
                continue;
            }
            const bool closed = far < quarter.closed;
            Plot here;
            here.width = width;
            here.front = closed ? 8.5 + 5.0 * chance() : 9.5 + 4.5 * chance();
            here.gap = !closed ? 6.0 + 10.0 * chance() : chance() < 0.14 ? 4.5 : 0.0;
            const OnLine middle = pointOn(street, next + 0.5 * here.front);
            here.at = middle.at;
            here.along = middle.along;
            here.out = side * glm::dvec2(-middle.along.y, middle.along.x);
            plot(here, quarter);
            next += here.front + here.gap;
        }
}

void Builder::road(const Line& through, double width, const glm::vec3& color) {
    Road made;
    made.line = smoothLine(through, 15.0);
    made.width = width;
    made.color = color;
    bridge(made.line, width);
    streets_.push_back(made);
    map_.roads.push_back(std::move(made));
}

void Builder::tree(const glm::dvec2& at, double height) {
    const glm::dvec2 reach(1.5);
    const Line outline{at - reach, at + glm::dvec2(reach.x, -reach.y), at + reach, at + glm::dvec2(-reach.x, reach.y)};
    if (free(outline, 0.4)) map_.trees.push_back({at, height});
}

void Builder::avenue(const Road& road, double step) {
    const double length = lengthOf(road.line);
    for (double next = step; next < length; next += step)
        for (const double side : {-1.0, 1.0}) {
            const OnLine here = pointOn(road.line, next);
            if (chance() < 0.72)
                tree(here.at + side * (0.5 * road.width + 3.2) * glm::dvec2(-here.along.y, here.along.x),
                     7.0 + 4.0 * chance());
        }
}

/// Where a road meets the river, a deck of stone on piers carries it between two parapets.
void Builder::bridge(const Line& line, double width) {
    std::size_t first = line.size(), last = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (!map_.isWater(map_.sampleAt(line[k]))) continue;
        first = std::min(first, k);
        last = k;
    }
    if (first >= line.size() || last - first > 8) return;
    const glm::dvec2 from = line[first > 1 ? first - 2 : 0], to = line[std::min(last + 2, line.size() - 1)];
    const glm::dvec2 middle = 0.5 * (from + to), along = glm::normalize(to - from), across(-along.y, along.x);
    const double top = std::max(ground(from), ground(to)) + 0.9, length = glm::distance(from, to);
    const auto part = [&](Line outline, double low, double high, Paint paint) {
        Building& made = add(std::move(outline), 0.0, 0.0, Building::Roof::flat);
        made.base = low;
        made.eaves = made.ridge = high;
        made.walls = Paint::stone;
        made.top = paint;
        made.landmark = true;
        made.grounded = false;
    };
    part(rectangle(middle, along, length, width + 2.0), top - 1.4, top, Paint::sand);
    for (const double side : {-1.0, 1.0})
        part(rectangle(middle + side * (0.5 * width + 0.7) * across, along, length, 0.6), top, top + 1.1, Paint::stone);
    for (const double off : {-0.17, 0.17})
        part(rectangle(middle + off * length * along, along, 2.4, width + 5.0), top - 8.0, top - 1.3, Paint::stone);
}

void Builder::church(const glm::dvec2& at, const glm::dvec2& along, double size) {
    const auto part = [&](Line outline, double height, double roof, Building::Roof kind, Paint top) {
        Building& made = add(std::move(outline), height, roof, kind);
        made.walls = Paint::white;
        made.top = top;
        made.shade = 5;
        made.landmark = true;
    };
    const glm::dvec2 across(-along.y, along.x);
    part(rectangle(at, along, 1.7 * size, 0.7 * size), 0.62 * size, 0.46 * size, Building::Roof::gable, Paint::slate);
    part(rectangle(at + 0.35 * size * along, across, 1.15 * size, 0.45 * size), 0.5 * size, 0.3 * size,
         Building::Roof::gable, Paint::slate);
    part(roundOutline(at + 0.9 * size * along, 0.3 * size, 8), 0.5 * size, 0.3 * size, Building::Roof::pyramid,
         Paint::slate);
    part(rectangle(at - 1.05 * size * along, along, 0.45 * size, 0.45 * size), 1.3 * size, 1.15 * size,
         Building::Roof::pyramid, Paint::copper);
}

} // namespace lumorph::navigation
