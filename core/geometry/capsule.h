#pragma once

#include <glm/vec3.hpp>

namespace lumorph {

/// All that is nearer than `radius` to the straight line between two points; metres.
struct Capsule {
    glm::vec3 from{0.0F}, to{0.0F};
    float radius = 0.0F;
    bool operator==(const Capsule&) const = default;
};

} // namespace lumorph
