#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// An actuator's deformer with everything that does not depend on the stroke worked out.
struct CompiledActuator {
    enum class Kind : std::uint8_t { morph, skin, lever, hinge, bend, slide };
    Kind kind = Kind::slide;
    double range = 0.0;  ///< max - min: radians, metres; 1 for morph targets and levers of a sheet
    double length = 0.0; ///< metres of arc (bend)
    glm::vec3 origin{0.0F};
    glm::vec3 axis{0.0F};      ///< unit
    glm::vec3 direction{0.0F}; ///< unit; of the slide, or from the bend line to the free end
    glm::vec3 normal{0.0F};    ///< axis x direction: the side to which a bend lifts
};

[[nodiscard]] CompiledActuator compileActuator(const Actuator& actuator);

/// Where morph target keys stand at a stroke: between keys `lower` and `lower + 1`, -1 being rest.
struct KeyPlace {
    int lower = -1;
    float share = 0.0F;
};

/// An actuator at one stroke and weight: the sines and cosines, worked out once for many vertices.
struct MotionSetup {
    bool still = true; ///< nothing moves
    glm::mat3 turn{1.0F};
    glm::vec3 shift{0.0F};
    float radius = 0.0F;    ///< of the neutral surface
    float curvature = 0.0F; ///< 1/metres
    float length = 0.0F;
    float sinEnd = 0.0F;
    float versinEnd = 0.0F; ///< 1 - cos
    KeyPlace keys;
};

[[nodiscard]] MotionSetup setUp(const Actuator& actuator, const CompiledActuator& compiled, double stroke,
                                float weight) noexcept;

/// Displacement of one influence of a morph target.
[[nodiscard]] glm::vec3 morphDisplacement(const MorphTarget& morph, KeyPlace place, std::uint32_t influence) noexcept;

/// sin and 1 - cos for |angle| up to 2 pi, to float precision. Branch-free, so that a loop over it
/// runs in vector registers.
inline void sinVersin(float angle, float& sine, float& versine) noexcept {
    // Taylor series at a quarter of the angle (at most pi/2), doubled twice.
    const float q = 0.25F * angle;
    const float q2 = q * q;
    const float s =
        q * (1.0F +
             q2 * (-1.0F / 6.0F + q2 * (1.0F / 120.0F + q2 * (-1.0F / 5040.0F +
                                                              q2 * (1.0F / 362880.0F + q2 * (-1.0F / 39916800.0F))))));
    const float v =
        q2 * (0.5F + q2 * (-1.0F / 24.0F + q2 * (1.0F / 720.0F + q2 * (-1.0F / 40320.0F + q2 * (1.0F / 3628800.0F)))));
    const float halfSine = 2.0F * s * (1.0F - v);
    const float halfCosine = 1.0F - 2.0F * s * s;
    sine = 2.0F * halfSine * halfCosine;
    versine = 2.0F * halfSine * halfSine;
}

/// Where the arc of a bend takes a point `u` from the bend line (0 < u <= length) and `h` above the
/// neutral surface; in the same two coordinates.
inline glm::vec2 bendArc(const MotionSetup& setup, float u, float h) noexcept {
    float sine;
    float versine;
    sinVersin(setup.curvature * u, sine, versine);
    return {(setup.radius - h) * sine, (setup.radius - h) * versine + h};
}

/// The same beyond the arc, where the sheet is straight again.
inline glm::vec2 bendStraight(const MotionSetup& setup, float u, float h) noexcept {
    const float beyond = u - setup.length;
    return {(setup.radius - h) * setup.sinEnd + beyond * (1.0F - setup.versinEnd),
            (setup.radius - h) * setup.versinEnd + h + beyond * setup.sinEnd};
}

/// A hinge, bend or slide on one point.
[[nodiscard]] glm::vec3 applySpace(const CompiledActuator& compiled, const MotionSetup& setup,
                                   const glm::vec3& point) noexcept;

inline constexpr std::size_t kMaxJoints = 256;

/// How the joints have moved from rest.
struct SkinPose {
    bool still = true;
    glm::mat4x3 moved[kMaxJoints]; ///< device coordinates to device coordinates; unset while still
};

/// Only the joints' share of the strokes is read.
void poseSkin(const Skeleton& skeleton, std::span<const Actuator> actuators,
              std::span<const std::uint16_t> skinActuators, std::span<const double> strokes, SkinPose& pose) noexcept;

[[nodiscard]] inline glm::vec3 skinned(const SkinPose& pose, const glm::u16vec4& joints, const glm::vec4& weights,
                                       const glm::vec3& point) noexcept {
    glm::vec3 sum(0.0F);
    for (int k = 0; k < 4; ++k)
        if (weights[k] != 0.0F) sum += weights[k] * (pose.moved[joints[k]] * glm::vec4(point, 1.0F));
    return sum;
}

} // namespace lumorph
