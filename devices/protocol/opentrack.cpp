#include "devices/protocol/opentrack.h"

#include <array>
#include <bit>
#include <cmath>
#include <string>

#include <glm/trigonometric.hpp>

#include "core/base/error.h"
#include "core/geometry/binary_reader.h"

namespace lumorph::opentrack {

namespace {

constexpr double kFarthestCentimetres = 1e4;
constexpr double kMostDegrees = 3600.0;
constexpr const char* kRemedy = "set opentrack's output to 'UDP over network'";

using Numbers = std::array<double, 6>;

/// Numbers that are nearly zero, but not zero: those of another byte order look so. No head's are.
constexpr double kNoNumber = 1e-100; ///< a filter that comes to rest leaves less than nothing
constexpr double kSmallest = 1e-9;

Numbers numbersOf(std::span<const std::byte> datagram, std::endian order) {
    Numbers numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = readNumber<double>(datagram.subspan(i * sizeof(double)), order);
    return numbers;
}

bool isInRange(const Numbers& v, std::size_t i) {
    // Written so that NaN fails as well.
    return std::abs(v[i]) <= (i < 3 ? kFarthestCentimetres : kMostDegrees);
}

/// All in range, and none nearer to zero than `least` without being zero.
bool isPose(const Numbers& v, double least) {
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!isInRange(v, i) || (v[i] != 0.0 && std::abs(v[i]) < least)) return false;
    return true;
}

glm::dquat about(const glm::dvec3& axis, double degrees) { return glm::angleAxis(glm::radians(degrees), axis); }

} // namespace

Packet readPacket(std::span<const std::byte> datagram) {
    if (datagram.size() != kPacketBytes)
        throw DataError("opentrack packet", "it has " + std::to_string(datagram.size()) + " bytes instead of 48",
                        kRemedy);
    Numbers v = numbersOf(datagram, std::endian::little);
    if (const Numbers other = numbersOf(datagram, std::endian::big); !isPose(v, kNoNumber) && isPose(other, kSmallest))
        v = other;
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!isInRange(v, i))
            throw DataError("opentrack packet", "number " + std::to_string(i + 1) + " of it is out of range", kRemedy);
    return {{v[0], v[1], v[2]}, v[3], v[4], v[5]};
}

Pose poseOf(const Packet& packet) {
    return {0.01 * packet.centimetres, about({0, 1, 0}, packet.yawDegrees) * about({1, 0, 0}, packet.pitchDegrees) *
                                           about({0, 0, 1}, packet.rollDegrees)};
}

} // namespace lumorph::opentrack
