#include "devices/protocol/opentrack.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include <glm/trigonometric.hpp>

#include "core/base/error.h"

namespace lumorph::opentrack {

namespace {

constexpr double kFarthestCentimetres = 1e4;
constexpr double kMostDegrees = 3600.0;
constexpr const char* kRemedy = "set opentrack's output to 'UDP over network'";

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "opentrack is read as it lies in memory");

glm::dquat about(const glm::dvec3& axis, double degrees) { return glm::angleAxis(glm::radians(degrees), axis); }

} // namespace

Packet readPacket(std::span<const std::byte> datagram) {
    if (datagram.size() != kPacketBytes)
        throw DataError("opentrack packet", "it has " + std::to_string(datagram.size()) + " bytes instead of 48",
                        kRemedy);
    std::array<double, 6> v{};
    std::memcpy(v.data(), datagram.data(), kPacketBytes);
    for (std::size_t i = 0; i < v.size(); ++i)
        // Written so that NaN fails as well.
        if (!(std::abs(v[i]) <= (i < 3 ? kFarthestCentimetres : kMostDegrees)))
            throw DataError("opentrack packet", "number " + std::to_string(i + 1) + " of it is out of range", kRemedy);
    return {{v[0], v[1], v[2]}, v[3], v[4], v[5]};
}

Pose poseOf(const Packet& packet) {
    return {0.01 * packet.centimetres, about({0, 1, 0}, packet.yawDegrees) * about({1, 0, 0}, packet.pitchDegrees) *
                                           about({0, 0, 1}, packet.rollDegrees)};
}

} // namespace lumorph::opentrack
