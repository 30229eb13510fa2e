#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A regular grid of cubic voxels in device coordinates; voxel (0,0,0) touches `origin`.
struct VoxelFrame {
    glm::vec3 origin{0.0F}; ///< lowest corner, metres
    double voxelSize = 0.0; ///< metres
    glm::ivec3 dimensions{0};

    [[nodiscard]] std::size_t voxelCount() const noexcept {
        return static_cast<std::size_t>(dimensions.x) * static_cast<std::size_t>(dimensions.y) *
               static_cast<std::size_t>(dimensions.z);
    }
    [[nodiscard]] glm::dvec3 centre(int x, int y, int z) const noexcept {
        return glm::dvec3(origin) + voxelSize * (glm::dvec3(x, y, z) + 0.5);
    }
    [[nodiscard]] double voxelVolume() const noexcept { return voxelSize * voxelSize * voxelSize; }
    [[nodiscard]] Box box() const noexcept {
        return {origin, origin + glm::vec3(static_cast<float>(voxelSize)) * glm::vec3(dimensions)};
    }
    bool operator==(const VoxelFrame&) const = default;
};

/// Limits of a frame, so that a wrong number is refused instead of filling the memory.
inline constexpr std::size_t kMaxVoxels = std::size_t{1} << 26;
inline constexpr std::size_t kMaxColumns = std::size_t{1} << 22;

/// Whether a grid of this shape (each size at least 1) stays within the limits.
[[nodiscard]] bool fitsLimits(const glm::ivec3& dimensions) noexcept;

/// The frame of a box (paper, Computational considerations; R7): voxel side = smallest side /
/// resolution; the smallest axis gets `resolution` voxels, the others ceil(side / voxel - 1e-6).
/// Throws InvalidInput for an empty or flat box, a resolution below 1 or a frame beyond the limits.
[[nodiscard]] VoxelFrame frameOf(const Box& box, int resolution);

} // namespace lumorph
