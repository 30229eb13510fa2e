#include "app/applications/navigation/valley_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr int kShorePoints = 360;
constexpr double kSource = 545.0, kLeaves = 408.0; ///< level of the river where it comes and goes, metres
constexpr double kInland = 185.0;                  ///< from the shore to the town's square, metres

/// A line through points as water goes: in bends.
std::vector<glm::dvec2> bent(const std::vector<glm::dvec2>& through, double by, std::uint64_t seed) {
    std::vector<glm::dvec2> line = smoothLine(through, 60.0);
    std::vector<glm::dvec2> bends = line;
    const double last = static_cast<double>(line.size() - 1);
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
        const glm::dvec2 along = glm::normalize(line[k + 1] - line[k - 1]);
        const double at = static_cast<double>(k);
        const double ends = smoothStep(0.0, 10.0, std::min(at, last - at));
        bends[k] += by * ends * noiseAt({0.17 * at, 0.5}, seed) * glm::dvec2(-along.y, along.x);
    }
    return bends;
}

} // namespace

double ValleyPlan::shoreAt(double angle) const noexcept {
    const double turns = angle / kWholeTurn;
    const double at = (turns - std::floor(turns)) * kShorePoints;
    const auto k = static_cast<std::size_t>(at) % kShorePoints;
    return std::lerp(shore[k], shore[(k + 1) % kShorePoints], at - std::floor(at));
}

glm::dvec2 ValleyPlan::shorePoint(double angle) const noexcept {
    return lake + shoreAt(angle) * glm::dvec2(std::cos(angle), std::sin(angle));
}

double ValleyPlan::fromLake(const glm::dvec2& place) const noexcept {
    const glm::dvec2 from = place - lake;
    return glm::length(from) - shoreAt(std::atan2(from.y, from.x));
}

ValleyPlan::Water ValleyPlan::waterNear(const glm::dvec2& place) const noexcept {
    const double lakeDistance = fromLake(place);
    const Nearest up = nearestOn(river, place), down = nearestOn(outflow, place);
    const double riverDistance = std::min(up.distance, down.distance) - kRiverHalf;
    if (lakeDistance <= riverDistance || lakeDistance < 0.0)
        return {lakeDistance, kLakeLevel, std::min(60.0, 1.5 + 0.16 * std::max(0.0, -lakeDistance))};
    const double fall = std::max(0.0, 1.0 - up.along / mouth);
    const double level = up.distance < down.distance ? kLakeLevel + (kSource - kLakeLevel) * fall * std::sqrt(fall)
                                                     : std::lerp(kLakeLevel, kLeaves, down.along);
    return {riverDistance, level, 2.5};
}

ValleyPlan planValley(std::uint64_t seed) {
    ValleyPlan plan;
    plan.lake = {4950.0, 5350.0};
    for (int k = 0; k < kShorePoints; ++k) {
        const double angle = kWholeTurn * k / kShorePoints;
        const glm::dvec2 way(std::cos(angle), std::sin(angle));
        const glm::dvec2 axes =
            glm::dvec2(way.x * 0.88 + way.y * 0.47, -way.x * 0.47 + way.y * 0.88) / glm::dvec2(1500.0, 800.0);
        const double round = 1.0 / glm::length(axes);
        plan.shore.push_back(round * (1.0 + 0.5 * fractalAt(1.9 * way + 5.0, 4, seed)));
    }
    plan.river = bent({{700.0, -40.0},
                       {1150.0, 900.0},
                       {1900.0, 1650.0},
                       {2150.0, 2600.0},
                       {3000.0, 3250.0},
                       {3450.0, 4050.0},
                       {4250.0, 4750.0},
                       plan.lake},
                      300.0, seed + 1);
    plan.outflow =
        bent({plan.lake, {6100.0, 6250.0}, {6800.0, 6700.0}, {7300.0, 7450.0}, {8240.0, 7900.0}}, 160.0, seed + 2);
    // The town lies where the river comes, beside its mouth.
    const auto found = std::ranges::find_if(plan.river, [&](const glm::dvec2& p) { return plan.fromLake(p) < 0.0; });
    plan.mouth = static_cast<double>(found - plan.river.begin() - 1) / static_cast<double>(plan.river.size() - 1);
    const glm::dvec2 mouth = *found;
    const double angle = std::atan2(mouth.y - plan.lake.y, mouth.x - plan.lake.x) - 0.42;
    const glm::dvec2 shorePoint = plan.shorePoint(angle);
    const glm::dvec2 ahead = plan.shorePoint(angle + 0.2), behind = plan.shorePoint(angle - 0.2);
    const glm::dvec2 along = glm::normalize(ahead - behind);
    plan.inland = {along.y, -along.x};
    if (glm::dot(plan.inland, shorePoint - plan.lake) < 0.0) plan.inland = -plan.inland;
    plan.town = shorePoint + kInland * plan.inland;
    return plan;
}

} // namespace lumorph::navigation
