#include "core/render/gl/camera_uniforms.h"

#include <algorithm>
#include <limits>

namespace lumorph {
namespace {

// Wider than this (84 degrees off the axis) a lens that spreads outwards would overflow.
constexpr double kWidestSquare = 100.0;
constexpr double kNearest = 1e-3;

} // namespace

void setCamera(Program& program, const CalibratedCamera& camera, double near, double far, const std::string& lens) {
    const auto& k = camera.distortion;
    const glm::dmat4 clip = clipFromCamera(camera, near, far);
    const bool distorts = k != std::array<double, 5>{};
    program.set(lens + ".cameraFromWorld", glm::mat4(camera.cameraFromWorld));
    program.set(lens + ".clip", glm::vec4(clip[0][0], clip[1][1], clip[2][0], clip[2][1]));
    program.set(lens + ".depth", glm::vec2(clip[2][2], clip[3][2]));
    program.set(lens + ".radial", glm::vec3(k[0], k[1], k[4]));
    program.set(lens + ".tangential", glm::vec2(k[2], k[3]));
    program.set(lens + ".limit",
                distorts ? static_cast<float>(std::min(distortionLimit(camera), kWidestSquare)) : 0.0F);
}

DepthRange depthRange(const CalibratedCamera& camera, const Box& box) {
    if (box.empty()) return {};
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 at((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                            (corner & 4) != 0 ? box.max.z : box.min.z, 1.0);
        const double distance = (camera.cameraFromWorld * at).z;
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    if (!(farthest > kNearest)) return {};
    const double near = std::max({0.98 * nearest, 1e-4 * farthest, kNearest});
    return {near, std::max(1.02 * farthest, 2.0 * near)};
}

} // namespace lumorph
