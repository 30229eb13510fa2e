#include <utility>

#include "devices/protocol/natnet.h"
#include "devices/protocol/natnet_bytes.h"

namespace lumorph::natnet {

namespace {

constexpr Version kParams{2, 6};
constexpr Version kDoubleTime{2, 7};
constexpr Version kPlates{2, 9};
constexpr Version kDevices{2, 11};
constexpr Version kLean{3, 0}; ///< markers of bodies moved to the models, clock ticks came
constexpr Version kSized{4, 1};

constexpr std::size_t kLeastBody = 4 + 12 + 16 + 4;
constexpr std::size_t kLeastLabelled = 4 + 12 + 4;
constexpr std::size_t kEndBytes = 4;
constexpr std::size_t kParamsBytes = 2;
constexpr std::size_t kPreciseTimeBytes = 8;

class Walk {
public:
    Walk(std::span<const std::byte> payload, Version version, Frame& frame)
        : bytes_(payload), version_(version), frame_(frame) {}

    void whole() {
        frame_.number = bytes_.take<std::int32_t>();
        markers();
        section(kLeastBody, [this](Bytes& in, std::size_t n) { bodies(in, n, frame_.bodies); });
        skeletons();
        assets();
        frame_.labelled.clear();
        section(kLeastLabelled, [this](Bytes& in, std::size_t n) { labelled(in, n, frame_.labelled); });
        analogs(kPlates, frame_.plates);
        analogs(kDevices, frame_.devices);
        suffix();
    }

private:
    /// A count and what it counts; since 4.1 the size in bytes stands between them, and must be right.
    template <typename Read> void section(std::size_t leastBytes, Read read) {
        if (version_ < kSized) {
            const std::size_t n = bytes_.count(leastBytes);
            read(bytes_, n);
            return;
        }
        const auto n = bytes_.take<std::int32_t>();
        const auto size = bytes_.take<std::uint32_t>();
        Bytes part(bytes_.skip(size));
        if (n < 0 || static_cast<std::size_t>(n) > size / leastBytes)
            refusePacket("a part of it tells of " + std::to_string(n) + " things and has no room for them");
        read(part, static_cast<std::size_t>(n));
        part.expectEnd("a part of it");
    }

    static void points(Bytes& in, std::size_t n, std::vector<glm::vec3>& points) {
        points.clear();
        for (std::size_t i = 0; i < n; ++i) points.push_back(in.vector());
    }

    void markers() {
        frame_.markerSets.clear();
        section(1 + 4, [this](Bytes& in, std::size_t n) {
            for (std::size_t i = 0; i < n; ++i) {
                MarkerSet& set = frame_.markerSets.next();
                set.name = in.text();
                points(in, in.count(kVectorBytes), set.markers);
            }
        });
        section(kVectorBytes, [this](Bytes& in, std::size_t n) { points(in, n, frame_.otherMarkers); });
    }

    RigidBody body(Bytes& in) const {
        RigidBody body;
        body.id = in.take<std::int32_t>();
        body.position = in.vector();
        body.rotation = in.quaternion();
        // Place, id and size of each of its markers: nobody asks for them.
        if (version_ < kLean) in.skip(in.count(kVectorBytes + 4 + 4) * (kVectorBytes + 4 + 4));
        body.error = in.take<float>();
        if (version_ >= kParams) body.valid = (in.take<std::int16_t>() & 1) != 0;
        return body;
    }

    void bodies(Bytes& in, std::size_t n, std::vector<RigidBody>& bodies) const {
        bodies.clear();
        for (std::size_t i = 0; i < n; ++i) bodies.push_back(body(in));
    }

    void labelled(Bytes& in, std::size_t n, std::vector<LabelledMarker>& markers) const {
        markers.clear();
        for (std::size_t i = 0; i < n; ++i) {
            LabelledMarker marker;
            marker.id = in.take<std::int32_t>();
            marker.position = in.vector();
            marker.size = in.take<float>();
            if (version_ >= kParams) marker.params = in.take<std::int16_t>();
            if (version_ >= kLean) marker.residual = in.take<float>();
            markers.push_back(marker);
        }
    }

    void skeletons() {
        frame_.skeletons.clear();
        section(4 + 4, [this](Bytes& in, std::size_t n) {
            for (std::size_t i = 0; i < n; ++i) {
                Assembly& skeleton = frame_.skeletons.next();
                skeleton.id = in.take<std::int32_t>();
                bodies(in, in.count(kLeastBody), skeleton.bodies);
                skeleton.markers.clear();
            }
        });
    }

    void assets() {
        frame_.assets.clear();
        if (version_ < kSized) return;
        section(4 + 4 + 4, [this](Bytes& in, std::size_t n) {
            for (std::size_t i = 0; i < n; ++i) {
                Assembly& asset = frame_.assets.next();
                asset.id = in.take<std::int32_t>();
                bodies(in, in.count(kLeastBody), asset.bodies);
                labelled(in, in.count(kLeastLabelled), asset.markers);
            }
        });
    }

    void analogs(Version since, Reused<Analog>& analogs) {
        analogs.clear();
        if (version_ < since) return;
        section(4 + 4, [&analogs](Bytes& in, std::size_t n) {
            for (std::size_t i = 0; i < n; ++i) {
                Analog& analog = analogs.next();
                analog.id = in.take<std::int32_t>();
                analog.channels.clear();
                for (std::size_t channels = in.count(4); channels > 0; --channels) {
                    std::vector<float>& values = analog.channels.next();
                    values.clear();
                    for (std::size_t left = in.count(4); left > 0; --left) values.push_back(in.take<float>());
                }
            }
        });
    }

    /// Before 2.7 servers disagree on what stands between the time code and the end: a time, as float, or none; flags
    /// or none. What is left over tells.
    void earlyTime(bool& hasParams) {
        const std::size_t left = bytes_.left();
        hasParams = left % 4 == kParamsBytes;
        const std::size_t rest = left - std::min(left, kEndBytes + (hasParams ? kParamsBytes : 0));
        if (rest == sizeof(float)) frame_.timestamp = bytes_.take<float>();
    }

    void suffix() {
        frame_.latency.reset();
        frame_.timestamp.reset();
        frame_.ticks.reset();
        frame_.params = 0;
        bool hasParams = true;
        if (version_ < kLean) frame_.latency = bytes_.take<float>();
        for (std::uint32_t& part : frame_.timecode) part = bytes_.take<std::uint32_t>();
        if (version_ >= kDoubleTime)
            frame_.timestamp = bytes_.take<double>();
        else
            earlyTime(hasParams);
        if (version_ >= kLean) {
            Frame::Ticks ticks;
            ticks.exposure = bytes_.take<std::uint64_t>();
            ticks.received = bytes_.take<std::uint64_t>();
            ticks.sent = bytes_.take<std::uint64_t>();
            frame_.ticks = ticks;
        }
        // Sources disagree whether 4.1 has a time by the network's clock here.
        if (version_ >= kSized && bytes_.left() == kPreciseTimeBytes + kParamsBytes + kEndBytes)
            bytes_.skip(kPreciseTimeBytes);
        if (hasParams) frame_.params = bytes_.take<std::int16_t>();
        if (bytes_.take<std::uint32_t>() != 0) refusePacket("it does not end as a frame does");
        bytes_.expectEnd("it");
    }

    Bytes bytes_;
    Version version_;
    Frame& frame_;
};

} // namespace

const Frame& FrameReader::read(std::span<const std::byte> payload, Version version) {
    if (version < Version{2, 5})
        refusePacket("NatNet " + std::to_string(version.major) + "." + std::to_string(version.minor) + " is too old");
    Walk(payload, version, next_).whole();
    std::swap(frame_, next_);
    return frame_;
}

} // namespace lumorph::natnet
