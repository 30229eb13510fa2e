#include "devices/trackers/natnet_client.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph {

namespace {

using natnet::Message;
using natnet::Version;

constexpr Microseconds kHelloEvery{1'000'000};
constexpr Microseconds kAliveEvery{2'000'000};
constexpr Microseconds kServerSilence{3'000'000};
constexpr Microseconds kNamesEvery{1'000'000};
constexpr Microseconds kEchoEvery{1'000'000};
constexpr std::size_t kQuickEchoes = 5; ///< one a tick, until times are known well
constexpr Microseconds kLongestLatency{1'000'000};
constexpr double kLongestToldLatency = 0.25; // seconds
constexpr std::size_t kMostNames = 4096;
constexpr std::size_t kLongestName = 256;
constexpr std::array<std::uint8_t, 4> kProgram = {0, 3, 0, 0};
constexpr std::array kVerified = {Version{2, 5}, Version{2, 7}, Version{2, 9}, Version{2, 10}};

/// Whether it says which bodies it sees.
bool tellsValid(const natnet::Version& version) {
    return version.major > 2 || (version.major == 2 && version.minor >= 6);
}

bool isSound(const natnet::RigidBody& body) {
    const float length = glm::length(body.rotation);
    return glm::dot(body.position, body.position) < 1e6F && length > 0.1F && length < 10.0F;
}

void nameBodies(const std::vector<natnet::Model>& models, std::map<std::int32_t, std::string>& names) {
    for (const natnet::Model& model : models) {
        if (model.kind != natnet::Model::Kind::rigidBody || names.size() >= kMostNames) continue;
        if (!model.name.empty()) names[model.id] = model.name.substr(0, kLongestName);
    }
}

} // namespace

NatNetClient::NatNetClient(bool unicast, std::optional<Version> version, Send send)
    : unicast_(unicast), given_(version), send_(std::move(send)), nextHello_(0), nextNames_(0), nextEcho_(0) {}

std::optional<Version> NatNetClient::version() const noexcept { return server_ ? server_->natnet : given_; }

bool NatNetClient::isVerified() const noexcept {
    const auto known = version();
    return !known || std::ranges::find(kVerified, *known) != kVerified.end();
}

void NatNetClient::tick(Microseconds now) {
    const bool silent = !server_ || !heard_ || now - *heard_ > kServerSilence;
    if (now >= nextHello_) {
        if (silent)
            send_(natnet::connectPacket("Lumorph", kProgram));
        else if (unicast_)
            send_(natnet::keepAlivePacket());
        nextHello_ = now + (silent ? kHelloEvery : kAliveEvery);
    }
    if (silent) return;
    if (namesWanted_ && now >= nextNames_) {
        send_(natnet::modelsRequestPacket());
        nextNames_ = now + kNamesEvery;
    }
    if (server_->connection && now >= nextEcho_) {
        echoAsked_ = now;
        send_(natnet::echoPacket(static_cast<std::uint64_t>(now.count())));
        nextEcho_ = echoes_ < kQuickEchoes ? now : now + kEchoEvery;
    }
}

NatNetClient::Outcome NatNetClient::take(std::span<const std::byte> datagram, Microseconds now) {
    const natnet::Packet packet = natnet::readPacket(datagram);
    switch (packet.message) {
    case Message::serverInfo:
        takeServer(packet.payload, now);
        break;
    case Message::models:
        takeModels(packet.payload);
        break;
    case Message::echoResponse:
        takeEcho(packet.payload, now);
        break;
    case Message::frame:
        if (!version()) return Outcome::waiting;
        takeFrame(packet.payload, now);
        heard_ = now;
        return Outcome::frame;
    default:
        break; // what others say to each other in the group
    }
    heard_ = now;
    return Outcome::answer;
}

void NatNetClient::takeServer(std::span<const std::byte> payload, Microseconds now) {
    natnet::ServerInfo server = natnet::readServerInfo(payload);
    // One that comes back may have begun its time, its names and its ids anew.
    clocks_.clear();
    echoes_ = 0;
    nextEcho_ = nextNames_ = now;
    namesWanted_ = true;
    nameless_.clear();
    server_ = std::move(server);
}

void NatNetClient::takeModels(std::span<const std::byte> payload) {
    const auto known = version();
    if (!known) return;
    std::map<std::int32_t, std::string> names;
    nameBodies(natnet::readModels(payload, *known), names);
    names_ = std::move(names);
    namesWanted_ = false;
}

void NatNetClient::takeEcho(std::span<const std::byte> payload, Microseconds now) {
    const natnet::Echo echo = natnet::readEcho(payload);
    // Answers to what was never asked would set the clock as somebody else likes.
    if (!echoAsked_ || echo.sent != static_cast<std::uint64_t>(echoAsked_->count()) || !server_->connection) return;
    clocks_.add(*echoAsked_, now, echo.received, server_->connection->clockHertz);
    echoAsked_.reset();
    ++echoes_;
}

Microseconds NatNetClient::measuredAt(const natnet::Frame& frame, Microseconds now) {
    latency_.reset();
    Microseconds measured = now;
    if (frame.ticks && frame.ticks->exposure != 0) {
        const auto local = clocks_.localOf(frame.ticks->exposure);
        // Two clocks that are known to some tenths of a millisecond may put the effect before its cause.
        if (local && *local <= now + Microseconds{5'000} && now - *local <= kLongestLatency) {
            measured = std::min(*local, now);
            latency_ = 1e-3 * static_cast<double>((now - measured).count());
        }
    } else if (frame.latency && *frame.latency > 0.0F && *frame.latency < kLongestToldLatency) {
        // Real servers put the time of the frame here, which is the same as its time stamp, or far too long.
        const bool isTime = frame.timestamp && std::abs(*frame.timestamp - *frame.latency) < 1e-3;
        if (!isTime) measured -= Microseconds(std::llround(1e6 * *frame.latency));
        if (!isTime) latency_ = 1e3 * *frame.latency;
    }
    return measured;
}

void NatNetClient::nameBody(TrackedBody& body) {
    const auto found = names_.find(body.id);
    if (found != names_.end()) {
        body.name = found->second;
        return;
    }
    body.name = "body " + std::to_string(body.id);
    // Some have no name at all: to ask for them again and again would not help.
    if (nameless_.size() < kMostNames && nameless_.insert(body.id).second) namesWanted_ = true;
}

void NatNetClient::takeFrame(std::span<const std::byte> payload, Microseconds now) {
    const natnet::Frame& frame = reader_.read(payload, *version());
    tracked_.number = static_cast<std::uint32_t>(frame.number);
    tracked_.arrived = now;
    tracked_.measured = measuredAt(frame, now);
    if (frame.modelsChanged()) namesWanted_ = true;
    tracked_.bodies.resize(frame.bodies.size());
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
        const natnet::RigidBody& told = frame.bodies[i];
        TrackedBody& body = tracked_.bodies[i];
        body.id = told.id;
        const bool sound = isSound(told);
        body.valid = told.valid && sound;
        // What is not seen may be told as anything.
        body.isNumber = sound || !told.valid || !tellsValid(*version());
        body.pose = sound ? Pose{told.position, glm::normalize(glm::dquat(told.rotation))} : Pose{};
        nameBody(body);
    }
}

} // namespace lumorph
