#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "devices/protocol/natnet.h"

namespace lumorph {

/// Writes what a NatNet server says, for tests and rehearsals: from the description of the bytes alone, so that it can
/// judge the readers.
class NatNetWriter {
public:
    explicit NatNetWriter(natnet::Version version) : version_(version) {}

    /// What sources disagree on.
    bool preciseTime = true;     ///< since 4.1
    bool earlyTime = false;      ///< a float before 2.7
    int markersInBodies = 2;     ///< before 3.0
    std::size_t moreBytes = 0;   ///< at the end of each description, since 4.1
    std::int16_t bodyParams = 0; ///< flags of bodies beside the first, which tells that they are tracked

    [[nodiscard]] std::vector<std::byte> frame(const natnet::Frame& f) {
        begin(7);
        put(f.number);
        section(f.markerSets.size(), [&] {
            for (const natnet::MarkerSet& set : f.markerSets) {
                text(set.name);
                points(set.markers, true);
            }
        });
        section(f.otherMarkers.size(), [&] { points(f.otherMarkers, false); });
        section(f.bodies.size(), [&] { bodies(f.bodies); });
        section(f.skeletons.size(), [&] {
            for (const natnet::Assembly& skeleton : f.skeletons) {
                put(skeleton.id);
                put(count(skeleton.bodies));
                bodies(skeleton.bodies);
            }
        });
        if (version_ >= natnet::Version{4, 1}) section(f.assets.size(), [&] { assets(f); });
        section(f.labelled.size(), [&] { labelled(f.labelled); });
        if (version_ >= natnet::Version{2, 9}) section(f.plates.size(), [&] { analogs(f.plates); });
        if (version_ >= natnet::Version{2, 11}) section(f.devices.size(), [&] { analogs(f.devices); });
        suffix(f);
        return end();
    }

    [[nodiscard]] std::vector<std::byte> models(const std::vector<natnet::Model>& models) {
        begin(5);
        put(count(models));
        for (const natnet::Model& model : models) description(static_cast<int>(model.kind), [&] { about(model); });
        return end();
    }

    /// A description of a kind that nobody knows, before another.
    [[nodiscard]] std::vector<std::byte> modelsWithUnknown(const natnet::Model& model) {
        begin(5);
        put(std::int32_t{2});
        description(99, [&] { text("whatever this is"); });
        description(static_cast<int>(model.kind), [&] { about(model); });
        return end();
    }

    [[nodiscard]] std::vector<std::byte> serverInfo(const natnet::ServerInfo& info) {
        begin(1);
        std::array<char, 256> name{};
        name.fill('x'); // what real servers leave behind the zero
        std::memcpy(name.data(), info.name.c_str(), info.name.size() + 1);
        for (const char c : name) put(c);
        for (const std::uint8_t part : info.program) put(part);
        for (const int part : {info.natnet.major, info.natnet.minor, 0, 0}) put(static_cast<std::uint8_t>(part));
        if (info.connection) {
            put(info.connection->clockHertz);
            put(info.connection->dataPort);
            put(static_cast<std::uint8_t>(info.connection->multicast));
            for (const std::uint8_t part : info.connection->address) put(part);
        }
        return end();
    }

    [[nodiscard]] std::vector<std::byte> echo(std::uint64_t sent, std::uint64_t received) {
        begin(13);
        put(sent);
        put(received);
        return end();
    }

private:
    template <typename T> void put(T value) {
        static_assert(std::is_arithmetic_v<T>);
        const std::size_t at = out_.size();
        out_.resize(at + sizeof value);
        std::memcpy(out_.data() + at, &value, sizeof value);
    }
    template <typename List> static std::int32_t count(const List& list) {
        return static_cast<std::int32_t>(list.size());
    }
    void text(std::string_view text) {
        for (const char c : text) put(c);
        put('\0');
    }
    void vector(const glm::vec3& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void begin(std::uint16_t message) {
        out_.clear();
        put(message);
        put(std::uint16_t{0});
    }
    std::vector<std::byte> end() {
        const auto size = static_cast<std::uint16_t>(out_.size() - 4);
        std::memcpy(out_.data() + 2, &size, sizeof size);
        return out_;
    }
    /// Since 4.1 a size follows every count.
    template <typename Write> void section(std::size_t n, Write write) {
        put(static_cast<std::int32_t>(n));
        sized(write, 0);
    }
    template <typename Write> void description(std::int32_t kind, Write write) {
        put(kind);
        sized(write, moreBytes);
    }
    template <typename Write> void sized(Write write, std::size_t more) {
        const bool told = version_ >= natnet::Version{4, 1};
        const std::size_t at = out_.size();
        if (told) put(std::uint32_t{0});
        write();
        if (!told) return;
        out_.resize(out_.size() + more);
        const auto size = static_cast<std::uint32_t>(out_.size() - at - 4);
        std::memcpy(out_.data() + at, &size, sizeof size);
    }
    void points(const std::vector<glm::vec3>& points, bool counted) {
        if (counted) put(count(points));
        for (const glm::vec3& p : points) vector(p);
    }
    void bodies(const std::vector<natnet::RigidBody>& bodies) {
        for (const natnet::RigidBody& body : bodies) {
            put(body.id);
            vector(body.position);
            for (const float q : {body.rotation.x, body.rotation.y, body.rotation.z, body.rotation.w}) put(q);
            if (version_.major < 3) {
                put(std::int32_t{markersInBodies});
                for (int i = 0; i < markersInBodies; ++i) vector({1.5F, 2.5F, 3.5F});
                for (int i = 0; i < markersInBodies; ++i) put(std::int32_t{i});
                for (int i = 0; i < markersInBodies; ++i) put(0.02F);
            }
            put(body.error);
            if (version_ >= natnet::Version{2, 6}) put(static_cast<std::int16_t>(bodyParams | (body.valid ? 1 : 0)));
        }
    }
    void labelled(const std::vector<natnet::LabelledMarker>& markers) {
        for (const natnet::LabelledMarker& marker : markers) {
            put(marker.id);
            vector(marker.position);
            put(marker.size);
            if (version_ >= natnet::Version{2, 6}) put(marker.params);
            if (version_.major >= 3) put(marker.residual);
        }
    }
    void assets(const natnet::Frame& f) {
        for (const natnet::Assembly& asset : f.assets) {
            put(asset.id);
            put(count(asset.bodies));
            bodies(asset.bodies);
            put(count(asset.markers));
            labelled(asset.markers);
        }
    }
    void analogs(const Reused<natnet::Analog>& analogs) {
        for (const natnet::Analog& analog : analogs) {
            put(analog.id);
            put(count(analog.channels));
            for (const std::vector<float>& channel : analog.channels) {
                put(count(channel));
                for (const float value : channel) put(value);
            }
        }
    }
    void suffix(const natnet::Frame& f) {
        if (version_.major < 3) put(f.latency.value());
        for (const std::uint32_t part : f.timecode) put(part);
        if (version_ >= natnet::Version{2, 7})
            put(f.timestamp.value());
        else if (earlyTime)
            put(static_cast<float>(f.timestamp.value()));
        if (version_.major >= 3)
            for (const std::uint64_t ticks : {f.ticks->exposure, f.ticks->received, f.ticks->sent}) put(ticks);
        if (version_ >= natnet::Version{4, 1} && preciseTime) put(std::uint64_t{0x1122334455667788});
        if (version_ >= natnet::Version{2, 6}) put(f.params);
        put(std::uint32_t{0});
    }
    void body(const natnet::Model::Body& body, const std::vector<std::string>& markers) {
        text(body.name);
        put(body.id);
        put(body.parent);
        vector(body.offset);
        if (version_.major < 3) return;
        put(count(markers));
        for (std::size_t i = 0; i < markers.size(); ++i) vector({0.1F, 0.2F, 0.3F});
        for (std::size_t i = 0; i < markers.size(); ++i) put(std::int32_t{7});
        if (version_.major < 4) return;
        for (const std::string& marker : markers) text(marker);
    }
    void channels() {
        put(std::int32_t{1});
        put(std::int32_t{2});
        put(std::int32_t{2});
        text("Fx");
        text("Fy");
    }
    void about(const natnet::Model& m) {
        using Kind = natnet::Model::Kind;
        switch (m.kind) {
        case Kind::markerSet:
            text(m.name);
            put(count(m.markers));
            for (const std::string& marker : m.markers) text(marker);
            break;
        case Kind::rigidBody:
            body(m.bodies.front(), m.markers);
            break;
        case Kind::skeleton:
            text(m.name);
            put(m.id);
            put(count(m.bodies));
            for (const natnet::Model::Body& bone : m.bodies) body(bone, {});
            break;
        case Kind::plate:
            put(m.id);
            text(m.name);
            for (int i = 0; i < 2 + 3 + 144 + 12; ++i) put(static_cast<float>(i));
            channels();
            break;
        case Kind::device:
            put(m.id);
            text(m.name);
            text("serial 12");
            channels();
            break;
        case Kind::camera:
            text(m.name);
            for (int i = 0; i < 7; ++i) put(0.5F);
            break;
        case Kind::asset:
            text(m.name);
            put(std::int32_t{1});
            put(m.id);
            put(count(m.bodies));
            for (const natnet::Model::Body& bone : m.bodies) body(bone, {});
            put(count(m.markers));
            for (const std::string& marker : m.markers) {
                text(marker);
                put(std::int32_t{3});
                vector({1, 2, 3});
                put(0.02F);
                put(std::int16_t{0});
            }
            break;
        }
    }

    natnet::Version version_;
    std::vector<std::byte> out_;
};

} // namespace lumorph
