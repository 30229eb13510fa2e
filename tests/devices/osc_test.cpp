#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "devices/protocol/osc_pose.h"
#include "devices/trackers/osc_bodies.h"

namespace lumorph::osc {
namespace {

using Bytes = std::vector<std::byte>;
using Kind = PosePart::Kind;

void putText(Bytes& bytes, std::string_view text) {
    for (const char c : text) bytes.push_back(std::byte(c));
    do bytes.push_back(std::byte{0});
    while (bytes.size() % 4 != 0);
}

void putNumber(Bytes& bytes, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::byte(number >> shift));
}

Bytes message(std::string_view address, std::string_view types, const std::vector<float>& floats) {
    Bytes bytes;
    putText(bytes, address);
    putText(bytes, types);
    for (const float value : floats) putNumber(bytes, std::bit_cast<std::uint32_t>(value));
    return bytes;
}

Bytes bundle(const std::vector<Bytes>& elements) {
    Bytes bytes;
    putText(bytes, "#bundle");
    putNumber(bytes, 0);
    putNumber(bytes, 1); // at once
    for (const Bytes& element : elements) {
        putNumber(bytes, static_cast<std::uint32_t>(element.size()));
        bytes.insert(bytes.end(), element.begin(), element.end());
    }
    return bytes;
}

const Bytes kPosition = message("/tracking/trackers/head/position", ",fff", {1.5F, 2.0F, -3.25F});
const Bytes kRotation = message("/tracking/trackers/head/rotation", ",fff", {10.0F, 20.0F, 30.0F});

TEST(OscPose, MessagesAndBundlesAreRead) {
    const PosePart position{"head", Kind::position, {1.5, 2.0, -3.25}};
    const PosePart rotation{"head", Kind::rotation, {10.0, 20.0, 30.0}};
    EXPECT_EQ(readPoseParts(kPosition), std::vector{position});
    EXPECT_EQ(readPoseParts(bundle({kPosition, kRotation})), (std::vector{position, rotation}));
    EXPECT_EQ(readPoseParts(bundle({kRotation, bundle({kPosition})})), (std::vector{rotation, position}));
    EXPECT_EQ(readPoseParts(bundle({})), std::vector<PosePart>{});
    EXPECT_EQ(readPoseParts(message("/tracking/trackers/left.hand-2/position", ",fff", {0, 0, 0})).at(0).body,
              "left.hand-2");
}

TEST(OscPose, OtherMessagesAreLeftOut) {
    for (const char* address : {"/", "/avatar/parameters/x", "/tracking/trackers/head/speed", "/tracking/trackers/"})
        EXPECT_TRUE(readPoseParts(message(address, ",f", {1.0F})).empty()) << address;
    EXPECT_EQ(readPoseParts(bundle({message("/other", ",", {}), kPosition})).size(), 1U);
}

TEST(OscPose, WhatIsNoPoseIsRefused) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const std::string head = "/tracking/trackers/head/position";
    const Bytes wrong[] = {
        {},
        Bytes(4),
        Bytes(16, std::byte('a')),
        message(head, ",ff", {1, 2}),
        message(head, ",fff", {1, 2}),
        message(head, ",fff", {1, 2, 3, 4}),
        message(head, ",ffff", {1, 2, 3, 4}),
        message(head, ",iii", {1, 2, 3}),
        message(head, "fff", {1, 2, 3}),
        message(head, ",fff", {1, kNan, 3}),
        message(head, ",fff", {std::numeric_limits<float>::infinity(), 2, 3}),
        message(head, ",fff", {1, 2, 1e6F}),
        message("tracking", ",fff", {1, 2, 3}),
        message("/tracking/trackers//position", ",fff", {1, 2, 3}),
        message("/tracking/trackers/a/b/position", ",fff", {1, 2, 3}),
        message("/tracking/trackers/" + std::string(65, 'n') + "/position", ",fff", {1, 2, 3}),
        bundle({bundle({bundle({bundle({bundle({kPosition})})})})}),
    };
    int number = 0;
    for (const Bytes& bytes : wrong) EXPECT_THROW((void)readPoseParts(bytes), DataError) << number++;
}

TEST(OscPose, AWrongMessageOfABundleCostsItselfAlone) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const PosePart position{"head", Kind::position, {1.5, 2.0, -3.25}};
    const PosePart rotation{"head", Kind::rotation, {10.0, 20.0, 30.0}};
    const std::pair<Bytes, std::string> wrong[] = {
        {message("/tracking/trackers/1/position", ",fff", {0, kNan, 0}),
         "'/tracking/trackers/1/position': a number in it"},
        {message("/tracking/trackers/1/rotation", ",fff", {0, 1e6F, 0}),
         "'/tracking/trackers/1/rotation': a number in it"},
        {message("/tracking/trackers/1/position", ",ff", {0, 0}), "a pose in it is not three floats"},
        {message("/tracking/trackers//position", ",fff", {0, 0, 0}), "the name of a tracker"},
        {message("noaddress", ",fff", {0, 0, 0}), "'noaddress': a message in it has no address"},
        {Bytes(8, std::byte('a')), "a text in it has no end"},
    };
    for (const auto& [bad, why] : wrong) {
        for (const Bytes& packet : {bundle({bad, kPosition, kRotation}), bundle({kPosition, bad, kRotation}),
                                    bundle({kPosition, bundle({kRotation, bad})})}) {
            std::vector<std::string> refused;
            EXPECT_EQ(readPoseParts(packet, &refused), (std::vector{position, rotation})) << why;
            ASSERT_EQ(refused.size(), 1U) << why;
            EXPECT_NE(refused.front().find(why), std::string::npos) << refused.front();
            EXPECT_EQ(readPoseParts(packet).size(), 2U);
        }
        EXPECT_THROW((void)readPoseParts(bad), DataError) << "alone it is the packet";
    }
    std::vector<std::string> refused;
    EXPECT_EQ(readPoseParts(bundle({kPosition, kRotation}), &refused).size(), 2U);
    EXPECT_TRUE(refused.empty());
}

TEST(OscPose, TheCaseOfABundleWithOneWrongMessageGivesTheOthers) {
    const std::filesystem::path file =
        std::filesystem::path(LUMORPH_SHARED_DIR) / "data/cases/trackers/osc-bundle-nan.bin";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "without ../shared/data/cases";
    std::vector<std::string> refused;
    const std::vector<PosePart> parts = readPoseParts(readFile(file, 1000), &refused);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0], (PosePart{"head", Kind::position, {0.1F, 1.6F, 0.4F}}));
    EXPECT_EQ(parts[1], (PosePart{"head", Kind::rotation, {10.0, 20.0, 5.0}}));
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_NE(refused.front().find("/tracking/trackers/1/position"), std::string::npos);
}

TEST(OscPose, EveryTruncationIsRefused) {
    for (const Bytes& whole : {kPosition, bundle({kPosition, kRotation})})
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            // A bundle may end after its head or after an element; what is left is then a whole packet.
            const bool whole1 = part.size() == 16 || part.size() == 16 + 4 + kPosition.size();
            if (whole.size() > 100 && whole1)
                EXPECT_LT(readPoseParts(part).size(), 2U);
            else
                EXPECT_THROW((void)readPoseParts(part), DataError) << size;
        }
}

TEST(OscPose, BytesThatTurnedOverDoNoHarm) {
    std::mt19937_64 random(1);
    const Bytes whole = bundle({kPosition, kRotation, bundle({kRotation})});
    int read = 0;
    for (int i = 0; i < 20'000; ++i) {
        Bytes turned = whole;
        turned[random() % turned.size()] ^= std::byte(random());
        try {
            for (const PosePart& part : readPoseParts(turned))
                for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(part.value[axis]), 3600.0);
            ++read;
        } catch (const DataError&) {
        }
    }
    EXPECT_GT(read, 1000);
}

TEST(OscPose, TheMirroredFrameOfUnityBecomesOurs) {
    EXPECT_EQ(positionOf({1, 2, 3}), glm::dvec3(1, 2, -3));
    // The oracle: turn in Unity's frame with Unity's matrices (clockwise seen from the tip of the axis towards the
    // origin, in a left-handed frame: the same numbers as the usual ones), and mirror what comes out.
    const glm::dvec3 degrees(20, 130, -40);
    const glm::dvec3 r = glm::radians(degrees);
    const auto turnX = [](glm::dvec3 v, double a) {
        return glm::dvec3(v.x, std::cos(a) * v.y - std::sin(a) * v.z, std::sin(a) * v.y + std::cos(a) * v.z);
    };
    const auto turnY = [](glm::dvec3 v, double a) {
        return glm::dvec3(std::cos(a) * v.x + std::sin(a) * v.z, v.y, -std::sin(a) * v.x + std::cos(a) * v.z);
    };
    const auto turnZ = [](glm::dvec3 v, double a) {
        return glm::dvec3(std::cos(a) * v.x - std::sin(a) * v.y, std::sin(a) * v.x + std::cos(a) * v.y, v.z);
    };
    for (const glm::dvec3 point : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0.3, -0.7, 2.0)}) {
        const glm::dvec3 theirs = turnY(turnX(turnZ(point, r.z), r.x), r.y);
        const glm::dvec3 ours = rotationOf(degrees) * positionOf(point);
        EXPECT_LT(glm::distance(ours, positionOf(theirs)), 1e-12);
    }
    // A head that turns to its right (positive in Unity, +X right, +Z ahead) looks to our +X.
    EXPECT_LT(glm::distance(rotationOf({0, 90, 0}) * glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0)), 1e-12);
}

// --- Halves put together

PosePart part(const char* body, Kind kind, double x) { return {body, kind, {x, 0, 0}}; }

TEST(OscBodies, ABodyIsToldOnceBothHalvesHaveCome) {
    OscBodies bodies;
    const auto take = [&](std::vector<PosePart> parts, int milliseconds) {
        return bodies.take(parts, Microseconds{1000 * milliseconds});
    };
    EXPECT_EQ(take({part("head", Kind::rotation, 0)}, 0), nullptr);
    EXPECT_TRUE(bodies.onlyRotations());
    const TrackerFrame* frame = take({part("head", Kind::position, 1)}, 1);
    ASSERT_NE(frame, nullptr);
    EXPECT_FALSE(bodies.onlyRotations());
    EXPECT_EQ(frame->arrived, Microseconds{1000});
    ASSERT_EQ(frame->bodies.size(), 1U);
    EXPECT_EQ(frame->bodies[0].name, "head");
    EXPECT_EQ(frame->bodies[0].pose.position, glm::dvec3(1, 0, 0));
    EXPECT_EQ(take({part("head", Kind::position, 2)}, 10), nullptr) << "its rotation is still the old one";
    EXPECT_NE(take({part("head", Kind::rotation, 90)}, 11), nullptr);
}

TEST(OscBodies, PositionsAloneAreTakenWhenNoRotationsCome) {
    OscBodies bodies;
    EXPECT_NE(bodies.take(std::vector{part("1", Kind::position, 1)}, Microseconds{0}), nullptr);
    EXPECT_NE(bodies.take(std::vector{part("1", Kind::rotation, 1), part("1", Kind::position, 1)}, Microseconds{1000}),
              nullptr);
    EXPECT_EQ(bodies.take(std::vector{part("1", Kind::position, 1)}, Microseconds{2000}), nullptr);
    EXPECT_NE(bodies.take(std::vector{part("1", Kind::position, 1)}, Microseconds{300'000}), nullptr);
}

TEST(OscBodies, NamesWithoutEndFillNoMemory) {
    OscBodies bodies;
    for (int i = 0; i < 1000; ++i) {
        const std::string name = "n" + std::to_string(i);
        const TrackerFrame* frame = bodies.take(std::vector{part(name.c_str(), Kind::position, 1)}, Microseconds{i});
        EXPECT_EQ(frame != nullptr, i < 32) << i;
    }
}

} // namespace
} // namespace lumorph::osc
