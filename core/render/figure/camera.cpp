#include "core/render/figure/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

const glm::vec3 kUp(0.0F, 1.0F, 0.0F);

} // namespace

glm::mat4 cameraFromWorld(const Camera& camera) { return glm::lookAt(camera.eye, camera.centre, kUp); }

glm::mat4 clipFromWorld(const Camera& camera) {
    return glm::perspective(static_cast<float>(camera.fieldOfView.inRadians()), camera.aspect, camera.nearDistance,
                            camera.farDistance) *
           cameraFromWorld(camera);
}

glm::vec2 pixelOf(const Camera& camera, const glm::vec3& point, glm::vec2 size) {
    const glm::vec4 clip = clipFromWorld(camera) * glm::vec4(point, 1.0F);
    const glm::vec2 unit(clip.x / clip.w, -clip.y / clip.w);
    return (0.5F * unit + 0.5F) * size;
}

Camera frameBox(const Box& box, const glm::vec3& direction, float aspect, float fill) {
    const float radius = 0.5F * glm::length(box.size());
    if (box.empty() || !(radius > 0.0F) || !std::isfinite(radius + glm::length(box.centre())))
        throw InvalidInput("view", "there is nothing with a size to look at", "give a mesh with finite extent");
    const glm::vec3 back = glm::normalize(direction);
    const glm::vec3 right = glm::normalize(glm::cross(kUp, back));
    const glm::vec3 up = glm::cross(back, right);
    Camera camera;
    camera.aspect = aspect;
    const float tanUp = fill * std::tan(0.5F * static_cast<float>(camera.fieldOfView.inRadians()));
    const float tanRight = aspect * tanUp;

    // The two sides of the view that bind across an axis meet at the axis: that fixes centre and distance.
    glm::vec2 low(1e30F);
    glm::vec2 high(-1e30F);
    for (const glm::vec3& corner : cornersOf(box)) {
        const glm::vec3 p = corner - box.centre();
        const float depth = glm::dot(p, back);
        const glm::vec2 side(glm::dot(p, right) / tanRight, glm::dot(p, up) / tanUp);
        high = glm::max(high, side + depth);
        low = glm::min(low, side - depth);
    }
    const glm::vec2 middle = 0.5F * (high + low);
    const glm::vec2 reach = 0.5F * (high - low);
    const float distance = std::max(reach.x, reach.y);
    camera.centre = box.centre() + middle.x * tanRight * right + middle.y * tanUp * up;
    camera.eye = camera.centre + distance * back;
    camera.nearDistance = std::max(0.02F * distance, distance - 2.0F * radius);
    camera.farDistance = distance + 20.0F * radius;
    return camera;
}

} // namespace lumorph
