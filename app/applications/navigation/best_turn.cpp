#include "app/applications/navigation/best_turn.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "app/applications/navigation/view_ground.h"

namespace lumorph::navigation {
namespace {

constexpr double kSpacing = 0.012;   ///< of the points that are compared, metres
constexpr double kDislike = 0.03;    ///< of a turn of a radian, as likeness
constexpr double kMostShifted = 0.5; ///< metres of ground by which a turn may move the place out of the middle

std::vector<glm::vec2> comparedPoints() {
    const glm::ivec2 counts(glm::round(2.0 * kHalf / kSpacing));
    std::vector<glm::vec2> points;
    for (int j = 0; j < counts.y; ++j)
        for (int i = 0; i < counts.x; ++i)
            points.emplace_back(kHalf * (2.0 * (glm::dvec2(i, j) + 0.5) / glm::dvec2(counts) - 1.0));
    return points;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double meanA = 0.0, meanB = 0.0, ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        meanA += a[k] / static_cast<double>(a.size());
        meanB += b[k] / static_cast<double>(a.size());
    }
    for (std::size_t k = 0; k < a.size(); ++k) {
        ab += (a[k] - meanA) * (b[k] - meanB);
        aa += (a[k] - meanA) * (a[k] - meanA);
        bb += (b[k] - meanB) * (b[k] - meanB);
    }
    return aa * bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

} // namespace

BestTurn::BestTurn(const Rig& rig) : surface_(rig, comparedPoints()), fit_(surface_) {}

double BestTurn::likeness(const Map& map, const MapView& view) const {
    const std::vector<glm::vec2>& points = surface_.points();
    const double detail = view.scale() * kSpacing;
    std::vector<double> land;
    for (const glm::vec2& point : points)
        land.push_back(static_cast<double>(map.heights.at(view.placeAt(glm::dvec2(point)), detail)));
    if (land.empty()) return 0.0;
    const auto [least, most] = std::ranges::minmax(land);
    const double lift = ViewGround::perMetreOf(most - least, view);
    std::vector<double> wanted, rest(surface_.restHeights().begin(), surface_.restHeights().end());
    for (double& height : land) height = ViewGround::kLowest + (height - least) * lift;
    for (std::size_t k = 0; k < land.size(); ++k) wanted.push_back(land[k] - rest[k]);
    std::vector<double> strokes(surface_.rig().actuatorCount(), 0.0), carried(land.size(), 0.0);
    fit_.improve(wanted, strokes);
    fit_.lifts(strokes, carried);
    for (std::size_t k = 0; k < carried.size(); ++k) carried[k] += rest[k];
    return correlation(land, carried);
}

MapView BestTurn::of(const Map& map, const MapView& view) const {
    const glm::dvec2 size = map.heights.size();
    MapView best = view;
    double bestLiked = -2.0;
    for (int k = -kTurns; k <= kTurns; ++k) {
        const double turn = kMostTurn * k / kTurns;
        const MapView turned = within({view.centre, view.width, view.turn + turn}, size, 0.0);
        if (glm::distance(turned.centre, view.centre) > kMostShifted || turned.width < 0.999 * view.width) continue;
        const double liked = likeness(map, turned) - kDislike * std::abs(turn);
        if (liked <= bestLiked) continue;
        bestLiked = liked;
        best = turned;
    }
    return best;
}

} // namespace lumorph::navigation
