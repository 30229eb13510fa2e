#include "core/loop/tracked_room.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace lumorph {
namespace {

const glm::mat4 kNowhereElse(1.0F);

glm::dquat turnOf(const glm::mat4& rigid) { return glm::normalize(glm::quat_cast(glm::dmat3(glm::mat3(rigid)))); }

} // namespace

Pose bodyInRoom(const Installation& installation, const Pose& tracked) {
    const glm::mat4& world = installation.worldFromTracker;
    if (world == kNowhereElse) return tracked;
    const glm::dquat turn = turnOf(world);
    return {turn * tracked.position + glm::dvec3(world[3]), turn * tracked.rotation};
}

Pose inRoom(const Installation& installation, PoseRole role, const Pose& tracked) {
    Pose pose = bodyInRoom(installation, tracked);
    if (role == PoseRole::device && installation.bodyFromDevice != kNowhereElse) {
        pose.position += pose.rotation * glm::dvec3(installation.bodyFromDevice[3]);
        pose.rotation = pose.rotation * turnOf(installation.bodyFromDevice);
    }
    if (role == PoseRole::pointer && installation.pointerTip != glm::vec3(0.0F))
        pose.position += pose.rotation * glm::dvec3(installation.pointerTip);
    return pose;
}

Pose trackedOf(const Installation& installation, PoseRole role, const Pose& stands) {
    Pose body = stands;
    if (role == PoseRole::device && installation.bodyFromDevice != kNowhereElse) {
        body.rotation = body.rotation * glm::conjugate(turnOf(installation.bodyFromDevice));
        body.position -= body.rotation * glm::dvec3(installation.bodyFromDevice[3]);
    }
    const glm::vec3 beside = role == PoseRole::pointer ? installation.pointerTip
                             : role == PoseRole::head  ? installation.eyeFromHead
                                                       : glm::vec3(0.0F);
    if (beside != glm::vec3(0.0F)) body.position -= body.rotation * glm::dvec3(beside);
    const glm::mat4& world = installation.worldFromTracker;
    if (world == kNowhereElse) return body;
    const glm::dquat back = glm::conjugate(turnOf(world));
    return {back * (body.position - glm::dvec3(world[3])), back * body.rotation};
}

} // namespace lumorph
