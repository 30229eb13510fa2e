#include "core/render/viewport/studio_look.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph {

StudioPalette studioPalette(Theme theme) {
    if (theme == Theme::light)
        return {{0.90F, 0.915F, 0.935F},
                {0.80F, 0.82F, 0.85F},
                {0.28F, 0.33F, 0.42F},
                glm::vec3(0.07F),
                0.3F,
                0.45F,
                1.12F};
    return {{0.066F, 0.074F, 0.09F},
            {0.135F, 0.15F, 0.18F},
            {0.62F, 0.70F, 0.82F},
            {0.115F, 0.125F, 0.145F},
            0.26F,
            0.72F,
            1.0F};
}

glm::vec3 keyLightDirection() { return glm::normalize(glm::vec3(-0.55F, 1.0F, 0.42F)); }

std::array<glm::vec3, kSkyCount> skyDirections() {
    std::array<glm::vec3, kSkyCount> directions;
    for (int i = 0; i < kSkyCount; ++i) { // a spiral
        const float y = (static_cast<float>(i) + 0.5F) / kSkyCount;
        const float around = 2.39996323F * static_cast<float>(i);
        const float r = std::sqrt(1.0F - y * y);
        directions[static_cast<std::size_t>(i)] = {r * std::cos(around), y, r * std::sin(around)};
    }
    return directions;
}

} // namespace lumorph
