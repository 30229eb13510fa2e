#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/rig/rig.h"
#include "core/voxels/height_grid.h"

namespace lumorph::ice {

/// How the device's surface is bent by its actuators, fast enough to be asked each frame: heights over rest add up from
/// those that each actuator gives alone at a small stroke.
class Bending {
public:
    /// Deforms the rig once an actuator: tens of milliseconds.
    explicit Bending(const Rig& rig);

    /// Where the actuators are now; other numbers of strokes than of actuators, and what is not finite, count as rest.
    void set(std::span<const double> strokes);
    /// Metres over rest at a place (x and z).
    [[nodiscard]] double heightAt(const glm::dvec2& place) const noexcept;
    /// How sharply it is bent across a direction of length 1, 1 over metres.
    [[nodiscard]] double curvatureAt(const glm::dvec2& place, const glm::dvec2& direction) const noexcept;

    /// How far it can be lifted at a place by all actuators together: 0, nowhere, to 1, as far as anywhere.
    [[nodiscard]] double roomAt(const glm::dvec2& place) const noexcept;

private:
    HeightGrid now_;                        ///< over rest
    std::vector<std::vector<float>> rises_; ///< a full stroke of each actuator, at the samples of `now_`
    HeightGrid room_;                       ///< as `roomAt`
};

} // namespace lumorph::ice
