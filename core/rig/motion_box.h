#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// Where vertices can be while every stroke stays in an interval, metres: at + sum_i slope_i x_i + r, with x_i in
/// [-1, 1] the place of axis i in its interval and |r| <= rest in each component.
struct MotionBox {
    std::vector<glm::vec3> at;
    std::vector<glm::vec3> rest;
    std::vector<glm::vec3> slopes; ///< [vertex * axes + axis]
    /// What `rest` holds, where the rig has a sheet: quadratic coefficients, those of squares halved because `at` holds
    /// the other half, and a bound of all others. Two vertices differ by no more than their coefficients and `tail` do.
    std::size_t pairs = 0;             ///< of the sheet's axes, a pair of two or of one twice
    std::vector<glm::vec3> curvatures; ///< [vertex * pairs + pair]
    std::vector<glm::vec3> tail;       ///< one a vertex, also without a sheet
};

/// First-order bounds of a rig's motion over boxes of strokes (Taylor models: a linear part and a bound of the rest).
/// Of a sheet the rest follows from the monomial coefficients of its polynomial in the box' own coordinates; of other
/// vertices from the corners of the box and `strokeBounds`. Immutable; safe to share between threads.
class MotionBounds {
public:
    /// The axes of the boxes are `actuators`; the strokes of all others are 0. Every actuator that moves one of the
    /// vertices must be among them, except levers of a sheet that move none.
    MotionBounds(const Rig& rig, std::span<const std::uint32_t> vertices, std::span<const std::uint16_t> actuators);
    ~MotionBounds();
    MotionBounds(MotionBounds&&) noexcept;
    MotionBounds& operator=(MotionBounds&&) noexcept;

    /// `low` and `high` have one stroke in [0, 1] an axis.
    void over(std::span<const double> low, std::span<const double> high, MotionBox& out) const;

private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

} // namespace lumorph
