#include "devices/protocol/opentrack.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph::opentrack {
namespace {

std::vector<std::byte> packetOf(const std::array<double, 6>& numbers) {
    std::vector<std::byte> bytes(kPacketBytes);
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(OpenTrack, SixLittleEndianDoublesAreCentimetresAndDegrees) {
    std::vector<std::byte> bytes(kPacketBytes);
    // 1.0 is 3F F0 00.., -2.0 is C0 00 00..: the last bytes of a little-endian number come last.
    bytes[6] = std::byte{0xF0};
    bytes[7] = std::byte{0x3F};
    bytes[24 + 7] = std::byte{0xC0};
    const Packet packet = readPacket(bytes);
    EXPECT_EQ(packet, (Packet{{1.0, 0.0, 0.0}, -2.0, 0.0, 0.0}));
    EXPECT_EQ(readPacket(packetOf({1, 2, 3, 4, 5, 6})), (Packet{{1, 2, 3}, 4, 5, 6}));
}

TEST(OpenTrack, OtherSizesAreRefused) {
    for (const std::size_t size : {0U, 1U, 47U, 49U, 56U, 1500U})
        EXPECT_THROW((void)readPacket(std::vector<std::byte>(size)), DataError) << size;
}

std::vector<std::byte> turnedOver(std::vector<std::byte> bytes) {
    for (auto at = bytes.begin(); at != bytes.end(); at += 8) std::reverse(at, at + 8);
    return bytes;
}

TEST(OpenTrack, BigEndianDoublesAreReadAsThat) {
    const std::array<double, 6> numbers[] = {{12, -10, 6, 5, 57, 12},
                                             {12.345, -0.001, 61.7, -179.999, 3.14159, 0.25},
                                             {0, 0, 0, 0, 0, 1},
                                             {1, 2, 3, 4, 5, 6}};
    for (const auto& n : numbers) {
        const Packet expected{{n[0], n[1], n[2]}, n[3], n[4], n[5]};
        EXPECT_EQ(readPacket(turnedOver(packetOf(n))), expected);
        EXPECT_EQ(readPacket(packetOf(n)), expected);
    }
    // What a filter leaves that comes to rest is small, and no sign of the other order.
    const std::array<double, 6> resting = {1e-17, -3e-20, 2.5, 1e-90, 0, -1e-30};
    EXPECT_EQ(readPacket(packetOf(resting)), (Packet{{1e-17, -3e-20, 2.5}, 1e-90, 0, -1e-30}));
    EXPECT_EQ(readPacket(std::vector<std::byte>(kPacketBytes)), Packet{});
}

TEST(OpenTrack, TheCaseOfBigEndianIsNoHeadAtTheOrigin) {
    const std::filesystem::path file = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/cases/trackers/ot-be.bin";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "without ../shared/data/cases";
    EXPECT_EQ(readPacket(readFile(file, 1000)), (Packet{{12, -10, 6}, 5, 57, 12}));
}

TEST(OpenTrack, NumbersThatAreNoneAreRefused) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 6; ++i)
        for (const double wrong : {kNan, kInfinity, -kInfinity, 1e300, -20'000.0}) {
            std::array<double, 6> numbers{};
            numbers[i] = wrong;
            EXPECT_THROW((void)readPacket(packetOf(numbers)), DataError) << i << " " << wrong;
        }
}

TEST(OpenTrack, TurnsGoAsTheHeaderSays) {
    const glm::dvec3 ahead(0, 0, -1), up(0, 1, 0);
    expectNear(poseOf({{10, -20, 50}, 0, 0, 0}).position, {0.1, -0.2, 0.5});
    EXPECT_EQ(poseOf({}).rotation, glm::dquat(1, 0, 0, 0));
    expectNear(poseOf({{}, 90, 0, 0}).rotation * ahead, {-1, 0, 0}); // looks left
    expectNear(poseOf({{}, 0, 90, 0}).rotation * ahead, {0, 1, 0});  // looks up
    expectNear(poseOf({{}, 0, 0, 90}).rotation * up, {-1, 0, 0});    // leans left
    // Left first, then up about the turned axis: up stays up. The other order would look left with its face to the sky.
    expectNear(poseOf({{}, 90, 90, 0}).rotation * ahead, {0, 1, 0});
    expectNear(poseOf({{}, 90, 0, 90}).rotation * up, {0, 0, 1});
}

} // namespace
} // namespace lumorph::opentrack
