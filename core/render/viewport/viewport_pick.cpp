#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "core/render/viewport/viewport_renderer.h"

namespace lumorph {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

bool pickable(const ViewportSurface& surface) {
    return surface.id != 0 && surface.opacity > 0.0F && surface.shading && surface.positions &&
           surface.positions->size() == surface.shading->meshVertexCount();
}

// Where a ray enters a box, in units of its direction; never when it misses. From inside that is 0.
float entryOf(const Ray& ray, const glm::vec3& low, const glm::vec3& high) {
    float first = 0.0F;
    float last = kNever;
    for (int axis = 0; axis < 3; ++axis) {
        const float speed = ray.direction[axis];
        if (speed == 0.0F) {
            if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) return kNever;
            continue;
        }
        const float a = (low[axis] - ray.origin[axis]) / speed;
        const float b = (high[axis] - ray.origin[axis]) / speed;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last ? first : kNever;
}

struct TriangleMeeting {
    float distance = kNever; // in units of the ray's direction
    float u = 0.0F;          // shares of the second and the third corner
    float v = 0.0F;
};

// Where a ray meets a triangle; both sides count.
TriangleMeeting meeting(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const glm::vec3 p = glm::cross(ray.direction, ac);
    const float volume = glm::dot(ab, p);
    if (volume == 0.0F) return {};
    const glm::vec3 from = ray.origin - a;
    const float u = glm::dot(from, p) / volume;
    const glm::vec3 q = glm::cross(from, ab);
    const float v = glm::dot(ray.direction, q) / volume;
    const float t = glm::dot(ac, q) / volume;
    return {u >= 0.0F && v >= 0.0F && u + v <= 1.0F && t > 0.0F ? t : kNever, u, v};
}

struct SurfaceMeeting {
    float distance = kNever;
    ViewportHit::Corners corners;
};

SurfaceMeeting meeting(const Ray& ray, const ViewportSurface& surface) {
    const glm::mat4 surfaceFromWorld = glm::inverse(surface.worldFromSurface);
    // Not made of length 1: distances along it stay those of the world.
    Ray local{glm::vec3(surfaceFromWorld * glm::vec4(ray.origin, 1.0F)),
              glm::vec3(surfaceFromWorld * glm::vec4(ray.direction, 0.0F))};
    const std::vector<glm::vec3>& positions = *surface.positions;
    // From near the surface, where small numbers are exact.
    const Box box = boundingBox(positions);
    const float start = entryOf(local, box.min, box.max);
    if (start == kNever) return {};
    local.origin += start * local.direction;
    const float back = std::min(1e-4F * glm::length(box.size()) / glm::length(local.direction), start);
    local.origin -= back * local.direction;
    const std::span<const std::uint32_t> sources = surface.shading->sources();
    SurfaceMeeting nearest;
    for (const glm::uvec3& t : surface.shading->triangles()) {
        const glm::uvec3 at(sources[t.x], sources[t.y], sources[t.z]);
        const TriangleMeeting met = meeting(local, positions[at.x], positions[at.y], positions[at.z]);
        if (met.distance < nearest.distance)
            nearest = {met.distance, {at, glm::vec3(1.0F - met.u - met.v, met.u, met.v)}};
    }
    nearest.distance += start - back;
    return nearest;
}

struct VoxelMeeting {
    float distance = kNever;
    glm::ivec3 voxel{0};
};

VoxelMeeting meeting(const Ray& ray, const ViewportVoxels& cloud) {
    VoxelMeeting nearest;
    const Box box = cloud.frame.box();
    const float start = entryOf(ray, box.min, box.max);
    if (start == kNever) return nearest;
    const auto voxelSize = static_cast<float>(cloud.frame.voxelSize);
    // In voxels, from where the ray enters the frame.
    const Ray local{(ray.origin + start * ray.direction - cloud.frame.origin) / voxelSize, ray.direction / voxelSize};
    const float half = 0.5F * cloud.side;
    for (const ViewportVoxel& voxel : *cloud.voxels) {
        const glm::vec3 centre = glm::vec3(voxel.x, voxel.y, voxel.z) + 0.5F;
        const float distance = start + entryOf(local, centre - half, centre + half);
        if (distance < nearest.distance) nearest = {distance, {voxel.x, voxel.y, voxel.z}};
    }
    return nearest;
}

} // namespace

std::optional<ViewportHit> pick(const ViewportScene& scene, const Ray& ray) {
    ViewportHit nearest;
    nearest.distance = kNever;
    for (const ViewportSurface& surface : scene.surfaces) {
        if (!pickable(surface)) continue;
        const SurfaceMeeting met = meeting(ray, surface);
        if (met.distance < nearest.distance) nearest = {surface.id, {}, met.distance, std::nullopt, met.corners};
    }
    for (const ViewportVoxels& cloud : scene.voxels) {
        if (cloud.id == 0 || !cloud.voxels || !(cloud.opacity > 0.0F)) continue;
        const VoxelMeeting met = meeting(ray, cloud);
        if (met.distance < nearest.distance) nearest = {cloud.id, {}, met.distance, met.voxel, std::nullopt};
    }
    if (nearest.distance == kNever) return std::nullopt;
    nearest.point = ray.origin + nearest.distance * ray.direction;
    return nearest;
}

} // namespace lumorph
