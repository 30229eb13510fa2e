#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// A rigid motion as six numbers: a rotation vector (axis times angle, radians) and a translation.
using PoseVector = std::array<double, 6>;

/// A rigid motion `aFromB`: a point X in the frame b is R X + t in the frame a.
struct Rigid {
    glm::dmat3 rotation{1.0};
    glm::dvec3 translation{0.0};

    Rigid() = default;
    Rigid(const glm::dmat3& r, const glm::dvec3& t) : rotation(r), translation(t) {}
    /// The upper rows of a matrix that is rigid.
    explicit Rigid(const glm::dmat4& matrix) : rotation(matrix), translation(matrix[3]) {}

    /// Rodrigues' formula, and its inverse, whose angle is 0 to pi; the translation is taken as it is. These are exp
    /// and log of the composite manifold SO(3) x R3 (Sola, Deray, Atchuthan, "A micro Lie theory", section IV and
    /// appendix B), not of SE(3).
    [[nodiscard]] static Rigid exp(const PoseVector& vector);
    [[nodiscard]] PoseVector log() const;

    [[nodiscard]] glm::dmat4 matrix() const;
    [[nodiscard]] Rigid inverse() const;
};

[[nodiscard]] Rigid operator*(const Rigid& aFromB, const Rigid& bFromC);
[[nodiscard]] glm::dvec3 operator*(const Rigid& aFromB, const glm::dvec3& inB);

} // namespace lumorph
