#include "app/applications/labyrinth/relief.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/demo_items.h"

namespace lumorph::labyrinth {
namespace {

constexpr double kSpacing = 0.002; ///< metres

glm::dvec2 sampleAt(const HeightGrid& grid, int i, int j) {
    return {std::lerp(grid.min.x, grid.max.x, static_cast<double>(i) / (grid.columns - 1)),
            std::lerp(grid.min.y, grid.max.y, static_cast<double>(j) / (grid.rows - 1))};
}

/// Samples from a place to another along one axis, as a range of indices that lie in the grid.
struct Range {
    int first, last;
};
Range samplesIn(double from, double to, double min, double max, int samples) {
    const double spacing = (max - min) / (samples - 1);
    return {std::max(0, static_cast<int>(std::ceil((from - min) / spacing - 1e-6))),
            std::min(samples - 1, static_cast<int>(std::floor((to - min) / spacing + 1e-6)))};
}

template <typename Each>
void forSamples(const HeightGrid& grid, const glm::dvec2& from, const glm::dvec2& to, const Each& each) {
    const Range columns = samplesIn(from.x, to.x, grid.min.x, grid.max.x, grid.columns);
    const Range rows = samplesIn(from.y, to.y, grid.min.y, grid.max.y, grid.rows);
    for (int j = rows.first; j <= rows.last; ++j)
        for (int i = columns.first; i <= columns.last; ++i)
            each(static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns) + static_cast<std::size_t>(i),
                 sampleAt(grid, i, j));
}

} // namespace

Relief::Relief(const Level& level, const std::vector<Block>& blocks) {
    const glm::dvec2 half = 0.5 * level.cell * glm::dvec2(level.columns, level.rows);
    level_.min = -half;
    level_.max = half;
    level_.columns = static_cast<int>(std::lround(2.0 * half.x / kSpacing)) + 1;
    level_.rows = static_cast<int>(std::lround(2.0 * half.y / kSpacing)) + 1;
    const auto samples = static_cast<std::size_t>(level_.columns) * static_cast<std::size_t>(level_.rows);
    level_.heights.assign(samples, kSheet + static_cast<float>(kGround));
    for (const Block& block : blocks) {
        glm::dvec2 min = block.outline[0], max = min;
        for (const glm::dvec2& corner : block.outline) {
            min = glm::min(min, corner);
            max = glm::max(max, corner);
        }
        forSamples(level_, min, max, [&](std::size_t k, const glm::dvec2& place) {
            // The rim of a grid lies on the rim of its blocks, give or take the last bit.
            const double top = topAt(block, glm::clamp(place, min + 1e-9, max - 1e-9));
            if (!std::isnan(top)) level_.heights[k] = std::max(level_.heights[k], kSheet + static_cast<float>(top));
        });
    }
}

HeightGrid Relief::level(const glm::dvec2& lean) const {
    HeightGrid grid = level_;
    const glm::dvec2 falls(std::tan(lean.x), std::tan(lean.y));
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i)
            grid.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns) +
                         static_cast<std::size_t>(i)] -= static_cast<float>(glm::dot(falls, sampleAt(grid, i, j)));
    return grid;
}

HeightGrid Relief::withBall(const glm::dvec2& place, const glm::dvec2& lean) const {
    HeightGrid grid = level(lean);
    const glm::dvec2 reach(4.0 * kBumpWidth);
    forSamples(grid, place - reach, place + reach, [&](std::size_t k, const glm::dvec2& sample) {
        const glm::dvec2 from = (sample - place) / kBumpWidth;
        grid.heights[k] += static_cast<float>(kBumpHeight * std::exp(-0.5 * glm::dot(from, from)));
    });
    return grid;
}

} // namespace lumorph::labyrinth
