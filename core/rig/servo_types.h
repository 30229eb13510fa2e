#pragma once

#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/base/units.h"

namespace lumorph {

/// A kind of hobby servo, as its maker describes it at 4.8 to 5 V.
struct ServoType {
    std::string_view name;
    double stallTorque = 0.0; ///< newton metres
    double speed = 0.0;       ///< radians a second without load
    double pulseMin = 1000.0; ///< microseconds at one end of its travel
    double pulseMax = 2000.0; ///< at the other
    Angle travel;             ///< between the two
    glm::dvec3 size{0.0};     ///< length, width and height with its shaft, metres
    double mass = 0.0;        ///< kilograms
    double price = 0.0;       ///< euros, as single ones are sold; a guide, no offer

    /// What it may be asked to hold: half of what stalls it, because a servo that nearly stalls draws its largest
    /// current, heats up and trembles.
    [[nodiscard]] double usableTorque() const noexcept { return 0.5 * stallTorque; }
};

/// Common ones, the weakest first.
[[nodiscard]] std::span<const ServoType> servoTypes();
/// By its name in any case; none where the table has no such.
[[nodiscard]] const ServoType* findServo(std::string_view name);
/// The same. Throws InvalidInput naming those there are.
[[nodiscard]] const ServoType& servoType(std::string_view name);
/// The cheapest one whose usable torque (newton metres) is at least so large; none where all are too weak.
[[nodiscard]] const ServoType* cheapestServo(double torque);

} // namespace lumorph
