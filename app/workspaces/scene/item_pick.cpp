#include "app/workspaces/scene/item_pick.h"

#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace lumorph::studio {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();

/// The ray's length to a triangle, from either side; infinite when it misses.
float meet(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a, ac = c - a;
    const glm::vec3 across = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, across);
    if (std::abs(determinant) < 1e-12F) return kNowhere;
    const glm::vec3 from = ray.origin - a;
    const float u = glm::dot(from, across) / determinant;
    const glm::vec3 other = glm::cross(from, ab);
    const float v = glm::dot(ray.direction, other) / determinant;
    if (u < 0.0F || v < 0.0F || u + v > 1.0F) return kNowhere;
    const float along = glm::dot(ac, other) / determinant;
    return along > 0.0F ? along : kNowhere;
}

/// The direction keeps its length in world metres, so lengths along the ray can be compared between surfaces.
Ray inFrame(const Ray& ray, const glm::mat4& worldFromFrame) {
    const glm::mat4 frameFromWorld = glm::inverse(worldFromFrame);
    return {glm::vec3(frameFromWorld * glm::vec4(ray.origin, 1.0F)),
            glm::vec3(frameFromWorld * glm::vec4(ray.direction, 0.0F))};
}

float nearest(const Ray& ray, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    float best = kNowhere;
    for (const glm::uvec3& triangle : triangles)
        best = std::min(best, meet(ray, positions[triangle.x], positions[triangle.y], positions[triangle.z]));
    return best;
}

} // namespace

Ray rayThrough(const CalibratedCamera& camera, glm::vec2 at) {
    return {glm::vec3(positionOf(camera)), glm::vec3(directionOf(camera, glm::dvec2(at) - 0.5))};
}

int pickItem(const ShowFrame& frame, const Ray& ray) {
    int item = 0;
    float best = kNowhere;
    // A device that is a mere screen hides nothing of what is shown below its surface.
    if (frame.scene->device.show == DeviceSkin::Show::material)
        best = nearest(inFrame(ray, frame.worldFromDevice), *frame.devicePositions, frame.rig->restMesh().triangles);
    for (const PosedSurface& surface : frame.posed.surfaces) {
        const float along =
            nearest(inFrame(ray, surface.worldFromSurface), *surface.positions, surface.topology->triangles);
        if (!(along < best)) continue;
        best = along;
        item = surface.item;
    }
    return item;
}

Box boxOf(const ShowFrame& frame, int item) {
    Box box;
    for (const PosedSurface& surface : frame.posed.surfaces) {
        if (surface.item != item) continue;
        for (const glm::vec3& position : *surface.positions)
            box.include(glm::vec3(surface.worldFromSurface * glm::vec4(position, 1.0F)));
    }
    return box;
}

} // namespace lumorph::studio
