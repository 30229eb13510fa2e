#include "core/scene/show_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace lumorph {
namespace {

// Things that ride on the device count in whole steps, so that the view does not swim while they bob and dance.
constexpr float kHeightStep = 0.02F;
// Half a right angle and a bit: wider views spend their pixels on the far corners of the table.
constexpr double kWidestTangent = 1.6;

// Highest point over the device's ground plan of what is posed above it, in the device's frame.
float heightAbove(const ShowFrame& frame, const Box& reach) {
    const glm::mat4 deviceFromWorld = glm::inverse(frame.worldFromDevice);
    float highest = reach.max.y;
    for (const PosedSurface& surface : frame.posed.surfaces) {
        const auto corners = seenCorners(surface);
        if (!corners) continue;
        Box box;
        for (const glm::vec3& corner : *corners) box.include(glm::vec3(deviceFromWorld * glm::vec4(corner, 1.0F)));
        const bool above =
            box.max.x > reach.min.x && box.min.x < reach.max.x && box.max.z > reach.min.z && box.min.z < reach.max.z;
        if (above && std::isfinite(box.max.y)) highest = std::max(highest, box.max.y);
    }
    const float steps = std::ceil((highest - reach.max.y) / kHeightStep);
    const float most = 0.5F * glm::length(reach.size());
    return reach.max.y + std::min(steps * kHeightStep, most);
}

} // namespace

std::optional<std::array<glm::vec3, 8>> seenCorners(const PosedSurface& surface) {
    if (!(surface.opacity > 0.0F) || !surface.positions || surface.positions->empty()) return std::nullopt;
    const auto corners = cornersOf(boundingBox(*surface.positions), surface.worldFromSurface);
    const bool finite = std::ranges::all_of(
        corners, [](const glm::vec3& at) { return std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z); });
    return finite ? std::optional(corners) : std::nullopt;
}

glm::vec3 loweredEye(const glm::vec3& eye, double by) {
    constexpr double kLowest = 0.2; // radians over the table
    if (by == 0.0) return eye;
    const double out = std::hypot(double(eye.x), double(eye.z)), far = std::hypot(out, double(eye.y));
    const double up = std::max(std::atan2(double(eye.y), out) - by, kLowest);
    const double nearer = out > 0.0 ? far * std::cos(up) / out : 0.0;
    return glm::vec3(glm::dvec3(nearer * eye.x, far * std::sin(up), nearer * eye.z));
}

CalibratedCamera deviceView(const ShowFrame& frame, const glm::vec3& eye, glm::ivec2 size) {
    Box box = frame.rig->reach();
    box.max.y = heightAbove(frame, box);
    return eyeCamera(glm::dvec3(eye), cornersOf(box, frame.worldFromDevice), size);
}

CalibratedCamera tableView(const ShowFrame& frame, const glm::vec3& eye, glm::ivec2 size) {
    const glm::vec3 device(frame.worldFromDevice[3]);
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    const glm::dvec3 aim(std::clamp(device.x, -half.x, half.x), 0.0, std::clamp(device.z, -half.y, half.y));
    CalibratedCamera camera = cameraLookingAt(glm::dvec3(eye), aim, size, 1.0);
    constexpr int kSteps = 24;
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    glm::dvec2 low(kInfinite);
    glm::dvec2 high(-kInfinite);
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; j <= kSteps; ++j) {
            const glm::dvec2 at = glm::dvec2(half) * (2.0 * glm::dvec2(i, j) / double(kSteps) - 1.0);
            const glm::dvec3 local(camera.cameraFromWorld * glm::dvec4(at.x, 0.0, at.y, 1.0));
            if (!(local.z > 0.0)) continue;
            const glm::dvec2 tangent = glm::clamp(glm::dvec2(local) / local.z, -kWidestTangent, kWidestTangent);
            low = glm::min(low, tangent);
            high = glm::max(high, tangent);
        }
    const glm::dvec2 extent = glm::max(high - low, glm::dvec2(1e-3));
    const double focal = std::min(size.x / extent.x, size.y / extent.y);
    camera.focal = glm::dvec2(focal);
    camera.principal = 0.5 * glm::dvec2(size - 1) - 0.5 * focal * (low + high);
    return camera;
}

} // namespace lumorph
