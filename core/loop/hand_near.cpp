#include "core/loop/hand_near.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/loop/tracked_room.h"

namespace lumorph {
namespace {

constexpr float kFinger = 0.012F, kPalm = 0.05F, kArm = 0.045F, kHand = 0.09F; ///< radii, metres
constexpr float kHalfPalm = 0.05F, kWrist = 0.09F, kArmLength = 0.35F;         ///< metres along the hand
constexpr float kArmRises = 0.3F;                                              ///< metres a metre
constexpr float kLeastTip = 0.02F; ///< metres from tip to body that tell a direction

} // namespace

std::optional<double> handDistance(const PoseBoard& board, const Box& box, const glm::mat4& worldFromDevice,
                                   Microseconds now, const Installation& installation) {
    if (box.empty()) return std::nullopt;
    const glm::dmat3 deviceFromWorld = glm::transpose(glm::dmat3(worldFromDevice));
    const glm::dvec3 place(worldFromDevice[3]);
    std::optional<double> nearest;
    const auto look = [&](const Pose& pose) {
        const glm::dvec3 at = deviceFromWorld * (pose.position - place);
        const double distance = glm::distance(at, glm::clamp(at, glm::dvec3(box.min), glm::dvec3(box.max)));
        nearest = nearest ? std::min(*nearest, distance) : distance;
    };
    for (const PoseBoard::Entry& entry : board.entries()) {
        if (entry.role != PoseRole::pointer) continue;
        const std::optional<Pose> hand = entry.stream->at(now, now);
        if (!hand) continue;
        look(bodyInRoom(installation, *hand));
        look(inRoom(installation, entry.role, *hand));
    }
    return nearest;
}

std::vector<Capsule> handAt(const glm::vec3& place, const std::optional<glm::vec3>& eye) {
    const glm::vec3 away = eye ? glm::vec3(eye->x - place.x, 0.0F, eye->z - place.z) : glm::vec3(0.0F);
    if (glm::length(away) < kLeastTip) return {{place, place, kHand}};
    const glm::vec3 way = glm::normalize(away);
    const glm::vec3 arm = glm::normalize(way + glm::vec3(0.0F, kArmRises, 0.0F));
    const glm::vec3 wrist = place + kWrist * way;
    return {{place - kHalfPalm * way, place + kHalfPalm * way, kPalm}, {wrist, wrist + kArmLength * arm, kArm}};
}

std::vector<Capsule> handShape(const Installation& installation, const Pose& tracked,
                               const std::optional<glm::vec3>& eye) {
    const glm::vec3 body(bodyInRoom(installation, tracked).position);
    const glm::vec3 tip(inRoom(installation, PoseRole::pointer, tracked).position);
    const float length = glm::distance(tip, body);
    if (length < kLeastTip) return handAt(body, eye);
    return {{tip, body, kFinger}, {body, body + kArmLength / length * (body - tip), kArm}};
}

} // namespace lumorph
