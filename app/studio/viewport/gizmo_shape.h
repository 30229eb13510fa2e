#pragma once

#include <array>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat4x4.hpp>

#include "app/studio/viewport/gizmo.h"

namespace lumorph::studio {

/// Where the handles are, in arrow lengths from the centre.
inline constexpr float kArrowStart = 0.12F;
inline constexpr float kSquareFrom = 0.24F;
inline constexpr float kSquareTo = 0.50F;
inline constexpr float kRingRadius = 0.74F;
/// The size cube hangs in the picture's plane, up and to the right, so that no view hides it.
inline constexpr float kSizeOffset = 0.95F;

/// The axes of the picture in the world; `back` leads to the eye.
struct PictureAxes {
    glm::vec3 right, up, back;
};
[[nodiscard]] inline PictureAxes pictureAxes(const ViewCamera& camera) {
    const glm::mat4 view = viewFromWorld(camera);
    return {glm::vec3(glm::row(view, 0)), glm::vec3(glm::row(view, 1)), glm::vec3(glm::row(view, 2))};
}

/// The unit vector of an arrow.
[[nodiscard]] inline glm::vec3 axisOf(GizmoHandle arrow) {
    return {arrow == GizmoHandle::moveX ? 1.0F : 0.0F, arrow == GizmoHandle::moveY ? 1.0F : 0.0F,
            arrow == GizmoHandle::moveZ ? 1.0F : 0.0F};
}

/// Whether an axis lies so near the direction of view that nothing can be dragged along it.
[[nodiscard]] bool pointsAtCamera(const glm::vec3& axis, const glm::vec3& at, const ViewCamera& camera);

/// Metres of an arrow; 0 where the centre lies behind the eye.
[[nodiscard]] inline float gizmoLength(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 size, double scale) {
    return static_cast<float>(kGizmoReach * scale) * metresPerPixel(camera, gizmo.centre, size);
}
[[nodiscard]] inline std::array<glm::vec3, 4> groundSquare(const Gizmo& gizmo, float length) {
    const float a = kSquareFrom * length;
    const float b = kSquareTo * length;
    const glm::vec3 c = gizmo.centre;
    return {c + glm::vec3(a, 0, a), c + glm::vec3(b, 0, a), c + glm::vec3(b, 0, b), c + glm::vec3(a, 0, b)};
}
/// Closed: the last point is the first.
[[nodiscard]] std::vector<glm::vec3> turnRing(const Gizmo& gizmo, float length);
[[nodiscard]] inline glm::vec3 sizeCube(const Gizmo& gizmo, const ViewCamera& camera, float length) {
    const PictureAxes axes = pictureAxes(camera);
    return gizmo.centre + kSizeOffset * length * glm::normalize(axes.right + axes.up);
}

} // namespace lumorph::studio
