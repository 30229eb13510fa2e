#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/units.h"
#include "core/rig/rig.h"
#include "core/rig/servo_types.h"

namespace lumorph {

/// The light that falls on a device, as far as shape resolution depends on it.
struct DeviceLight {
    double pixelPitch = 2.0 / 6080.0; ///< metres on the device from pixel to pixel: the lab's projector, 2 m above
    double framesPerSecond = 60.0;
    Angle elevation = Angle::degrees(45.0); ///< of the viewer above the table
};

/// What the servos have to carry.
struct DeviceLoad {
    double arealDensity = 2.4; ///< kilograms a square metre of moved top: 2 mm of flexible filament (1.2 g/cm3)
    double push = 0.5;         ///< newtons against the point that moves farthest: a finger that rests there
};

/// One feature of shape resolution, for the device alone, for light alone, and for both. Empty: there is no such thing.
struct ShapeMetric {
    std::string_view key;     ///< "area", "zeroCrossing", ...
    std::string_view name;    ///< as the field writes it
    std::string_view unit;    ///< SI, "" for a bare number
    std::string_view meaning; ///< how the physical value is defined here
    std::string_view light;   ///< how that of light is, and what the two do together
    std::optional<double> physical;
    std::optional<double> withLight;
    std::optional<double> together;
};

/// What one actuator's servo has to do.
struct ServoLoad {
    std::string actuator;
    const ServoType* servo = nullptr; ///< the one it is judged for, of the table
    double lever = 0.0;               ///< metres that its farthest point moves for a radian of the servo, at most
    double torque = 0.0;              ///< newton metres needed against weight and push, where it is hardest
    double force = 0.0;               ///< newtons that its servo brings to that point when it stalls
    bool weak = false;                ///< needs more than the servo's usable torque
    std::string_view stronger;        ///< the cheapest servo that is strong enough; empty: none in the table
};

struct ShapeResolutionOptions {
    DeviceLight light;
    DeviceLoad load;
    const ServoType* servo = nullptr; ///< of actuators whose own the rig does not name; none: the SG90
    std::uint64_t seed = 1;           ///< which joint states, where there are too many for all
};

/// The angle that a servo turns for an actuator's full stroke: that of what turns, else what its pulses turn it.
[[nodiscard]] Angle servoAngle(const Actuator& actuator, const ServoType& servo);
/// What the servo of one actuator has to do: its own where the rig names one of the table, else `servo` (none: the
/// SG90).
[[nodiscard]] ServoLoad servoLoad(const Rig& rig, std::size_t actuator, const ServoType* servo = nullptr,
                                  const DeviceLoad& load = {});

/// Shape resolution after A. Roudaut, A. Karnik, M. Löchtefeld, S. Subramanian, "Morphees: toward high 'shape
/// resolution' in self-actuated flexible mobile devices", CHI 2013: ten features, of which light adds to some.
///
/// Theirs are defined on the control points of a NURBS surface; a rig is a mesh, so they are measured on it:
/// a *control point* is an actuator (the point of the top that it moves farthest), and angles are those between
/// consecutive points of *sections*, straight lines across the top at rest, 64 points on its longer side, which follow
/// the surface as it moves. The top is what looks up at rest, by 45 degrees or more. Joint states looked at are those
/// in which every actuator is at rest or at full stroke: all of them up to six actuators, else 64 (of a seed; among
/// them every second one raised).
struct ShapeResolution {
    std::string name;
    std::vector<ShapeMetric> metrics; ///< the ten, in their paper's order
    std::vector<ServoLoad> loads;     ///< one an actuator
    std::vector<std::string> warnings;
};

/// Measures a rig. Light: an apparent shape has no material, so area, porosity, curvature, amplitude, zero-crossing,
/// granularity and speed of what is *seen* grow, while closure, stretchability and strength are left as they are.
/// Throws InvalidInput for options that are not positive and finite, Cancelled.
[[nodiscard]] ShapeResolution shapeResolution(const Rig& rig, const ShapeResolutionOptions& options = {},
                                              const Progress& progress = {});

/// The metric of a key. Throws InvalidInput when there is none.
[[nodiscard]] const ShapeMetric& metricOf(const ShapeResolution& resolution, std::string_view key);

/// A metric's value in the unit that a maker measures in: "12.3 cm2", "40 mm", "0.8"; "-" where there is none.
[[nodiscard]] std::string inUsualUnit(const std::optional<double>& value, std::string_view unit);

} // namespace lumorph
