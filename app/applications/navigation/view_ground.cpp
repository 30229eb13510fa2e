#include "app/applications/navigation/view_ground.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace lumorph::navigation {
namespace {

constexpr double kLeastRelief = 1e-3; ///< metres
constexpr double kSettles = 0.5;      ///< seconds in which heights come closer to their extent by e

} // namespace

glm::dvec2 ViewGround::pointAt(int column, int row) noexcept {
    return kHalf * (2.0 * glm::dvec2(column, row) / glm::dvec2(kColumns - 1, kRows - 1) - 1.0);
}

double ViewGround::perMetreOf(double relief, const MapView& view) noexcept {
    return std::min(kReach / std::max(relief, kLeastRelief), kMostExaggeration / view.scale());
}

ViewGround::ViewGround(const Map& map, const MapView& view, const ViewGround* before, double seconds) : view_(view) {
    const double detail = view.width / (kColumns - 1);
    const glm::dvec2 corner = view.placeAt(-kHalf);
    const glm::dvec2 across = (view.placeAt({kHalf.x, -kHalf.y}) - corner) / static_cast<double>(kColumns - 1);
    const glm::dvec2 down = (view.placeAt({-kHalf.x, kHalf.y}) - corner) / static_cast<double>(kRows - 1);
    heights_.reserve(static_cast<std::size_t>(kColumns * kRows));
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const glm::dvec2 place = corner + static_cast<double>(i) * across + static_cast<double>(j) * down;
            heights_.push_back(
                static_cast<float>(map.holds(place) ? map.heights.at(place, detail) : map.heights.lowest()));
        }
    const auto [least, most] = std::ranges::minmax(heights_);
    const double relief = std::max(static_cast<double>(most - least), kLeastRelief);
    low_ = static_cast<double>(least);
    perMetre_ = perMetreOf(relief, view);
    if (!before || seconds < 0.0) return;
    // Whoever flies must not see the land jump when a peak comes into view.
    const double share = 1.0 - std::exp(-seconds / kSettles);
    const double wantedLow = low_, wantedLift = perMetre_ * view.scale();
    low_ = std::lerp(before->low_, wantedLow, share);
    const double exaggeration = before->exaggeration() * std::pow(wantedLift / before->exaggeration(), share);
    settled_ = std::abs(low_ - wantedLow) < 1e-4 * relief && std::abs(exaggeration / wantedLift - 1.0) < 1e-4;
    if (settled_)
        low_ = wantedLow;
    else
        perMetre_ = exaggeration / view.scale();
}

double ViewGround::surfaceAt(const glm::dvec2& point) const noexcept {
    const glm::dvec2 cell = glm::clamp(0.5 * (point / kHalf + 1.0), 0.0, 1.0) * glm::dvec2(kColumns - 1, kRows - 1);
    const int i = std::min(static_cast<int>(cell.x), kColumns - 2), j = std::min(static_cast<int>(cell.y), kRows - 2);
    const glm::dvec2 t = cell - glm::dvec2(i, j);
    const auto at = [&](int x, int y) { return static_cast<double>(height(x, y)); };
    // The two triangles into which each square of the drawn surface is cut.
    const double h = t.x + t.y <= 1.0 ? at(i, j) + t.x * (at(i + 1, j) - at(i, j)) + t.y * (at(i, j + 1) - at(i, j))
                                      : at(i + 1, j + 1) + (1.0 - t.x) * (at(i, j + 1) - at(i + 1, j + 1)) +
                                            (1.0 - t.y) * (at(i + 1, j) - at(i + 1, j + 1));
    return lift(h);
}

HeightGrid ViewGround::grid() const {
    HeightGrid grid;
    grid.min = -kHalf;
    grid.max = kHalf;
    grid.columns = kColumns;
    grid.rows = kRows;
    grid.heights.reserve(heights_.size());
    for (const float height : heights_) grid.heights.push_back(static_cast<float>(lift(static_cast<double>(height))));
    return grid;
}

} // namespace lumorph::navigation
