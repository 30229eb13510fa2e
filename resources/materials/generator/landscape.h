#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "resources/materials/generator/tiling.h"

/// An invented country on a torus.
namespace lumorph {

inline constexpr float kSeaLevel = 0.40F;

struct Landscape {
    Heights ground; ///< [0, 1]
    Heights river;  ///< how wide a river runs here, in pixels; 0: none
    Heights road;   ///< 2 a main road, 1 a lane, 0 none; thin lines
    std::vector<glm::ivec2> towns;
};

[[nodiscard]] Landscape makeLandscape();

} // namespace lumorph
