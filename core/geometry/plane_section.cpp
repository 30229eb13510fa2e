#include "core/geometry/plane_section.h"

#include <cstddef>

#include <glm/common.hpp>

namespace lumorph {

std::vector<std::array<glm::vec3, 2>> planeSection(std::span<const glm::vec3> positions,
                                                   std::span<const glm::uvec3> triangles, int axis, float at) {
    std::vector<std::array<glm::vec3, 2>> segments;
    for (const glm::uvec3& triangle : triangles) {
        std::array<glm::vec3, 2> segment{};
        std::size_t ends = 0;
        for (int edge = 0; edge < 3; ++edge) {
            const glm::vec3& a = positions[triangle[edge]];
            const glm::vec3& b = positions[triangle[(edge + 1) % 3]];
            if ((a[axis] < at) == (b[axis] < at)) continue;
            segment[ends] = glm::mix(a, b, (at - a[axis]) / (b[axis] - a[axis]));
            segment[ends++][axis] = at;
        }
        if (ends == 2) segments.push_back(segment);
    }
    return segments;
}

} // namespace lumorph
