#pragma once

#include <glm/vec2.hpp>

namespace lumorph::ice {

/// How a floe sits on the water: buoyancy brings it back to where it floats level, and water that it moves slows it.
struct Bob {
    double rise = 0.0;         ///< over where it floats at rest, metres
    double riseSpeed = 0.0;    ///< metres a second
    glm::dvec2 tilt{0.0};      ///< slopes of its top along x and z
    glm::dvec2 tiltSpeed{0.0}; ///< of the slopes, 1 over seconds
};

/// A weight on a floe, as the volume of water that weighs as much.
struct FloeLoad {
    double volume = 0.0; ///< cubic metres
    glm::dvec2 arm{0.0}; ///< from the middle of the floe, metres
};

/// What the water under a floe is like: how high it stands there and how it slopes.
struct WaterLevel {
    double height = 0.0;
    glm::dvec2 slope{0.0};
};

inline constexpr double kMostTilt = 0.16; ///< slope

/// One step of so many seconds of a floe with this area, square metres.
void bob(Bob& floe, double area, const WaterLevel& water, const FloeLoad& load, double seconds) noexcept;

/// A blow in the plane of the water: the struck side dips. `impulse` as of FloeBump.
void rock(Bob& floe, double area, const glm::dvec2& impulse) noexcept;

} // namespace lumorph::ice
