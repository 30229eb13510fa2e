#pragma once

#include <array>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"

namespace lumorph {

/// A picture on a surface, perhaps moving (R28): by UV motion, as a flip-book, or both. Surfaces known in metres
/// (device, table, height fields, shapes) are mapped in metres of their rest shape; meshes of a glTF by their texture
/// coordinates.
struct SceneTexture {
    std::string image;        ///< asset or `resource:`; empty: none
    glm::vec2 tile{0.1F};     ///< metres (or texture coordinates) that one repeat covers
    Angle turn;               ///< about the surface's normal
    glm::vec2 velocity{0.0F}; ///< metres (or texture coordinates) a second, any speed
    int columns = 1;          ///< of a flip-book's sheet
    int rows = 1;
    double framesPerSecond = 0; ///< of the flip-book; 0 holds the first picture
    bool operator==(const SceneTexture&) const = default;
};

/// How a surface meets light. Colours are sRGB in [0, 1].
struct Material {
    enum class Alpha { opaque, cutout, blend };

    std::string name = "Material";
    glm::vec3 color{0.8F};
    SceneTexture colorTexture;                ///< multiplied with the colour
    std::array<SceneTexture, 2> normalMaps{}; ///< tangent space, +Y up; their bends add up (R27)
    float normalStrength = 1.0F;
    float roughness = 0.7F;
    float metallic = 0.0F;
    glm::vec3 emission{0.0F};
    float emissionStrength = 1.0F; ///< times white
    float reflection = 0.0F;       ///< share of the environment (table and sky) mirrored, Fresnel on top
    float refraction = 0.0F;       ///< share of the table seen through the surface, bent
    float refractiveIndex = 1.33F;
    Alpha alpha = Alpha::opaque;
    float opacity = 1.0F;
    SceneTexture holes;         ///< its alpha (or red without alpha) cuts holes, through to the table (R32)
    float holeThreshold = 0.5F; ///< what is below is cut out, in [0, 1]
    bool unlit = false;         ///< shows its colour whatever the light
    bool operator==(const Material&) const = default;
};

} // namespace lumorph
