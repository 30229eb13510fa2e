#include "app/applications/ice/bob.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace lumorph::ice {
namespace {

// Archimedes for a flat floe: it floats with `draft` of it under water, and both heave and tilt are springs of
// gravity over draft. The pond is a model of one that is eighty times as large, and by Froude's law of models slow
// accordingly; water that moves along counts as much as the ice.
constexpr double kScale = 80.0;
constexpr double kDraft = 0.0037;                                ///< metres
constexpr double kAlong = 2.0;                                   ///< mass of ice and water over that of the ice
constexpr double kStiffness = 9.81 / kScale / (kDraft * kAlong); ///< 1 over square seconds
constexpr double kDamping = 0.22;                                ///< ratio; 1 is critical
constexpr double kRocks = 8.0; ///< tilt speed by a blow that changes a floe's speed by a metre a second

glm::dvec2 limited(const glm::dvec2& slope) noexcept {
    const double length = glm::length(slope);
    return length > kMostTilt ? slope * (kMostTilt / length) : slope;
}

} // namespace

void bob(Bob& floe, double area, const WaterLevel& water, const FloeLoad& load, double seconds) noexcept {
    if (!(area > 0.0)) return;
    const double second = area * area / (4.0 * std::numbers::pi); // moment of area, as of a disc
    const double level = water.height - load.volume / area;
    const glm::dvec2 slope = limited(water.slope - load.volume * load.arm / second);
    const double omega = std::sqrt(kStiffness), slowed = 2.0 * kDamping * omega;
    // The speed first, and from it the place: a spring that gains no energy.
    floe.riseSpeed += (kStiffness * (level - floe.rise) - slowed * floe.riseSpeed) * seconds;
    floe.tiltSpeed += (kStiffness * (slope - floe.tilt) - slowed * floe.tiltSpeed) * seconds;
    floe.rise += floe.riseSpeed * seconds;
    floe.tilt = limited(floe.tilt + floe.tiltSpeed * seconds);
}

void rock(Bob& floe, double area, const glm::dvec2& impulse) noexcept {
    if (area > 0.0) floe.tiltSpeed += limited(kRocks * impulse / area);
}

} // namespace lumorph::ice
