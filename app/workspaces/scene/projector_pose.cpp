#include "app/workspaces/scene/projector_pose.h"

#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>

namespace lumorph::studio {

namespace {

glm::dvec3 middleDirection(const CalibratedCamera& camera) {
    return directionOf(camera, 0.5 * (glm::dvec2(camera.size) - 1.0));
}

void place(CalibratedCamera& camera, const glm::dmat3& cameraFromWorld, const glm::dvec3& position) {
    camera.cameraFromWorld = glm::dmat4(cameraFromWorld);
    camera.cameraFromWorld[3] = glm::dvec4(-(cameraFromWorld * position), 1.0);
}

} // namespace

std::optional<glm::dvec2> lookPoint(const CalibratedCamera& camera) {
    const glm::dvec3 from = positionOf(camera);
    const glm::dvec3 along = middleDirection(camera);
    if (along.y > -1e-3) return std::nullopt;
    const glm::dvec3 hit = from - along * (from.y / along.y);
    return glm::dvec2(hit.x, hit.z);
}

void carryTo(CalibratedCamera& camera, const glm::dvec3& position) {
    place(camera, glm::dmat3(camera.cameraFromWorld), position);
}

void lookAt(CalibratedCamera& camera, const glm::dvec2& point) {
    const glm::dvec3 position = positionOf(camera);
    const glm::dvec3 towards = glm::dvec3(point.x, 0.0, point.y) - position;
    if (glm::length(towards) < 1e-6) return;
    const glm::dquat turn = glm::rotation(middleDirection(camera), glm::normalize(towards));
    place(camera, glm::dmat3(camera.cameraFromWorld) * glm::transpose(glm::mat3_cast(turn)), position);
}

} // namespace lumorph::studio
