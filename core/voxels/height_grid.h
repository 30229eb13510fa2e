#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "core/voxels/bit_columns.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Heights over a rectangle of the device's ground plane, as a plain value: samples in rows along x, the rows one after
/// another along z. The first sample stands at `min`, the last at `max`, the others evenly between; the height between
/// samples is bilinear. All in device metres.
struct HeightGrid {
    glm::dvec2 min{0.0}; ///< x and z
    glm::dvec2 max{0.0};
    int columns = 0;            ///< samples along x, at least 2
    int rows = 0;               ///< samples along z, at least 2
    std::vector<float> heights; ///< y of sample (i, j) at j * columns + i; NaN: nothing there
};

/// The most samples of a grid, so that a wrong number is refused instead of filling the memory.
inline constexpr std::size_t kMaxHeightSamples = std::size_t{1} << 22;

/// Throws InvalidInput naming what is wrong: fewer than two samples a side, more than `kMaxHeightSamples`, another
/// number of heights than of samples, a rectangle that is not finite or has no area, an infinite height.
void checkHeightGrid(const HeightGrid& grid);

/// The bilinear height at (x, z), metres; NaN outside the rectangle and where one of the four samples around the place
/// is NaN (on a line between cells: of the cell towards larger x and z).
[[nodiscard]] double heightAt(const HeightGrid& grid, const glm::dvec2& at) noexcept;

/// Voxels whose centre lies above `floor` (y, device metres; such as the rest surface) and below the grid's surface.
/// The heights become runs of bits at once: no mesh is made, and nothing has to be closed or repaired. `out` gets the
/// frame's shape; allocates only while it grows. Throws InvalidInput for a floor that is not finite, and as
/// `checkHeightGrid`.
void voxelizeHeights(const VoxelFrame& frame, const HeightGrid& grid, double floor, BitColumns& out);

} // namespace lumorph
