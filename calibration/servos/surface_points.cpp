#include "calibration/servos/surface_points.h"

#include <optional>

#include <glm/geometric.hpp>

namespace lumorph {

namespace {

/// Where two rays pass one another most closely: on the first of them, which is the camera's and the sharper one.
std::optional<glm::dvec3> meeting(const glm::dvec3& from, const glm::dvec3& way, const glm::dvec3& otherFrom,
                                  const glm::dvec3& otherWay) {
    const glm::dvec3 across = glm::cross(way, otherWay);
    const double sine = glm::dot(across, across);
    if (sine < 1e-8) return std::nullopt; // they run side by side
    const glm::dvec3 between = otherFrom - from;
    const double along = glm::dot(glm::cross(between, otherWay), across) / sine;
    const double otherAlong = glm::dot(glm::cross(between, way), across) / sine;
    if (along <= 0.0 || otherAlong <= 0.0) return std::nullopt;
    const glm::dvec3 place = from + along * way;
    if (glm::distance(place, otherFrom + otherAlong * otherWay) > kMostApart) return std::nullopt;
    return place;
}

} // namespace

std::vector<MeasuredPoint> surfacePoints(std::span<const ProjectorPoint> light, const CalibratedCamera& camera,
                                         const CalibratedCamera& projector) {
    const glm::dvec3 eye = positionOf(camera), lamp = positionOf(projector);
    std::vector<MeasuredPoint> points;
    points.reserve(light.size());
    for (const ProjectorPoint& one : light) {
        const glm::dvec3 seen = directionOf(camera, {one.camera.x, one.camera.y});
        const glm::dvec3 lit = directionOf(projector, {one.projector.x, one.projector.y});
        if (const auto place = meeting(eye, seen, lamp, lit)) points.push_back({*place, 1.0});
    }
    return points;
}

} // namespace lumorph
