#include "core/loop/hand_near.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/loop/tracked_room.h"

namespace lumorph {
namespace {

constexpr float kFinger = 0.012F, kArm = 0.045F, kHand = 0.09F; ///< radii, metres
constexpr float kArmLength = 0.35F;                             ///< metres behind the body
constexpr float kLeastTip = 0.02F;                              ///< metres from tip to body that tell a direction

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

std::vector<Capsule> handShape(const Installation& installation, const Pose& tracked) {
    const glm::vec3 body(bodyInRoom(installation, tracked).position);
    const glm::vec3 tip(inRoom(installation, PoseRole::pointer, tracked).position);
    const float length = glm::distance(tip, body);
    if (length < kLeastTip) return {{body, body, kHand}};
    return {{tip, body, kFinger}, {body, body + kArmLength / length * (body - tip), kArm}};
}

} // namespace lumorph
