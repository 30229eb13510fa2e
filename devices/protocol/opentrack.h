#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "core/loop/pose_stream.h"

namespace lumorph::opentrack {

inline constexpr std::size_t kPacketBytes = 48;

/// What opentrack's output "UDP over network" sends: six doubles, little endian. Programs that stand for it send them
/// big endian, as networks do; these are read too.
struct Packet {
    glm::dvec3 centimetres{0.0};
    double yawDegrees = 0.0;
    double pitchDegrees = 0.0;
    double rollDegrees = 0.0;
    bool operator==(const Packet&) const = default;
};

/// Throws DataError for any other size, and for numbers that are not finite or as large as no head's are (100 m, ten
/// turns), whichever of their bytes comes first.
[[nodiscard]] Packet readPacket(std::span<const std::byte> datagram);

/// In a right-handed frame as seen by one who looks at the screen: +X right, +Y up, +Z out of the screen to the viewer.
/// Yaw turns about +Y (positive to the left), then pitch about the head's own +X (positive up), then roll about its own
/// +Z (positive: the head tilts to its left shoulder). Opentrack lets its user invert each axis; that is where to put
/// right what comes out mirrored.
[[nodiscard]] Pose poseOf(const Packet& packet);

} // namespace lumorph::opentrack
