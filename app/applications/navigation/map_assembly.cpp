#include "app/applications/navigation/map_assembly.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"
#include "core/base/error.h"

namespace lumorph::navigation {
namespace {

constexpr double kUnknownHeight = 6.0;     ///< metres, of a building
constexpr double kSmallest = 4.0;          ///< square metres of an outline
constexpr int kLevelSamples = 129;         ///< of ground without heights, along its longer side
constexpr std::size_t kMostCorners = 1000; ///< of an outline

/// Rounds in which each missing height becomes the mean of its known neighbours.
void fillHoles(glm::ivec2 samples, std::vector<float>& heights) {
    const auto columns = static_cast<std::size_t>(samples.x);
    const auto eachNeighbour = [&](std::size_t k, const auto& use) {
        if (k % columns > 0) use(k - 1);
        if (k % columns + 1 < columns) use(k + 1);
        if (k >= columns) use(k - columns);
        if (k + columns < heights.size()) use(k + columns);
    };
    std::vector<bool> isQueued(heights.size(), false);
    std::vector<std::size_t> edge; // missing beside known ones
    const auto queueMissing = [&](std::size_t k) {
        if (std::isfinite(heights[k]) || isQueued[k]) return;
        isQueued[k] = true;
        edge.push_back(k);
    };
    std::size_t known = 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        if (!std::isfinite(heights[k])) continue;
        ++known;
        eachNeighbour(k, queueMissing);
    }
    if (known == 0 && !heights.empty()) throw InvalidInput("heights", "all of them are missing", "choose another file");
    while (!edge.empty()) {
        std::vector<std::pair<std::size_t, float>> found;
        found.reserve(edge.size());
        for (const std::size_t k : edge) {
            float sum = 0.0F;
            int count = 0;
            eachNeighbour(k, [&](std::size_t n) {
                if (!std::isfinite(heights[n])) return;
                sum += heights[n];
                ++count;
            });
            found.emplace_back(k, sum / static_cast<float>(count));
        }
        for (const auto& [k, height] : found) heights[k] = height;
        edge.clear();
        for (const auto& [k, height] : found) eachNeighbour(k, queueMissing);
    }
}

double medianOf(std::vector<double> values, double share = 0.5) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, values.begin() + at);
    return values[static_cast<std::size_t>(at)];
}

/// Leaves out what lies far from nearly all: one house at 0 degrees would make a map of half a continent.
void leaveOutTheFar(MapSources& sources, MapReport& report) {
    constexpr double kMost = 0.9, kFarther = 10.0, kNear = 5000.0; ///< share; times as far as those; metres
    std::vector<double> x, y, distances;
    const auto each = [&](const auto& use) {
        for (const auto& outline : sources.outlines) use(outline.ring.front());
        for (const auto& line : sources.lines) use(line.points.empty() ? glm::dvec2(0.0) : line.points.front());
        for (const auto& name : sources.names) use(name.at);
    };
    each([&](const glm::dvec2& p) {
        x.push_back(p.x);
        y.push_back(p.y);
    });
    if (x.size() < 3) return; // two places have no middle
    const glm::dvec2 middle(medianOf(x), medianOf(y));
    each([&](const glm::dvec2& p) { distances.push_back(glm::distance(p, middle)); });
    const double far = kFarther * medianOf(distances, kMost) + kNear;
    const auto isFar = [&](const glm::dvec2& p) { return !(glm::distance(p, middle) <= far); };
    report.leftOut +=
        std::erase_if(sources.outlines, [&](const auto& outline) { return isFar(outline.ring.front()); }) +
        std::erase_if(sources.lines,
                      [&](const auto& line) { return line.points.empty() || isFar(line.points.front()); }) +
        std::erase_if(sources.names, [&](const auto& name) { return isFar(name.at); });
}

/// Level ground under all that there is.
void levelGround(MapSources& sources, MapReport& report) {
    leaveOutTheFar(sources, report);
    glm::dvec2 min(std::numeric_limits<double>::infinity()), max = -min;
    const auto take = [&](const glm::dvec2& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    };
    for (const auto& outline : sources.outlines) std::ranges::for_each(outline.ring, take);
    for (const auto& line : sources.lines) std::ranges::for_each(line.points, take);
    for (const auto& name : sources.names) take(name.at);
    if (!(min.x <= max.x)) throw InvalidInput("map", "it has neither heights nor outlines", "choose other files");
    constexpr double kWidest = 2e6; // metres
    if (!(max.x - min.x <= kWidest && max.y - min.y <= kWidest))
        throw InvalidInput("map", "its things lie too far apart for one map", "choose files of one place");
    const double margin = std::max(60.0, 0.1 * std::max(max.x - min.x, max.y - min.y));
    min -= margin;
    max += margin;
    sources.spacing = std::max(max.x - min.x, max.y - min.y) / (kLevelSamples - 1);
    sources.samples = glm::ivec2(glm::ceil((max - min) / sources.spacing)) + 1;
    sources.origin = {min.x, max.y};
    sources.heights.assign(static_cast<std::size_t>(sources.samples.x) * static_cast<std::size_t>(sources.samples.y),
                           0.0F);
    report.notes.emplace_back("No file has heights: the ground is level.",
                              "Keine Datei enthält Höhen: Der Boden ist eben.");
}

void addSea(Map& map) {
    const std::vector<float>& heights = map.heights.heights();
    const auto wet = std::ranges::count_if(heights, [](float h) { return h <= 0.0F; });
    if (map.heights.highest() <= 1.0 || wet < std::ssize(heights) / 200) return;
    map.water.assign(heights.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t k = 0; k < heights.size(); ++k)
        if (heights[k] <= 3.0F) map.water[k] = 0.3F;
}

/// Green below, rock where it is steep, snow on what is high for such a place.
void addColors(Map& map) {
    std::vector<float> sorted = map.heights.heights();
    std::ranges::sort(sorted);
    const double low = static_cast<double>(sorted[sorted.size() / 50]), high = static_cast<double>(sorted.back());
    const double relief = std::max(high - low, 1.0);
    const glm::ivec2 samples = map.heights.samples();
    const double spacing = map.heights.spacing();
    map.cover.reserve(sorted.size());
    for (int y = 0; y < samples.y; ++y)
        for (int x = 0; x < samples.x; ++x) {
            const glm::dvec2 place = spacing * glm::dvec2(x, y);
            const double height = static_cast<double>(map.heights.at(glm::ivec2(x, y)));
            const double steep = glm::length(map.heights.slopeAt(place, 0.0)), share = (height - low) / relief;
            const double patch = 0.5 * noiseAt(glm::dvec2(x, y) / 17.0, 3) + 0.5 * noiseAt(glm::dvec2(x, y) / 5.0, 4);
            const auto mixed = [](const glm::vec3& a, const glm::vec3& b, double t) {
                return glm::mix(a, b, static_cast<float>(t));
            };
            glm::vec3 color =
                mixed({0.50F, 0.62F, 0.32F}, {0.68F, 0.66F, 0.42F}, smoothStep(0.1, 0.6, share + 0.1 * patch));
            color = mixed(color, {0.64F, 0.60F, 0.54F}, smoothStep(0.5, 1.0, steep + 0.2 * patch));
            if (relief > 500.0)
                color = mixed(color, {0.96F, 0.97F, 1.0F}, smoothStep(0.72, 0.84, share + 0.06 * patch));
            if (height <= 0.0 && !map.water.empty())
                color = mixed({0.42F, 0.68F, 0.70F}, {0.10F, 0.34F, 0.48F}, smoothStep(0.0, 30.0, -height));
            map.cover.push_back(color * static_cast<float>(1.0 + 0.04 * patch));
        }
}

/// A roof with a ridge along the longer sides, where the outline has four; else a flat one of the same height.
void addRoof(Building& building, const BuildingShape& shape) {
    std::vector<glm::dvec2>& outline = building.outline;
    const bool ridged = outline.size() == 4 || shape.form == Building::Roof::pyramid;
    if (building.whole || shape.form == Building::Roof::flat || !(shape.roof > 0.0) || !ridged) return;
    building.roof = shape.form;
    building.eaves = building.ridge - std::min(shape.roof, building.ridge - building.base - building.over);
    if (outline.size() == 4 && glm::distance(outline[1], outline[2]) > glm::distance(outline[0], outline[1]))
        std::rotate(outline.begin(), outline.begin() + 1, outline.end());
}

void addBuilding(Map& map, const std::vector<glm::dvec2>& ring, const std::vector<std::vector<glm::dvec2>>& holes,
                 const BuildingShape& shape, std::size_t number) {
    constexpr Paint kTops[] = {Paint::tile, Paint::brick, Paint::slate, Paint::ochre, Paint::rust};
    double base = std::numeric_limits<double>::infinity();
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& p : ring) {
        base = std::min(base, map.heights.at(p, 0.0));
        middle += p / static_cast<double>(ring.size());
    }
    std::vector<std::vector<glm::dvec2>> parts = convexParts(ring, holes);
    for (std::vector<glm::dvec2>& part : parts) {
        Building building;
        building.outline = std::move(part);
        building.base = base;
        building.over = shape.from;
        building.eaves = building.ridge = base + shape.height.value_or(kUnknownHeight + shape.from);
        building.walls = Paint::cream;
        building.top = kTops[number % std::size(kTops)];
        if (parts.size() > 1) building.whole = middle;
        addRoof(building, shape);
        map.buildings.push_back(std::move(building));
    }
}

/// From easting and northing to places of the map.
class Assembly {
public:
    Assembly(const MapSources& sources, Map& map, MapReport& report) : sources_(sources), map_(map), report_(report) {}

    void addOutlines() {
        std::vector<std::pair<double, std::size_t>> order; // the largest first
        std::vector<std::vector<glm::dvec2>> rings;
        for (std::size_t k = 0; k < sources_.outlines.size(); ++k) {
            std::vector<glm::dvec2> ring = placesOf(sources_.outlines[k].ring);
            if (doubleArea(ring) < 0.0) std::ranges::reverse(ring);
            const double area = 0.5 * doubleArea(ring);
            const bool inside = std::ranges::all_of(ring, [&](const glm::dvec2& p) { return onMap(p); });
            if (ring.size() < 3 || ring.size() > kMostCorners || area < kSmallest || !inside)
                ++report_.leftOut;
            else
                order.emplace_back(-area, k);
            rings.push_back(std::move(ring));
        }
        std::ranges::sort(order);
        if (order.size() > kMostBuildings) {
            const std::string all = std::to_string(order.size()), shown = std::to_string(kMostBuildings);
            report_.notes.emplace_back("Of " + all + " buildings the " + shown + " largest are shown.",
                                       "Von " + all + " Gebäuden sind die " + shown + " größten zu sehen.");
            order.resize(kMostBuildings);
        }
        for (const auto& [area, k] : order) add(sources_.outlines[k], rings[k], k);
    }

    void addLines() {
        for (const MapSources::Line& line : sources_.lines) {
            std::vector<glm::dvec2> points = placesOf(line.points);
            std::erase_if(points, [&](const glm::dvec2& p) { return !onMap(p); });
            if (points.size() < 2) {
                ++report_.leftOut;
                continue;
            }
            Road road;
            road.line = std::move(points);
            road.width = line.width;
            map_.roads.push_back(std::move(road));
            ++report_.roads;
        }
    }

    void addNames() {
        for (const MapSources::Name& name : sources_.names) {
            const glm::dvec2 at = placeOf(name.at);
            if (!onMap(at)) {
                ++report_.leftOut;
                continue;
            }
            map_.places.push_back({name.text, at, name.width, name.rank});
            ++report_.places;
        }
        std::ranges::stable_sort(map_.places, {}, &Place::rank);
        addSummit();
    }

private:
    [[nodiscard]] glm::dvec2 placeOf(const glm::dvec2& p) const {
        return {p.x - sources_.origin.x, sources_.origin.y - p.y};
    }
    [[nodiscard]] std::vector<glm::dvec2> placesOf(const std::vector<glm::dvec2>& points) const {
        std::vector<glm::dvec2> places;
        places.reserve(points.size());
        for (const glm::dvec2& p : points) places.push_back(placeOf(p));
        return places;
    }
    [[nodiscard]] bool onMap(const glm::dvec2& p) const {
        const glm::dvec2 size = map_.heights.size();
        return p.x >= 0.0 && p.y >= 0.0 && p.x <= size.x && p.y <= size.y;
    }
    void add(const MapSources::Outline& outline, const std::vector<glm::dvec2>& ring, std::size_t number) {
        if (!outline.shape.height) ++report_.heightMissing;
        glm::dvec2 middle(0.0);
        for (const glm::dvec2& p : ring) middle += p / static_cast<double>(ring.size());
        if (!outline.name.empty()) map_.places.push_back({outline.name, middle, 500.0, 4});
        std::vector<std::vector<glm::dvec2>> holes;
        std::size_t corners = ring.size();
        for (const auto& hole : outline.holes) // as many as are seen: joining them takes the square of their corners
            if ((corners += hole.size()) <= 4 * kMostCorners) holes.push_back(placesOf(hole));
        addBuilding(map_, ring, holes, outline.shape, number);
        ++report_.buildings;
    }
    void addSummit() {
        if (sources_.heights.empty() || map_.heights.highest() - map_.heights.lowest() < 1.0) return;
        const std::vector<float>& heights = map_.heights.heights();
        const auto k = static_cast<int>(std::ranges::max_element(heights) - heights.begin());
        const int columns = map_.heights.samples().x;
        const std::string metres = std::to_string(std::lround(map_.heights.highest())) + " m";
        map_.places.push_back({{"Summit, " + metres, "Gipfel, " + metres},
                               map_.heights.spacing() * glm::dvec2(k % columns, k / columns),
                               0.3 * map_.heights.size().x,
                               1});
    }

    const MapSources& sources_;
    Map& map_;
    MapReport& report_;
};

void tell(MapReport& report) {
    const auto note = [&](std::size_t count, const Words& one, const Words& many) {
        if (count == 0) return;
        const Words& what = count == 1 ? one : many;
        const std::string number = std::to_string(count) + " ";
        report.notes.emplace_back(number + what.english, number + what.german);
    };
    note(report.heightMissing,
         {"building has no height in the file: it is drawn 6 m high.",
          "Gebäude hat in der Datei keine Höhe und wird 6 m hoch gezeigt."},
         {"buildings have no height in the file: they are drawn 6 m high.",
          "Gebäude haben in der Datei keine Höhe und werden 6 m hoch gezeigt."});
    note(report.mended, {"outline crossed itself and was mended.", "Umriss kreuzte sich selbst und wurde berichtigt."},
         {"outlines crossed themselves and were mended.", "Umrisse kreuzten sich selbst und wurden berichtigt."});
    note(report.closed, {"ring was not closed and was closed.", "Ring war offen und wurde geschlossen."},
         {"rings were not closed and were closed.", "Ringe waren offen und wurden geschlossen."});
    note(report.leftOut,
         {"thing was left out: beyond the ground, too small, or without a usable outline.",
          "Ding fehlt: jenseits des Bodens, zu klein oder ohne brauchbaren Umriss."},
         {"things were left out: beyond the ground, too small, or without a usable outline.",
          "Dinge fehlen: jenseits des Bodens, zu klein oder ohne brauchbaren Umriss."});
    if (report.filled > 0.0) {
        char share[16];
        (void)std::snprintf(share, sizeof share, "%.2f", std::max(100.0 * report.filled, 0.01));
        const bool few = report.filled < 0.0001;
        const std::string percent = (few ? "Less than " : "") + std::string(share);
        std::string withComma = (few ? "Weniger als " : "") + std::string(share);
        std::ranges::replace(withComma, '.', ',');
        report.notes.emplace_back(percent + " % of the heights were missing and are filled from around.",
                                  withComma + " % der Höhen fehlten und sind aus ihrer Umgebung ergänzt.");
    }
}

} // namespace

Map assembled(MapSources sources, MapReport& report) {
    if (sources.heights.empty())
        levelGround(sources, report);
    else
        fillHoles(sources.samples, sources.heights);
    Map map;
    map.heights = HeightMap(sources.samples, sources.spacing, sources.heights);
    addSea(map);
    addColors(map);
    Assembly assembly(sources, map, report);
    assembly.addOutlines();
    assembly.addLines();
    assembly.addNames();
    tell(report);
    return map;
}

} // namespace lumorph::navigation
