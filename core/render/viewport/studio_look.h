#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/render/viewport/theme.h"

namespace lumorph {

/// The studio's colours in a theme, sRGB-encoded.
struct StudioPalette {
    glm::vec3 top, bottom; ///< of the backdrop
    glm::vec3 line, pool;  ///< of the ground's grid and of the pool of light on it
    float lineStrength, shade, exposure;
};
[[nodiscard]] StudioPalette studioPalette(Theme theme);

/// Direction towards the key light, of length 1: from the left, above, a little in front.
[[nodiscard]] glm::vec3 keyLightDirection();
/// Radius of the key shadow's soft edge, as a share of its map's side.
inline constexpr float kKeySoftness = 0.011F;

/// Directions towards the sky, evenly over the upper hemisphere; as many as studio_light.glsl samples.
inline constexpr int kSkyCount = 16;
[[nodiscard]] std::array<glm::vec3, kSkyCount> skyDirections();

} // namespace lumorph
