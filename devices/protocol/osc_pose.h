#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace lumorph::osc {

/// Half a pose, as phones and SteamVR bridges send it over OSC: `/tracking/trackers/NAME/position` or `/rotation`,
/// three floats each.
struct PosePart {
    enum class Kind { position, rotation };
    std::string body; ///< NAME: "head", "1"; 1 to 64 printable characters
    Kind kind = Kind::position;
    glm::dvec3 value{0.0}; ///< as sent: metres, or degrees
    bool operator==(const PosePart&) const = default;
};

/// All parts in a packet, which is a message or a bundle of them, in their order. Sound messages about other things are
/// left out. Throws DataError for what is no OSC, a wrong number or kind of arguments, and numbers that are not finite
/// or out of range (1000 m, ten turns). A message of a bundle that is wrong in itself costs itself alone: it is left
/// out, and `refused` gets a sentence for it.
[[nodiscard]] std::vector<PosePart> readPoseParts(std::span<const std::byte> datagram,
                                                  std::vector<std::string>* refused = nullptr);

/// Senders follow VRChat, hence Unity: a left-handed frame, +X right, +Y up, +Z forward. Ours is right-handed with +Z
/// backward, so that Z changes its sign.
[[nodiscard]] glm::dvec3 positionOf(const glm::dvec3& sent);
/// Angles about X, Y and Z in Unity's order: Z first, then X, then Y, all about the axes of the room.
[[nodiscard]] glm::dquat rotationOf(const glm::dvec3& degrees);

} // namespace lumorph::osc
