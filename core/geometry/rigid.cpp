#include "core/geometry/rigid.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace lumorph {

Rigid Rigid::exp(const PoseVector& vector) {
    const glm::dvec3 turn(vector[0], vector[1], vector[2]);
    const double angle = glm::length(turn);
    const bool isSmall = angle < 1e-4; // where the quotients lose digits
    const double half = std::sin(0.5 * angle);
    const double first = isSmall ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
    const double second = isSmall ? 0.5 - angle * angle / 24.0 : 2.0 * half * half / (angle * angle);
    // Columns of the matrix that makes a cross product with the vector from the left.
    const glm::dmat3 cross({0.0, turn.z, -turn.y}, {-turn.z, 0.0, turn.x}, {turn.y, -turn.x, 0.0});
    return {glm::dmat3(1.0) + first * cross + second * (cross * cross), {vector[3], vector[4], vector[5]}};
}

PoseVector Rigid::log() const {
    // By a quaternion: a matrix's trace alone is inexact near 0 and pi.
    const glm::dquat q = glm::quat_cast(rotation);
    const glm::dvec3 axis = glm::dvec3(q.x, q.y, q.z) * (q.w < 0.0 ? -1.0 : 1.0);
    const double sine = glm::length(axis);
    const glm::dvec3 turn = axis * (sine < 1e-12 ? 2.0 : 2.0 * std::atan2(sine, std::abs(q.w)) / sine);
    return {turn.x, turn.y, turn.z, translation.x, translation.y, translation.z};
}

glm::dmat4 Rigid::matrix() const {
    glm::dmat4 all(rotation);
    all[3] = glm::dvec4(translation, 1.0);
    return all;
}

Rigid Rigid::inverse() const {
    const glm::dmat3 back = glm::transpose(rotation);
    return {back, -(back * translation)};
}

Rigid operator*(const Rigid& aFromB, const Rigid& bFromC) {
    return {aFromB.rotation * bFromC.rotation, aFromB * bFromC.translation};
}

glm::dvec3 operator*(const Rigid& aFromB, const glm::dvec3& inB) { return aFromB.rotation * inB + aFromB.translation; }

} // namespace lumorph
