#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "app/applications/ambient/place.h"

namespace lumorph::ambient {

/// Where something stands in the sky, without refraction.
struct SkyPosition {
    double azimuth = 0.0;   ///< radians, clockwise from north
    double elevation = 0.0; ///< radians over the horizon
};

/// The middle of the sun, by VSOP87 (libnova), seen from a place.
[[nodiscard]] SkyPosition sunAt(const Place& place, double utc);

struct Moon {
    SkyPosition position;
    double lit = 1.0; ///< share of its disc
};
/// By ELP 2000 (libnova), shortened to some arc seconds.
[[nodiscard]] Moon moonAt(const Place& place, double utc);

/// Elevation of the sun's middle when its upper limb rises or sets, by convention -0.833 degrees, radians.
extern const double kHorizon;

/// When the sun rises and sets in the day that begins at `midnight`; nothing where it does not.
struct SunTimes {
    std::optional<double> rise, set;
};
[[nodiscard]] SunTimes sunTimes(const Place& place, double midnight);

/// The unit vector towards it in device coordinates.
[[nodiscard]] glm::dvec3 towards(const Place& place, const SkyPosition& position) noexcept;

} // namespace lumorph::ambient
