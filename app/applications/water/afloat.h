#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include "app/applications/water/sea_surface.h"
#include "core/scene/scene.h"

namespace lumorph::sea {

/// Something that floats.
struct Float {
    SceneItem item;
    glm::dvec2 home{0.0}, at{0.0}, velocity{0.0}; ///< device metres
    glm::dvec2 half{0.0};                         ///< of its waterline
    double radius = 0.0, lift = 0.0;              ///< lift: of its middle over the water, metres
    double homesick = 0.5;                        ///< how strongly it is drawn home, 1 / s^2
    double heading = 0.0;                         ///< from x to z, radians; of one that sails
    bool sails = false;                           ///< turns to where it goes
    double above = 0.0, falls = 0.0;              ///< over the water, metres, and how fast: it is thrown in

    [[nodiscard]] Waterline waterline() const noexcept;
};

/// What pushes things afloat beside the waves.
struct Push {
    glm::dvec2 slope{0.0};            ///< of water that runs
    const Ripples* ripples = nullptr; ///< always there
};

/// Turns +Y to the normal of a slope along x and z.
[[nodiscard]] glm::quat alongSlope(const glm::dvec2& slope);

/// Moves one with the water, and puts its item onto it. True where it has just fallen in.
[[nodiscard]] bool drift(Float& one, const SeaSurface& sea, const Push& push, double step);
/// Neither in one another nor over the rim.
void keepApart(std::span<Float* const> all);

} // namespace lumorph::sea
