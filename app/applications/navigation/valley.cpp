#include "app/applications/navigation/valley.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/drainage.h"
#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/town.h"
#include "app/applications/navigation/valley_plan.h"

namespace lumorph::navigation {
namespace {

constexpr int kCoarse = 257, kFine = 1025; ///< samples a side
constexpr double kCoarseSpacing = ValleyPlan::kSide / (kCoarse - 1), kFineSpacing = ValleyPlan::kSide / (kFine - 1);
constexpr double kRelief = 1650.0;   ///< no peak stands more above the water below, metres
constexpr double kSnowFrom = 1160.0; ///< metres over the sea
constexpr double kTreesTo = 960.0;

template <typename Each> void forGrid(int side, const Each& each) {
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) each(static_cast<std::size_t>(j * side + i), glm::dvec2(i, j));
}

/// One pass of a mean over neighbours of a square grid.
void soften(int side, std::vector<float>& values) {
    const std::vector<float> before = values;
    const auto at = [&](int x, int y) {
        return before[static_cast<std::size_t>(std::clamp(y, 0, side - 1) * side + std::clamp(x, 0, side - 1))];
    };
    forGrid(side, [&](std::size_t k, const glm::dvec2& cell) {
        const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
        values[k] = 0.25F * at(x, y) + 0.125F * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1)) +
                    0.0625F * (at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1));
    });
}

/// Distance to the nearest water on the coarse grid, and the water's level, without the steps that it has where another
/// bend of the river becomes the nearest.
struct Waters {
    std::vector<float> distance, level;
};

Waters watersOf(const ValleyPlan& plan) {
    Waters waters;
    forGrid(kCoarse, [&](std::size_t, const glm::dvec2& cell) {
        const ValleyPlan::Water water = plan.waterNear(kCoarseSpacing * cell);
        waters.distance.push_back(static_cast<float>(water.distance));
        waters.level.push_back(static_cast<float>(water.level));
    });
    for (int pass = 0; pass < 60; ++pass) soften(kCoarse, waters.level);
    return waters;
}

/// Mountains that streams have worn, on the coarse grid.
std::vector<float> mountains(const Waters& waters, std::uint64_t seed) {
    constexpr double kLiftedFrom = 60.0, kLiftedTo = 2000.0; // metres from the water
    constexpr double kLift = 24.0;                           // metres a round
    std::vector<float> heights = waters.level, uplift(heights.size());
    std::vector<std::uint8_t> outlets(heights.size());
    forGrid(kCoarse, [&](std::size_t k, const glm::dvec2& cell) {
        const auto distance = static_cast<double>(waters.distance[k]);
        outlets[k] = distance < 0.6 * kCoarseSpacing ? 1 : 0;
        const glm::dvec2 place = kCoarseSpacing * cell;
        const double rough = 0.5 + 0.5 * fractalAt(place / 1700.0, 3, seed);
        const double lifted = smoothStep(kLiftedFrom, kLiftedTo, distance);
        uplift[k] = static_cast<float>(kLift * lifted * (0.15 + 2.4 * rough * rough));
        const double ridges = 1.0 - 2.0 * std::abs(fractalAt(place / 900.0, 5, seed + 9));
        if (outlets[k] == 0)
            heights[k] += static_cast<float>(8.0 + 500.0 * lifted * ridges + 4.0 * noiseAt(cell, seed));
    });
    erode({kCoarse, kCoarse}, heights, outlets, uplift, 14);
    // The highest peaks stand out less.
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const double over = static_cast<double>(heights[k] - waters.level[k]);
        heights[k] = waters.level[k] + static_cast<float>(kRelief * std::tanh(over / kRelief));
    }
    return heights;
}

std::vector<float> roughened(const std::vector<float>& coarse, const Waters& waters, std::uint64_t seed) {
    const HeightMap map({kCoarse, kCoarse}, kCoarseSpacing, coarse);
    const HeightMap levels({kCoarse, kCoarse}, kCoarseSpacing, waters.level);
    std::vector<float> heights;
    heights.reserve(static_cast<std::size_t>(kFine) * kFine);
    forGrid(kFine, [&](std::size_t, const glm::dvec2& cell) {
        heights.push_back(static_cast<float>(map.at(kFineSpacing * cell, 0.0)));
    });
    for (int pass = 0; pass < 5; ++pass) soften(kFine, heights);
    forGrid(kFine, [&](std::size_t k, const glm::dvec2& cell) {
        const glm::dvec2 place = kFineSpacing * cell;
        const double over = static_cast<double>(heights[k]) - levels.at(place, 0.0);
        const double crags = 1.0 - 2.0 * std::abs(fractalAt(place / 150.0, 3, seed + 3));
        heights[k] += static_cast<float>(20.0 * crags * smoothStep(60.0, 700.0, over));
    });
    return heights;
}

/// The town's slope, valley floors, and the beds of river and lake.
void shapeWaters(const ValleyPlan& plan, const Waters& coarse, std::vector<float>& heights, std::vector<float>& water) {
    constexpr double kNear = 420.0, kKnown = 60.0; // metres from the water's edge
    const HeightMap distances({kCoarse, kCoarse}, kCoarseSpacing, coarse.distance);
    const HeightMap levels({kCoarse, kCoarse}, kCoarseSpacing, coarse.level);
    water.assign(heights.size(), std::numeric_limits<float>::quiet_NaN());
    forGrid(kFine, [&](std::size_t k, const glm::dvec2& cell) {
        const glm::dvec2 place = kFineSpacing * cell;
        const double far = distances.at(place, 0.0);
        // Beside an upper reach, land that drains farther down could lie below it.
        double height =
            std::max(static_cast<double>(heights[k]), levels.at(place, 0.0) + 2.0 + 0.02 * std::min(far, kNear));
        const double fromTown = glm::distance(place, plan.town);
        if (fromTown < 900.0) {
            const double gentle = ValleyPlan::kLakeLevel + 2.5 + 0.055 * std::max(0.0, plan.fromLake(place));
            height = std::lerp(height, gentle, 1.0 - smoothStep(430.0, 900.0, fromTown));
        }
        if (far < kNear) {
            const ValleyPlan::Water near = plan.waterNear(place);
            const double level = std::lerp(near.level, levels.at(place, 0.0), smoothStep(30.0, 220.0, near.distance));
            const double floor = level + 1.6 + 0.02 * std::max(0.0, near.distance);
            height = std::max(std::lerp(height, floor, 1.0 - smoothStep(50.0, kNear, near.distance)), level + 1.2);
            if (near.distance < 0.0) height = near.level - near.depth * smoothStep(0.0, 10.0, -near.distance) - 0.3;
            if (near.distance < kKnown) water[k] = static_cast<float>(near.level);
        }
        heights[k] = static_cast<float>(height);
    });
}

/// What grows and lies where.
class Cover {
public:
    Cover(const Map& map, const ValleyPlan& plan, const Waters& waters, std::uint64_t seed)
        : map_(map), plan_(plan), hamlets_(hamletsOf(plan)),
          distances_({kCoarse, kCoarse}, kCoarseSpacing, waters.distance), seed_(seed) {}

    [[nodiscard]] float woods(const glm::dvec2& place, std::size_t k) const {
        const auto height = static_cast<double>(map_.heights.heights()[k]);
        const double water = distances_.at(place, 0.0);
        double share = smoothStep(-0.08, 0.16, fractalAt(place / 520.0, 4, seed_ + 4));
        share *= 1.0 - smoothStep(kTreesTo - 170.0, kTreesTo, height + 60.0 * noiseAt(place / 90.0, seed_ + 5));
        share *= 1.0 - smoothStep(0.75, 1.15, glm::length(map_.heights.slopeAt(place, 0.0)));
        share *= smoothStep(40.0, 110.0, water) * smoothStep(520.0, 760.0, glm::distance(place, plan_.town));
        for (const Place& hamlet : hamlets_) share *= smoothStep(130.0, 240.0, glm::distance(place, hamlet.at));
        return static_cast<float>(share);
    }

    [[nodiscard]] glm::vec3 color(const glm::dvec2& place, std::size_t k) const {
        const auto height = static_cast<double>(map_.heights.heights()[k]);
        const double steep = glm::length(map_.heights.slopeAt(place, 0.0));
        const double patch = fractalAt(place / 130.0, 3, seed_ + 6);
        glm::vec3 color =
            mixed({0.46F, 0.54F, 0.31F}, {0.58F, 0.58F, 0.40F}, smoothStep(520.0, 1100.0, height + 90.0 * patch));
        color = mixed(color, {0.28F, 0.38F, 0.22F}, 0.85 * static_cast<double>(map_.woods[k]));
        color = mixed(color, {0.62F, 0.58F, 0.52F},
                      smoothStep(0.62, 1.05, steep + 0.18 * patch) * smoothStep(600.0, 900.0, height));
        color = mixed(color, {0.66F, 0.63F, 0.58F}, smoothStep(960.0, 1110.0, height + 70.0 * patch));
        const double snow =
            smoothStep(kSnowFrom - 60.0, kSnowFrom + 60.0, height + 130.0 * patch - 150.0 * std::max(0.0, steep - 0.8));
        color = mixed(color, {0.96F, 0.97F, 1.0F}, snow);
        color = mixed(color, {0.58F, 0.55F, 0.47F},
                      0.7 * (1.0 - smoothStep(180.0, 380.0, glm::distance(place, plan_.town) + 90.0 * patch)));
        const double water = distances_.at(place, 0.0);
        if (!std::isnan(map_.water[k])) color = shore(color, static_cast<double>(map_.water[k]) - height, water);
        return color * static_cast<float>(1.0 + 0.05 * patch);
    }

private:
    static glm::vec3 mixed(const glm::vec3& a, const glm::vec3& b, double share) {
        return glm::mix(a, b, static_cast<float>(share));
    }
    static glm::vec3 shore(const glm::vec3& land, double depth, double distance) {
        const glm::vec3 sand(0.78F, 0.72F, 0.57F), shallow(0.40F, 0.60F, 0.62F), deep(0.10F, 0.34F, 0.48F);
        if (depth <= 0.0) return mixed(sand, land, smoothStep(4.0, 22.0, distance));
        return mixed(shallow, deep, smoothStep(0.5, 14.0, depth));
    }

    const Map& map_;
    const ValleyPlan& plan_;
    std::vector<Place> hamlets_;
    HeightMap distances_;
    std::uint64_t seed_;
};

void addCover(Map& map, const ValleyPlan& plan, const Waters& waters, std::uint64_t seed) {
    const Cover cover(map, plan, waters, seed);
    map.woods.resize(map.heights.heights().size());
    map.cover.resize(map.woods.size());
    forGrid(kFine, [&](std::size_t k, const glm::dvec2& cell) {
        map.woods[k] = cover.woods(kFineSpacing * cell, k);
        map.cover[k] = cover.color(kFineSpacing * cell, k);
    });
}

/// The highest place that is some way off all others named so far.
glm::dvec2 peakOf(const Map& map, const std::vector<Place>& known) {
    constexpr double kApart = 1500.0, kRim = 500.0;
    glm::dvec2 peak(0.0);
    float highest = 0.0F;
    forGrid(kFine, [&](std::size_t k, const glm::dvec2& cell) {
        const glm::dvec2 place = kFineSpacing * cell;
        const glm::dvec2 inside = glm::min(place, map.heights.size() - place);
        if (map.heights.heights()[k] <= highest || std::min(inside.x, inside.y) < kRim) return;
        if (std::ranges::any_of(known, [&](const Place& p) { return glm::distance(p.at, place) < kApart; })) return;
        highest = map.heights.heights()[k];
        peak = place;
    });
    return peak;
}

} // namespace

Map bundledValley(std::uint64_t seed, const Progress& progress) {
    progress.report(0.0, "Raising mountains");
    const ValleyPlan plan = planValley(seed);
    const Waters waters = watersOf(plan);
    std::vector<float> heights = roughened(mountains(waters, seed), waters, seed);
    progress.throwIfCancelled();
    progress.report(0.5, "Filling the lake");
    Map map;
    map.title = "The valley of the Orra";
    shapeWaters(plan, waters, heights, map.water);
    std::vector<std::uint8_t> outlets(heights.size());
    for (std::size_t k = 0; k < heights.size(); ++k) outlets[k] = map.water[k] > heights[k] ? 1 : 0;
    (void)drain({kFine, kFine}, heights, outlets, 2e-3F);
    map.heights = HeightMap({kFine, kFine}, kFineSpacing, std::move(heights));
    progress.throwIfCancelled();
    progress.report(0.7, "Planting woods");
    addCover(map, plan, waters, seed);
    progress.report(0.9, "Building the town");
    settle(map, plan, seed);
    for (const Words& name : {Words("Kestrel Horn", "Falkenhorn"), Words("Grey Tooth", "Grauzahn"),
                              Words("Long Back", "Langer Rücken"), Words("Widow's Peak", "Witwenspitze")})
        map.places.push_back({name, peakOf(map, map.places), 2600.0, 1});
    return map;
}

} // namespace lumorph::navigation
