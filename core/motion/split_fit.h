#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/motion/joint_fit.h"
#include "core/motion/stroke_fit.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What both forms of the frequency split stand on: points over the device's top, and the strokes whose surface comes
/// closest to wished heights over rest there (the split's reach in space).
class SplitFit {
public:
    /// A grid of about `spacing` metres over the top (coarser where that were more than 4000 points). Throws
    /// InvalidInput for a spacing that is no finite number above zero.
    SplitFit(const Rig& rig, double spacing);
    SplitFit(const SplitFit&) = delete; ///< the fits hold on to the surface
    SplitFit& operator=(const SplitFit&) = delete;

    [[nodiscard]] const TopSurface& surface() const noexcept { return surface_; }
    [[nodiscard]] std::size_t points() const noexcept { return surface_.points().size(); }
    /// Strokes a second, one an actuator.
    [[nodiscard]] const std::vector<double>& speeds() const noexcept { return speeds_; }

    /// How far a wished height (device metres) lies over rest at a point: held to 10 m either way; NaN wishes rest.
    [[nodiscard]] double liftAt(std::size_t point, float height) const noexcept;
    /// The strokes for lifts; goes on from `from`, the strokes of the call before, or begins anew where it is empty.
    [[nodiscard]] std::vector<double> best(std::span<const double> lifts, std::span<const double> from);
    /// Holds strokes to what the velocity limits allow `seconds` after `before`.
    void limit(std::span<double> strokes, std::span<const double> before, double seconds) const noexcept;

private:
    TopSurface surface_;
    StrokeFit fit_;
    std::optional<JointFit> joint_; ///< where the sum that `fit_` takes is not what the actuators do together
    std::vector<double> speeds_;
};

} // namespace lumorph
