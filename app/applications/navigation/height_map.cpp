#include "app/applications/navigation/height_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "core/base/error.h"

namespace lumorph::navigation {
namespace {

constexpr int kFewestSamples = 16; ///< of the coarsest level, along its longer side

} // namespace

HeightMap::HeightMap(glm::ivec2 samples, double spacing, std::vector<float> heights) {
    const auto refuse = [](const char* why) { throw InvalidInput("height map", why, "correct it"); };
    if (samples.x < 2 || samples.y < 2) refuse("it has fewer than two samples a side");
    if (heights.size() != static_cast<std::size_t>(samples.x) * static_cast<std::size_t>(samples.y))
        refuse("the number of heights is not that of its samples");
    if (!(spacing > 0.0) || !std::isfinite(spacing)) refuse("its samples have no spacing");
    if (!std::ranges::all_of(heights, [](float h) { return std::isfinite(h); })) refuse("a height is not finite");
    const auto [low, high] = std::ranges::minmax_element(heights);
    lowest_ = static_cast<double>(*low);
    highest_ = static_cast<double>(*high);
    levels_.front() = {samples, spacing, std::move(heights)};
    while (std::max(levels_.back().samples.x, levels_.back().samples.y) > kFewestSamples)
        levels_.push_back(coarser(levels_.back()));
}

glm::dvec2 HeightMap::size() const noexcept { return spacing() * glm::dvec2(samples() - 1); }

/// Every other sample, each as the mean of what lies around it.
HeightMap::Level HeightMap::coarser(const Level& level) {
    Level half{level.samples / 2 + 1, 2.0 * level.spacing, {}};
    half.heights.reserve(static_cast<std::size_t>(half.samples.x) * static_cast<std::size_t>(half.samples.y));
    const glm::ivec2 last = level.samples - 1;
    for (int j = 0; j < half.samples.y; ++j)
        for (int i = 0; i < half.samples.x; ++i) {
            const int x = std::min(2 * i, last.x), y = std::min(2 * j, last.y);
            const int west = std::max(x - 1, 0), east = std::min(x + 1, last.x);
            const int north = std::max(y - 1, 0), south = std::min(y + 1, last.y);
            const float corners =
                level.at(west, north) + level.at(east, north) + level.at(west, south) + level.at(east, south);
            const float sides = level.at(x, north) + level.at(x, south) + level.at(west, y) + level.at(east, y);
            half.heights.push_back((corners + 2.0F * sides + 4.0F * level.at(x, y)) / 16.0F);
        }
    return half;
}

double HeightMap::Level::at(const glm::dvec2& place) const noexcept {
    const glm::dvec2 cell = glm::clamp(place / spacing, glm::dvec2(0.0), glm::dvec2(samples - 1));
    const int x = std::min(static_cast<int>(cell.x), samples.x - 2),
              y = std::min(static_cast<int>(cell.y), samples.y - 2);
    const double tx = cell.x - x, ty = cell.y - y;
    const double north = std::lerp(static_cast<double>(at(x, y)), static_cast<double>(at(x + 1, y)), tx);
    const double south = std::lerp(static_cast<double>(at(x, y + 1)), static_cast<double>(at(x + 1, y + 1)), tx);
    return std::lerp(north, south, ty);
}

double HeightMap::at(const glm::dvec2& place, double detail) const noexcept {
    const double level = std::log2(std::max(detail / spacing(), 1.0));
    const auto finer = std::min(static_cast<std::size_t>(level), levels_.size() - 1);
    const double height = levels_[finer].at(place);
    const double share = level - static_cast<double>(finer);
    if (share <= 0.0 || finer + 1 >= levels_.size()) return height;
    return std::lerp(height, levels_[finer + 1].at(place), share);
}

glm::dvec2 HeightMap::slopeAt(const glm::dvec2& place, double detail) const noexcept {
    const double step = std::max(detail, spacing());
    const glm::dvec2 east(step, 0.0), south(0.0, step);
    return glm::dvec2(at(place + east, detail) - at(place - east, detail),
                      at(place + south, detail) - at(place - south, detail)) /
           (2.0 * step);
}

} // namespace lumorph::navigation
