#include "app/workspaces/scene/projector_reach.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace lumorph::studio {

namespace {

bool inPicture(const CalibratedCamera& projector, const glm::dvec3& point) {
    const auto pixel = pixelOf(projector, point);
    return pixel && pixel->x >= -0.5 && pixel->y >= -0.5 && pixel->x < projector.size.x - 0.5 &&
           pixel->y < projector.size.y - 0.5;
}

} // namespace

ProjectorReach reachOf(const CalibratedCamera& projector, const std::vector<glm::vec3>& positions,
                       const std::vector<glm::uvec3>& triangles, const glm::mat4& worldFromSurface) {
    const double least = std::cos(kSteepDegrees * std::numbers::pi / 180.0);
    const glm::dvec3 from = positionOf(projector);
    double whole = 0.0, missed = 0.0, steep = 0.0;
    for (const glm::uvec3& triangle : triangles) {
        glm::dvec3 corners[3];
        for (int i = 0; i < 3; ++i) corners[i] = glm::dvec3(worldFromSurface * glm::vec4(positions[triangle[i]], 1.0F));
        const glm::dvec3 twice = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double area = 0.5 * glm::length(twice);
        if (area < 1e-12 || twice.y < 0.2 * 2.0 * area) continue; // housing and walls
        whole += area;
        const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        if (!inPicture(projector, middle))
            missed += area;
        else if (glm::dot(twice, glm::normalize(from - middle)) < least * 2.0 * area)
            steep += area;
    }
    if (whole <= 0.0) return {};
    return {missed / whole, whole > missed ? steep / (whole - missed) : 0.0};
}

} // namespace lumorph::studio
