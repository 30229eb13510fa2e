#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>

#include "devices/protocol/natnet.h"

namespace lumorph::test {

inline constexpr std::array<natnet::Version, 9> kNatNetVersions = {
    {{2, 5}, {2, 6}, {2, 7}, {2, 9}, {2, 10}, {3, 0}, {3, 1}, {4, 0}, {4, 1}}};

/// Frames of any content that a version can tell; what it cannot tell is left as a reader would leave it.
class RandomFrames {
public:
    explicit RandomFrames(std::uint64_t seed) : random_(seed) {}

    [[nodiscard]] natnet::Frame frame(natnet::Version version) {
        version_ = version;
        natnet::Frame f;
        f.number = std::uniform_int_distribution<std::int32_t>()(random_);
        for (int n = some(3); n > 0; --n) {
            natnet::MarkerSet& set = f.markerSets.next();
            set.name = std::string(static_cast<std::size_t>(some(40)), 'm');
            for (int i = some(5); i > 0; --i) set.markers.push_back(vector());
        }
        for (int n = some(5); n > 0; --n) f.otherMarkers.push_back(vector());
        bodies(f.bodies);
        for (int n = some(2); n > 0; --n) {
            natnet::Assembly& skeleton = f.skeletons.next();
            skeleton.id = id();
            bodies(skeleton.bodies);
        }
        if (version >= natnet::Version{4, 1})
            for (int n = some(2); n > 0; --n) {
                natnet::Assembly& asset = f.assets.next();
                asset.id = id();
                bodies(asset.bodies);
                markers(asset.markers);
            }
        markers(f.labelled);
        if (version >= natnet::Version{2, 9}) analogs(f.plates);
        if (version >= natnet::Version{2, 11}) analogs(f.devices);
        if (version.major < 3) f.latency = number();
        f.timecode = {static_cast<std::uint32_t>(id()), static_cast<std::uint32_t>(id())};
        if (version >= natnet::Version{2, 7}) f.timestamp = 1e3 * static_cast<double>(number());
        if (version.major >= 3) f.ticks = natnet::Frame::Ticks{random_(), random_(), random_()};
        if (version >= natnet::Version{2, 6}) f.params = static_cast<std::int16_t>(some(3));
        return f;
    }

private:
    int some(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
    std::int32_t id() { return std::uniform_int_distribution<std::int32_t>(0, 1 << 20)(random_); }
    float number() { return std::uniform_real_distribution<float>(-3.0F, 3.0F)(random_); }
    glm::vec3 vector() {
        const float x = number();
        const float y = number();
        return {x, y, number()};
    }
    void bodies(std::vector<natnet::RigidBody>& bodies) {
        for (int n = some(4); n > 0; --n) {
            natnet::RigidBody body;
            body.id = id();
            body.position = vector();
            const glm::vec3 v = vector();
            body.rotation = glm::quat(number(), v.x, v.y, v.z);
            body.error = number();
            if (version_ >= natnet::Version{2, 6}) body.valid = some(1) == 1;
            bodies.push_back(body);
        }
    }
    void markers(std::vector<natnet::LabelledMarker>& markers) {
        for (int n = some(4); n > 0; --n) {
            natnet::LabelledMarker marker{id(), vector(), number()};
            if (version_ >= natnet::Version{2, 6}) marker.params = static_cast<std::int16_t>(some(7));
            if (version_.major >= 3) marker.residual = number();
            markers.push_back(marker);
        }
    }
    void analogs(Reused<natnet::Analog>& analogs) {
        for (int n = some(2); n > 0; --n) {
            natnet::Analog& analog = analogs.next();
            analog.id = id();
            for (int c = some(2); c > 0; --c) {
                std::vector<float>& channel = analog.channels.next();
                for (int i = some(3); i > 0; --i) channel.push_back(number());
            }
        }
    }

    std::mt19937_64 random_;
    natnet::Version version_;
};

/// One of each kind.
[[nodiscard]] inline std::vector<natnet::Model> allModels(natnet::Version version) {
    using Kind = natnet::Model::Kind;
    const natnet::Model::Body hips{"hips", 262145, 0, {0.0F, 1.0F, 0.0F}};
    const natnet::Model::Body chest{"chest", 262146, 262145, {0.0F, 0.25F, 0.5F}};
    const std::vector<std::string> names =
        version.major >= 4 ? std::vector<std::string>{"left", "right"} : std::vector<std::string>{};
    std::vector<natnet::Model> models = {
        {Kind::markerSet, "all", 0, {}, {"one", "two", ""}},
        {Kind::rigidBody, "glasses", 3, {{"glasses", 3, -1, {0.0F, 0.5F, 0.0F}}}, names},
        {Kind::skeleton, "Karlie", 4, {hips, chest}, {}},
        {Kind::camera, "Prime 13 #1", 0, {}, {}},
        {Kind::rigidBody, "tablet", 7, {{"tablet", 7, -1, {}}}, {}}};
    if (version.major >= 3) {
        models.push_back({Kind::plate, "plate 5", 11, {}, {}});
        models.push_back({Kind::device, "NI-DAQ", 12, {}, {}});
    }
    if (version >= natnet::Version{4, 1}) models.push_back({Kind::asset, "ball", 9, {hips}, {"top", "bottom"}});
    return models;
}

} // namespace lumorph::test
