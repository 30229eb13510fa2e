#include "core/voxels/height_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// Where a coordinate lies between the samples of one axis.
struct Between {
    std::size_t cell = 0;
    double share = 0.0; ///< of the way from the cell's first sample to its second
    bool inside = false;
};

Between between(double at, double min, double max, int samples) noexcept {
    if (!(at >= min && at <= max)) return {};
    const double scaled = (at - min) / (max - min) * (samples - 1);
    const auto cell = std::min(static_cast<std::size_t>(scaled), static_cast<std::size_t>(samples) - 2);
    return {cell, scaled - static_cast<double>(cell), true};
}

double bilinear(const HeightGrid& grid, const Between& x, const Between& z) noexcept {
    if (!x.inside || !z.inside) return std::numeric_limits<double>::quiet_NaN();
    const auto row = static_cast<std::size_t>(grid.columns);
    const float* corner = grid.heights.data() + z.cell * row + x.cell;
    // Not std::lerp, which may pass over a NaN; here one at any of the four corners comes through, even at a share of
    // 0.
    const auto mixed = [](double a, double b, double share) { return a + share * (b - a); };
    return mixed(mixed(static_cast<double>(corner[0]), static_cast<double>(corner[1]), x.share),
                 mixed(static_cast<double>(corner[row]), static_cast<double>(corner[row + 1]), x.share), z.share);
}

/// How many voxels of a column have their centre below a height. Rounding is set right by the centres themselves.
int countBelow(double height, const VoxelFrame& frame) noexcept {
    const int size = frame.dimensions.y;
    const double scaled = std::ceil((height - static_cast<double>(frame.origin.y)) / frame.voxelSize - 0.5);
    int count = static_cast<int>(std::clamp(scaled, 0.0, static_cast<double>(size)));
    while (count > 0 && !(frame.centre(0, count - 1, 0).y < height)) --count;
    while (count < size && frame.centre(0, count, 0).y < height) ++count;
    return count;
}

void setRun(std::span<std::uint64_t> column, int from, int to) noexcept {
    for (int y = from; y < to;) {
        const int inWord = y & 63;
        const int bits = std::min(to - y, 64 - inWord);
        const std::uint64_t run = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
        column[static_cast<std::size_t>(y) >> 6U] |= run << inWord;
        y += bits;
    }
}

[[noreturn]] void refuse(const std::string& why, const std::string& remedy) {
    throw InvalidInput("height grid", why, remedy);
}

} // namespace

void checkHeightGrid(const HeightGrid& grid) {
    if (grid.columns < 2 || grid.rows < 2)
        refuse("it has fewer than two samples along a side", "give it at least 2 columns and 2 rows");
    const std::size_t samples = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    if (samples > kMaxHeightSamples)
        refuse("it has " + std::to_string(samples) + " samples; at most " + std::to_string(kMaxHeightSamples) +
                   " are taken",
               "use fewer columns and rows");
    if (grid.heights.size() != samples)
        refuse(std::to_string(grid.heights.size()) + " heights for " + std::to_string(samples) + " samples",
               "give one for each column of each row");
    for (int axis = 0; axis < 2; ++axis) {
        const double length = grid.max[axis] - grid.min[axis];
        if (!(length > 0.0) || !std::isfinite(length))
            refuse("its rectangle is empty or not finite", "let it end beyond where it begins");
    }
    if (std::ranges::any_of(grid.heights, [](float height) { return std::isinf(height); }))
        refuse("a height is infinite", "use NaN where there is nothing");
}

double heightAt(const HeightGrid& grid, const glm::dvec2& at) noexcept {
    return bilinear(grid, between(at.x, grid.min.x, grid.max.x, grid.columns),
                    between(at.y, grid.min.y, grid.max.y, grid.rows));
}

void voxelizeHeights(const VoxelFrame& frame, const HeightGrid& grid, double floor, BitColumns& out) {
    checkHeightGrid(grid);
    if (!std::isfinite(floor)) throw InvalidInput("floor", "it is not a finite number", "give a finite height");
    if (out.dimensions() != frame.dimensions)
        out = BitColumns(frame.dimensions);
    else
        out.clear();
    const glm::ivec3 size = frame.dimensions;
    int from = countBelow(floor, frame);
    while (from < size.y && !(frame.centre(0, from, 0).y > floor)) ++from;
    const auto words = static_cast<std::size_t>(out.wordsPerColumn());
    for (int z = 0; z < size.z; ++z) {
        const Between alongZ = between(frame.centre(0, 0, z).z, grid.min.y, grid.max.y, grid.rows);
        if (!alongZ.inside) continue;
        for (int x = 0; x < size.x; ++x) {
            const Between alongX = between(frame.centre(x, 0, 0).x, grid.min.x, grid.max.x, grid.columns);
            const double height = bilinear(grid, alongX, alongZ);
            if (std::isnan(height)) continue;
            setRun(out.words().subspan(out.columnIndex(x, z) * words, words), from, countBelow(height, frame));
        }
    }
}

} // namespace lumorph
