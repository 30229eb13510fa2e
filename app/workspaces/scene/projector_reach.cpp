#include "app/workspaces/scene/projector_reach.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtx/component_wise.hpp>

namespace lumorph::studio {

namespace {

constexpr double kWhiteEnough = 0.9; // nobody sees a tenth

bool inPicture(const CalibratedCamera& projector, const glm::dvec3& point) {
    const auto pixel = pixelOf(projector, point);
    return pixel && pixel->x >= -0.5 && pixel->y >= -0.5 && pixel->x < projector.size.x - 0.5 &&
           pixel->y < projector.size.y - 0.5;
}

} // namespace

ProjectorReach reachOf(const InstalledProjector& projector, const glm::vec3& albedo,
                       const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                       const glm::mat4& worldFromSurface) {
    const double least = std::cos(kSteepDegrees * std::numbers::pi / 180.0);
    const glm::dvec3 from = positionOf(projector.camera);
    // Radiance head on at the reference distance, where 1 is white, of the channel that has the least.
    const double white = projector.peak * glm::compMin(projector.gain * albedo);
    double whole = 0.0, missed = 0.0, steep = 0.0, dim = 0.0;
    for (const glm::uvec3& triangle : triangles) {
        glm::dvec3 corners[3];
        for (int i = 0; i < 3; ++i) corners[i] = glm::dvec3(worldFromSurface * glm::vec4(positions[triangle[i]], 1.0F));
        const glm::dvec3 twice = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double area = 0.5 * glm::length(twice);
        if (area < 1e-12 || twice.y < 0.2 * 2.0 * area) continue; // housing and walls
        whole += area;
        const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        const double slant = glm::dot(twice, glm::normalize(from - middle)) / (2.0 * area);
        const double nearness = projector.referenceDistance / glm::distance(from, middle);
        if (!inPicture(projector.camera, middle))
            missed += area;
        else if (slant < least)
            steep += area;
        else if (white * slant * nearness * nearness < kWhiteEnough)
            dim += area;
    }
    const auto share = [](double part, double of) { return of > 0.0 ? part / of : 0.0; };
    return {share(missed, whole), share(steep, whole - missed), share(dim, whole - missed - steep)};
}

} // namespace lumorph::studio
