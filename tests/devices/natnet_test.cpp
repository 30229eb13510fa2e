#include "devices/protocol/natnet.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "devices/protocol/natnet_writer.h"
#include "tests/support/natnet_frames.h"

namespace lumorph::natnet {
namespace {

using ::testing::ElementsAre;

using Datagram = std::vector<std::byte>;

std::span<const std::byte> payloadOf(const Datagram& datagram, Message expected) {
    const Packet packet = readPacket(datagram);
    EXPECT_EQ(packet.message, expected);
    return packet.payload;
}

Frame frameOf(const Datagram& datagram, Version version) {
    FrameReader reader;
    return reader.read(payloadOf(datagram, Message::frame), version);
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance) {
    EXPECT_LE(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

/// Reads a packet as whatever it says it is.
void readAny(std::span<const std::byte> datagram, Version version, FrameReader& reader) {
    const Packet packet = readPacket(datagram);
    switch (packet.message) {
    case Message::connect:
        (void)readConnect(packet.payload);
        break;
    case Message::serverInfo:
        (void)readServerInfo(packet.payload);
        break;
    case Message::models:
        (void)readModels(packet.payload, version);
        break;
    case Message::frame:
        (void)reader.read(packet.payload, version);
        break;
    case Message::echoResponse:
        (void)readEcho(packet.payload);
        break;
    default:
        break;
    }
}

/// Every kind of packet of a version.
std::vector<Datagram> packetsOf(Version version) {
    NatNetWriter writer(version);
    test::RandomFrames frames(7);
    ServerInfo info{"Motive", {2, 1, 0, 0}, version, {}};
    if (version.major >= 3) info.connection = Connection{10'000'000, 1511, true, {239, 255, 42, 99}};
    return {writer.frame(frames.frame(version)), writer.frame(frames.frame(version)),
            writer.models(test::allModels(version)), writer.serverInfo(info), writer.echo(1, 2)};
}

// --- Packets of real servers

class RealNatNetPackets : public ::testing::Test {
protected:
    static std::filesystem::path folder() { return std::filesystem::path(LUMORPH_SHARED_DIR) / "data/natnet"; }
    void SetUp() override {
        if (!std::filesystem::exists(folder())) GTEST_SKIP() << "the real packets are not on this machine";
    }
    static Datagram packet(const char* name) { return readFile(folder() / name, 1 << 20); }
};

TEST_F(RealNatNetPackets, FrameOfNatNet210HoldsWhatItsCaptureTells) {
    const Frame frame = frameOf(packet("mocapframe_packet_v2.bin"), {2, 10});
    EXPECT_EQ(frame.number, 109238);
    ASSERT_EQ(frame.markerSets.size(), 3U);
    EXPECT_EQ(frame.markerSets[0].name, "RigidBody 1");
    EXPECT_EQ(frame.markerSets[0].markers.size(), 3U);
    EXPECT_EQ(frame.markerSets[1].name, "Karlie");
    EXPECT_EQ(frame.markerSets[1].markers.size(), 37U);
    EXPECT_EQ(frame.markerSets[2].name, "all");
    EXPECT_EQ(frame.markerSets[2].markers.size(), 40U);
    ASSERT_EQ(frame.bodies.size(), 1U);
    EXPECT_EQ(frame.bodies[0].id, 1);
    EXPECT_FALSE(frame.bodies[0].valid) << "a lost body that still carries its last pose";
    expectNear(frame.bodies[0].position, {1.38F, 1.21F, 1.62F}, 0.01F);
    ASSERT_EQ(frame.skeletons.size(), 1U);
    EXPECT_EQ(frame.skeletons[0].id, 4);
    std::vector<std::int32_t> bones;
    for (const RigidBody& bone : frame.skeletons[0].bodies) bones.push_back(bone.id);
    std::ranges::sort(bones); // this server does not send them in the order of their numbers
    std::vector<std::int32_t> expected(21);
    std::iota(expected.begin(), expected.end(), 262145);
    EXPECT_EQ(bones, expected);
    EXPECT_EQ(frame.labelled.size(), 44U);
    EXPECT_NEAR(frame.timestamp.value(), 910.3167, 1e-4);
    EXPECT_FALSE(frame.ticks);
}

TEST_F(RealNatNetPackets, ModelsOfNatNet210AreFiveDataSets) {
    const Datagram datagram = packet("modeldef_packet_v2.bin");
    const std::vector<Model> models = readModels(payloadOf(datagram, Message::models), {2, 10});
    std::vector<Model::Kind> kinds;
    for (const Model& model : models) kinds.push_back(model.kind);
    using Kind = Model::Kind;
    EXPECT_THAT(kinds, ::testing::UnorderedElementsAre(Kind::rigidBody, Kind::markerSet, Kind::skeleton,
                                                       Kind::markerSet, Kind::markerSet));
    const auto skeleton = std::ranges::find(models, Kind::skeleton, &Model::kind);
    ASSERT_NE(skeleton, models.end());
    EXPECT_EQ(skeleton->name, "Karlie");
    EXPECT_EQ(skeleton->id, 4);
    EXPECT_EQ(skeleton->bodies.size(), 21U);
    const auto body = std::ranges::find(models, Kind::rigidBody, &Model::kind);
    ASSERT_NE(body, models.end());
    EXPECT_EQ(body->name, "RigidBody 1");
    EXPECT_EQ(body->id, 1);
}

TEST_F(RealNatNetPackets, ServersIntroduceThemselves) {
    const Datagram three = packet("serverinfo_packet_v3.bin");
    EXPECT_EQ(three.size(), 283U);
    const ServerInfo info = readServerInfo(payloadOf(three, Message::serverInfo));
    EXPECT_EQ(info.name, "Motive") << "the garbage behind the zero is no part of the name";
    EXPECT_THAT(info.program, ElementsAre(2, 1, 0, 0));
    EXPECT_EQ(info.natnet, (Version{3, 0}));
    ASSERT_TRUE(info.connection);
    EXPECT_EQ(info.connection->clockHertz, 3'312'787U);
    EXPECT_EQ(info.connection->dataPort, 1511);
    EXPECT_TRUE(info.connection->multicast);
    EXPECT_THAT(info.connection->address, ElementsAre(239, 255, 42, 99));

    const Datagram two = packet("serverinfo_packet_v2.bin");
    const ServerInfo older = readServerInfo(payloadOf(two, Message::serverInfo));
    EXPECT_EQ(older.name, "Motive");
    EXPECT_EQ(older.program[0], 1);
    EXPECT_EQ(older.program[1], 10);
    EXPECT_EQ(older.natnet, (Version{2, 10}));
    EXPECT_FALSE(older.connection);
}

TEST_F(RealNatNetPackets, ARealClientConnects) {
    const Datagram datagram = packet("connect_packet_v2.bin");
    const ServerInfo client = readConnect(payloadOf(datagram, Message::connect));
    EXPECT_EQ(client.name, "NatNetLib");
    EXPECT_EQ(client.natnet, (Version{2, 10}));
    const Datagram ours = connectPacket("Lumorph", {0, 3, 0, 0});
    EXPECT_EQ(ours.size(), datagram.size());
    EXPECT_EQ(readConnect(payloadOf(ours, Message::connect)).name, "Lumorph");
}

TEST_F(RealNatNetPackets, FramesOfTheEarlierVersionsHoldTheirBody) {
    const Frame five = frameOf(packet("frame-motive-1.5.0-001.bin"), {2, 5});
    EXPECT_EQ(five.number, 92881);
    ASSERT_EQ(five.markerSets.size(), 2U);
    EXPECT_EQ(five.markerSets[0].name, "Rigid Body 1");
    EXPECT_EQ(five.markerSets[1].name, "all");
    EXPECT_EQ(five.otherMarkers.size(), 2U);
    ASSERT_EQ(five.bodies.size(), 1U);
    EXPECT_EQ(five.bodies[0].id, 1);
    expectNear(five.bodies[0].position, {-0.26316F, 0.03913F, 1.12352F}, 1e-5F);
    EXPECT_EQ(five.labelled.size(), 3U);
    EXPECT_FALSE(five.timestamp) << "2.5 has none";

    const Frame seven = frameOf(packet("frame-motive-1.7.2-001.bin"), {2, 7});
    EXPECT_EQ(seven.number, 411213);
    ASSERT_EQ(seven.bodies.size(), 1U);
    EXPECT_EQ(seven.bodies[0].id, 1);
    EXPECT_TRUE(seven.bodies[0].valid);
    expectNear(seven.bodies[0].position, {0.00602F, 0.09581F, -1.4076F}, 1e-5F);
    EXPECT_NEAR(seven.timestamp.value(), 3426.775, 1e-3);

    const Frame nine = frameOf(packet("frame-motive-1.9.0-001.bin"), {2, 9});
    EXPECT_EQ(nine.number, 11823217);
    EXPECT_EQ(nine.markerSets[0].name, "Triangle");
    ASSERT_EQ(nine.bodies.size(), 1U);
    EXPECT_EQ(nine.bodies[0].id, 2);
    EXPECT_TRUE(nine.bodies[0].valid);
    expectNear(nine.bodies[0].position, {0.24534F, 0.01696F, 0.22016F}, 1e-5F);
    EXPECT_NEAR(nine.bodies[0].rotation.x, 0.00192, 1e-5);
    EXPECT_NEAR(nine.bodies[0].rotation.y, -0.01607, 1e-5);
    EXPECT_NEAR(nine.bodies[0].rotation.z, -0.00029, 1e-5);
    EXPECT_NEAR(nine.bodies[0].rotation.w, -0.99987, 1e-5);
    EXPECT_NEAR(nine.bodies[0].error, 0.000116, 1e-6);
    EXPECT_NEAR(nine.timestamp.value(), 98526.808, 1e-3);
}

// --- Packets of a server of our own

TEST(NatNet, FramesOfEveryVersionComeBackAsTheyWereSent) {
    for (const Version version : test::kNatNetVersions) {
        SCOPED_TRACE(std::to_string(version.major) + "." + std::to_string(version.minor));
        NatNetWriter writer(version);
        test::RandomFrames frames(static_cast<std::uint64_t>(version.major * 100 + version.minor));
        FrameReader reader; // one for all: nothing of a frame may stay for the next
        for (int i = 0; i < 200; ++i) {
            const Frame sent = frames.frame(version);
            writer.markersInBodies = i % 4;
            const Datagram datagram = writer.frame(sent);
            ASSERT_EQ(reader.read(payloadOf(datagram, Message::frame), version), sent);
        }
    }
}

TEST(NatNet, BothEndsOfFramesThatSourcesDisagreeOnAreTaken) {
    for (const bool precise : {false, true}) {
        NatNetWriter writer({4, 1});
        writer.preciseTime = precise;
        const Frame sent = test::RandomFrames(3).frame({4, 1});
        EXPECT_EQ(frameOf(writer.frame(sent), {4, 1}), sent) << precise;
    }
    for (const Version version : {Version{2, 5}, Version{2, 6}}) {
        NatNetWriter writer(version);
        writer.earlyTime = true;
        Frame sent = test::RandomFrames(4).frame(version);
        sent.timestamp = 12.5;
        EXPECT_EQ(frameOf(writer.frame(sent), version), sent);
    }
}

// The first flag alone tells whether a body is tracked; Motive has come to set others beside it.
TEST(NatNet, OtherFlagsOfABodyDoNotTellWhetherItIsTracked) {
    for (const Version version : test::kNatNetVersions) {
        if (version < Version{2, 6}) continue;
        for (const int others : {0, 2, 4, 6, 0x100, 0x7ffe, -2}) {
            NatNetWriter writer(version);
            writer.bodyParams = static_cast<std::int16_t>(others);
            Frame sent = test::RandomFrames(9).frame(version);
            sent.bodies.resize(2);
            sent.bodies[0].valid = true;
            sent.bodies[1].valid = false;
            const Frame read = frameOf(writer.frame(sent), version);
            ASSERT_EQ(read.bodies.size(), 2U);
            EXPECT_TRUE(read.bodies[0].valid) << others;
            EXPECT_FALSE(read.bodies[1].valid) << others;
        }
    }
}

TEST(NatNet, FlagsOfAFrameAreReadBitByBit) {
    const Version version{3, 1};
    NatNetWriter writer(version);
    for (const auto& [params, changed] :
         {std::pair{0, false}, {1, false}, {2, true}, {3, true}, {4, false}, {-3, false}}) {
        Frame sent = test::RandomFrames(2).frame(version);
        sent.params = static_cast<std::int16_t>(params);
        EXPECT_EQ(frameOf(writer.frame(sent), version).modelsChanged(), changed) << params;
    }
}

// The time by the network's clock came with 4.1: the same eight bytes in an older frame are a broken frame.
TEST(NatNet, PreciseTimeIsOfVersion41Alone) {
    for (const Version version : test::kNatNetVersions) {
        NatNetWriter writer(version);
        writer.preciseTime = false;
        Datagram longer = writer.frame(test::RandomFrames(6).frame(version));
        const std::ptrdiff_t end = version >= Version{2, 6} ? 6 : 4; // flags and the end's mark
        longer.insert(longer.end() - end, 8, std::byte{0x11});
        const auto size = static_cast<std::uint16_t>(longer.size() - 4);
        std::memcpy(longer.data() + 2, &size, sizeof size);
        if (version >= Version{4, 1})
            EXPECT_NO_THROW((void)frameOf(longer, version));
        else
            EXPECT_THROW((void)frameOf(longer, version), DataError) << version.major << "." << version.minor;
    }
}

TEST(NatNet, ModelsOfEveryVersionComeBackAsTheyWereSent) {
    for (const Version version : test::kNatNetVersions) {
        const std::vector<Model> sent = test::allModels(version);
        EXPECT_EQ(readModels(payloadOf(NatNetWriter(version).models(sent), Message::models), version), sent)
            << version.major << "." << version.minor;
    }
}

TEST(NatNet, UnknownKindsAreLeftOutWhereTheirSizeIsTold) {
    const Model body = test::allModels({4, 1})[1];
    NatNetWriter writer({4, 1});
    writer.moreBytes = 16; // what newer versions say in addition
    const Datagram datagram = writer.modelsWithUnknown(body);
    EXPECT_EQ(readModels(payloadOf(datagram, Message::models), {4, 1}), std::vector<Model>{body});
    const Datagram older = NatNetWriter({4, 0}).modelsWithUnknown(body);
    EXPECT_THROW((void)readModels(payloadOf(older, Message::models), {4, 0}), DataError);
}

TEST(NatNet, ServersTellTheirClockSince30) {
    const ServerInfo older{"Motive", {1, 10, 0, 0}, {2, 10}, {}};
    const ServerInfo newer{"Motive", {3, 1, 0, 0}, {4, 1}, Connection{10'000'000, 1600, false, {1, 2, 3, 4}}};
    for (const ServerInfo& sent : {older, newer})
        EXPECT_EQ(readServerInfo(payloadOf(NatNetWriter(sent.natnet).serverInfo(sent), Message::serverInfo)), sent);
}

TEST(NatNet, AClientSaysWhatTheProtocolAsksFor) {
    EXPECT_EQ(keepAlivePacket(), (Datagram{std::byte{10}, std::byte{0}, std::byte{0}, std::byte{0}}));
    EXPECT_EQ(modelsRequestPacket(), (Datagram{std::byte{4}, std::byte{0}, std::byte{0}, std::byte{0}}));
    const Datagram echo = echoPacket(0x0102030405060708);
    ASSERT_EQ(echo.size(), 12U);
    EXPECT_EQ(echo[0], std::byte{12});
    EXPECT_EQ(echo[2], std::byte{8});
    EXPECT_EQ(echo[4], std::byte{8});
    EXPECT_EQ(echo[11], std::byte{1});
    const Datagram connect = connectPacket(std::string(300, 'n'), {1, 2, 3, 4});
    ASSERT_EQ(connect.size(), 268U);
    EXPECT_EQ(connect[2], std::byte{0x08}); // 264
    EXPECT_EQ(connect[3], std::byte{0x01});
    EXPECT_EQ(connect[4 + 255], std::byte{0}) << "a name that is too long is cut and still ends";
    EXPECT_EQ(connect[4 + 256], std::byte{1});
}

TEST(NatNet, EveryTruncationIsRefused) {
    for (const Version version : test::kNatNetVersions)
        for (const Datagram& whole : packetsOf(version)) {
            FrameReader reader;
            ASSERT_NO_THROW(readAny(whole, version, reader));
            for (std::size_t size = 0; size < whole.size(); ++size) {
                // Of its own memory, so that a step too far is seen by the sanitizers.
                Datagram part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
                EXPECT_THROW(readAny(part, version, reader), DataError) << size;
                if (size < 4) continue;
                // As if the sender had meant it so.
                const auto told = static_cast<std::uint16_t>(size - 4);
                std::memcpy(part.data() + 2, &told, sizeof told);
                EXPECT_THROW(readAny(part, version, reader), DataError) << size;
            }
        }
}

TEST(NatNet, BytesThatTurnedOverDoNoHarm) {
    std::mt19937_64 random(1);
    for (const Version version : test::kNatNetVersions)
        for (const Datagram& whole : packetsOf(version)) {
            FrameReader reader;
            int refused = 0;
            for (int i = 0; i < 2000; ++i) {
                Datagram turned = whole;
                for (int flips = 1 + i % 4; flips > 0; --flips) turned[random() % turned.size()] ^= std::byte(random());
                try {
                    readAny(turned, version, reader);
                } catch (const DataError&) {
                    ++refused;
                }
            }
            EXPECT_LT(refused, 2000) << "nothing at all was read";
        }
}

TEST(NatNet, AFrameThatIsRefusedLeavesTheOneBefore) {
    const Version version{3, 1};
    NatNetWriter writer(version);
    test::RandomFrames frames(5);
    const Frame sent = frames.frame(version);
    const Datagram good = writer.frame(sent);
    FrameReader reader;
    (void)reader.read(payloadOf(good, Message::frame), version);
    const Datagram next = writer.frame(frames.frame(version));
    EXPECT_THROW((void)reader.read(std::span(next).subspan(4, next.size() - 5), version), DataError);
    EXPECT_EQ(reader.frame(), sent);
}

TEST(NatNet, CountsThatCannotBeAreRefusedBeforeMemoryIsAskedFor) {
    for (const std::int32_t count : {-1, 0x7fffffff, 1'000'000}) {
        std::array<std::byte, 64> payload{};
        std::memcpy(payload.data() + 4, &count, sizeof count);
        FrameReader reader;
        EXPECT_THROW((void)reader.read(payload, {2, 10}), DataError) << count;
        EXPECT_THROW((void)readModels(std::span(payload).subspan(4), {2, 10}), DataError) << count;
    }
}

TEST(NatNet, VersionsBefore25AreRefused) {
    FrameReader reader;
    const Datagram datagram = NatNetWriter({2, 5}).frame(test::RandomFrames(1).frame({2, 5}));
    EXPECT_THROW((void)reader.read(payloadOf(datagram, Message::frame), {2, 0}), DataError);
}

} // namespace
} // namespace lumorph::natnet
