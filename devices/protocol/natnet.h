#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "devices/protocol/reused.h"

/// NatNet, the language of OptiTrack's Motive: pure readers and writers of single packets, versions 2.5 to 4.1, little
/// endian. Readers throw DataError for a packet that is not what it says; nothing in a packet is trusted.
namespace lumorph::natnet {

struct Version {
    int major = 0;
    int minor = 0;
    auto operator<=>(const Version&) const = default;
};

enum class Message : std::uint16_t {
    connect = 0,
    serverInfo = 1,
    request = 2,
    response = 3,
    requestModels = 4,
    models = 5,
    frame = 7,
    keepAlive = 10,
    echoRequest = 12,
    echoResponse = 13,
    discovery = 14,
    unrecognised = 100
};

struct Packet {
    Message message = Message::unrecognised; ///< may be a number that has no name here
    std::span<const std::byte> payload;
};

/// Splits a datagram; its payload must be there whole.
[[nodiscard]] Packet readPacket(std::span<const std::byte> datagram);

/// How the server sends, told by 3.0 and later.
struct Connection {
    std::uint64_t clockHertz = 0;
    std::uint16_t dataPort = 0;
    bool multicast = false;
    std::array<std::uint8_t, 4> address{};
    bool operator==(const Connection&) const = default;
};

struct ServerInfo {
    std::string name; ///< "Motive"
    std::array<std::uint8_t, 4> program{};
    Version natnet;
    std::optional<Connection> connection;
    bool operator==(const ServerInfo&) const = default;
};

[[nodiscard]] ServerInfo readServerInfo(std::span<const std::byte> payload);
/// The same form without its end: who asks.
[[nodiscard]] ServerInfo readConnect(std::span<const std::byte> payload);

struct Echo {
    std::uint64_t sent = 0;     ///< the number that was sent, as it was
    std::uint64_t received = 0; ///< ticks of the server's clock
};
[[nodiscard]] Echo readEcho(std::span<const std::byte> payload);

// --- What a frame holds

struct MarkerSet {
    std::string name;
    std::vector<glm::vec3> markers;
    bool operator==(const MarkerSet&) const = default;
};

struct RigidBody {
    std::int32_t id = 0;
    glm::vec3 position{0.0F}; ///< metres; stale while not valid, and not always finite
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    float error = 0.0F;
    bool valid = true; ///< told since 2.6
    bool operator==(const RigidBody&) const = default;
};

struct LabelledMarker {
    std::int32_t id = 0;
    glm::vec3 position{0.0F};
    float size = 0.0F;
    std::int16_t params = 0;
    float residual = 0.0F;
    bool operator==(const LabelledMarker&) const = default;
};

/// A skeleton, or an asset with its markers.
struct Assembly {
    std::int32_t id = 0;
    std::vector<RigidBody> bodies;
    std::vector<LabelledMarker> markers;
    bool operator==(const Assembly&) const = default;
};

/// A force plate or another analog device.
struct Analog {
    std::int32_t id = 0;
    Reused<std::vector<float>> channels;
    bool operator==(const Analog&) const = default;
};

struct Frame {
    std::int32_t number = 0;
    Reused<MarkerSet> markerSets;
    std::vector<glm::vec3> otherMarkers;
    std::vector<RigidBody> bodies;
    Reused<Assembly> skeletons;
    Reused<Assembly> assets;
    std::vector<LabelledMarker> labelled;
    Reused<Analog> plates;
    Reused<Analog> devices;
    std::optional<float> latency; ///< before 3.0, seconds; real servers put the time of the frame here
    std::array<std::uint32_t, 2> timecode{};
    std::optional<double> timestamp; ///< seconds since the server started
    struct Ticks {
        std::uint64_t exposure = 0;
        std::uint64_t received = 0;
        std::uint64_t sent = 0;
        bool operator==(const Ticks&) const = default;
    };
    std::optional<Ticks> ticks; ///< of the server's clock, since 3.0
    std::int16_t params = 0;
    bool operator==(const Frame&) const = default;

    [[nodiscard]] bool modelsChanged() const noexcept { return (params & 2) != 0; }
};

/// Reads frames one after the other into the same memory: once it has seen a frame's like twice, it allocates nothing.
class FrameReader {
public:
    /// The frame lives until the next call. Throws DataError; then the frame of before stays. Versions above 4.1 are
    /// read as that.
    const Frame& read(std::span<const std::byte> payload, Version version);
    [[nodiscard]] const Frame& frame() const noexcept { return frame_; }

private:
    Frame frame_;
    Frame next_;
};

// --- What the ids in frames are called

struct Model {
    enum class Kind { markerSet, rigidBody, skeleton, plate, device, camera, asset };
    struct Body {
        std::string name;
        std::int32_t id = 0;
        std::int32_t parent = 0;
        glm::vec3 offset{0.0F};
        bool operator==(const Body&) const = default;
    };
    Kind kind = Kind::rigidBody;
    std::string name;
    std::int32_t id = 0;              ///< of a skeleton, an asset, a plate or a device
    std::vector<Body> bodies;         ///< one of a rigid body, the bones of a skeleton or an asset
    std::vector<std::string> markers; ///< of a marker set, an asset, a rigid body since 4.0
    bool operator==(const Model&) const = default;
};

/// Kinds that are unknown are left out since 4.1, where their size is told; before that they are a DataError.
[[nodiscard]] std::vector<Model> readModels(std::span<const std::byte> payload, Version version);

// --- What a client says

[[nodiscard]] std::vector<std::byte> connectPacket(std::string_view name, std::array<std::uint8_t, 4> program);
[[nodiscard]] std::vector<std::byte> keepAlivePacket();
[[nodiscard]] std::vector<std::byte> modelsRequestPacket();
[[nodiscard]] std::vector<std::byte> echoPacket(std::uint64_t number);

} // namespace lumorph::natnet
