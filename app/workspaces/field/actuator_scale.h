#pragma once

#include "app/studio/widgets/value_field.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// What the stroke of an actuator means to its user: degrees for hinges and bends, a length for slides, a share for
/// morph targets.
struct ActuatorScale {
    Quantity quantity = Quantity::share;
    double atRest = 0.0; ///< SI, at stroke 0
    double atEnd = 1.0;  ///< SI, at stroke 1

    [[nodiscard]] double valueOf(double stroke) const noexcept { return atRest + stroke * (atEnd - atRest); }
    /// In [0, 1]; 0 where the actuator does not move at all.
    [[nodiscard]] double strokeOf(double value) const noexcept;
};
[[nodiscard]] ActuatorScale scaleOf(const Actuator& actuator);

/// The level of `levels` that is nearest to a stroke.
[[nodiscard]] int nearestLevel(double stroke, int levels) noexcept;

} // namespace lumorph::studio
