#include "core/voxels/voxel_frame.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/vector_relational.hpp>

#include "core/base/error.h"

namespace lumorph {

bool fitsLimits(const glm::ivec3& dimensions) noexcept {
    const double columns = static_cast<double>(dimensions.x) * dimensions.z;
    return columns <= static_cast<double>(kMaxColumns) && columns * dimensions.y <= static_cast<double>(kMaxVoxels);
}

VoxelFrame frameOf(const Box& box, int resolution) {
    const glm::dvec3 size(box.size());
    const double smallest = std::min({size.x, size.y, size.z});
    if (resolution < 1)
        throw InvalidInput("resolution " + std::to_string(resolution), "a voxel frame needs at least one voxel",
                           "use 1 or more");
    if (!(smallest > 0.0) || !std::isfinite(size.x + size.y + size.z))
        throw InvalidInput("voxel frame", "the box is flat, empty or not finite",
                           "use a rig that moves along all three axes");
    const double voxel = smallest / resolution;
    const auto voxelsAlong = [&](double side) { return std::max(1.0, std::ceil(side / voxel - 1e-6)); };
    const glm::dvec3 counts(voxelsAlong(size.x), voxelsAlong(size.y), voxelsAlong(size.z));
    if (counts.x * counts.y * counts.z > static_cast<double>(kMaxVoxels) ||
        counts.x * counts.z > static_cast<double>(kMaxColumns))
        throw InvalidInput("resolution " + std::to_string(resolution),
                           "the frame would have more than " + std::to_string(kMaxVoxels) + " voxels or " +
                               std::to_string(kMaxColumns) + " columns",
                           "use a lower resolution");
    VoxelFrame frame{box.min, voxel, glm::ivec3(counts)};
    // The smallest side must get exactly the resolution asked for, whatever the rounding.
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] == smallest) frame.dimensions[axis] = resolution;
    return frame;
}

} // namespace lumorph
