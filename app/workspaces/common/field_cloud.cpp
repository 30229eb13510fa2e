#include "app/workspaces/common/field_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "core/mdf/field_view.h"

namespace lumorph::studio {

namespace {

std::array<std::uint8_t, 4> colorBytes(const glm::vec3& color) noexcept {
    const glm::vec3 scaled = glm::round(glm::clamp(color, 0.0F, 1.0F) * 255.0F);
    return {static_cast<std::uint8_t>(scaled.x), static_cast<std::uint8_t>(scaled.y),
            static_cast<std::uint8_t>(scaled.z), 255};
}

ViewportVoxel voxelAt(int x, int y, int z, const std::array<std::uint8_t, 4>& color) noexcept {
    return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(z), 0, color};
}

/// Calls `visit(x, y, z, index)` for every voxel, x fastest.
template <class Visit> void eachVoxel(const glm::ivec3& size, Visit visit) {
    std::ptrdiff_t index = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) visit(x, y, z, index++);
}

} // namespace

glm::vec3 levelColor(int level, int levels, const glm::vec3& low, const glm::vec3& high) noexcept {
    const float share = levels > 1 ? static_cast<float>(level) / static_cast<float>(levels - 1) : 0.0F;
    return glm::mix(low, high, std::clamp(share, 0.0F, 1.0F));
}

std::vector<ViewportVoxel> fieldCloud(const Field& field, const FieldDisplay& display, const BitColumns* touchedBy,
                                      const glm::vec3& low, const glm::vec3& high) {
    FieldViewOptions options;
    if (display.actuator && *display.actuator >= 0 &&
        static_cast<std::size_t>(*display.actuator) < field.actuators.size())
        options.actuator = static_cast<std::size_t>(*display.actuator);
    options.lowestLevel = display.lowestLevel;
    options.highestLevel = display.highestLevel;
    options.sliceFrom = display.sliceFrom;
    options.sliceTo = display.sliceTo;
    options.touchedBy = touchedBy;
    std::vector<std::array<std::uint8_t, 4>> colors;
    for (int level = 0; level < std::max(field.levels, 1); ++level)
        colors.push_back(colorBytes(levelColor(level, field.levels, low, high)));
    std::vector<ViewportVoxel> cloud;
    for (const FieldVoxel& voxel : fieldVoxels(field, options)) {
        const auto level = static_cast<std::size_t>(std::clamp(voxel.level, 0, static_cast<int>(colors.size()) - 1));
        cloud.push_back(voxelAt(voxel.voxel.x, voxel.voxel.y, voxel.voxel.z, colors[level]));
    }
    return cloud;
}

std::vector<std::uint8_t> thickClasses(const VoxelFrame& frame, const std::vector<std::uint8_t>& classes) {
    const glm::ivec3 size = frame.dimensions;
    const std::array<int, 3> steps{1, size.x, size.x * size.y};
    std::vector<std::uint8_t> thick(classes.size(), 0);
    int index = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++index) {
                const std::uint8_t own = classes[static_cast<std::size_t>(index)];
                if (own != kVoxelUnmatched && own != kVoxelOverfilled) continue;
                const glm::ivec3 at(x, y, z);
                bool among = true;
                for (int axis = 0; axis < 3 && among; ++axis) {
                    const auto same = [&](int other) { return classes[static_cast<std::size_t>(other)] == own; };
                    const int step = steps[static_cast<std::size_t>(axis)];
                    among = (at[axis] > 0 && same(index - step)) || (at[axis] + 1 < size[axis] && same(index + step));
                }
                if (among) thick[static_cast<std::size_t>(index)] = own;
            }
    return thick;
}

BitColumns targetVoxels(const VoxelFrame& frame, const std::vector<std::uint8_t>& classes) {
    BitColumns bits(frame.dimensions);
    if (classes.size() != frame.voxelCount()) return bits;
    eachVoxel(frame.dimensions, [&](int x, int y, int z, std::ptrdiff_t index) {
        const std::uint8_t own = classes[static_cast<std::size_t>(index)];
        if (own == kVoxelMatched || own == kVoxelUnmatched) bits.set(x, y, z);
    });
    return bits;
}

void addBox(std::vector<ViewportLine>& lines, const Box& box, const glm::vec3& color, float width, bool onTop) {
    const auto corner = [&box](int i) {
        return glm::vec3((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                         (i & 4) != 0 ? box.max.z : box.min.z);
    };
    for (int i = 0; i < 8; ++i)
        for (const int axis : {1, 2, 4})
            if ((i & axis) == 0) lines.push_back({corner(i), corner(i | axis), color, width, onTop});
}

} // namespace lumorph::studio
