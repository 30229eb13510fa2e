#include "app/table/tracker_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "calibration/lab/true_room.h"
#include "core/base/error.h"
#include "devices/protocol/natnet_writer.h"

namespace lumorph::table {

namespace {

constexpr natnet::Version kVersion{2, 10};
constexpr std::chrono::microseconds kPeriod{1'000'000 / 120};
constexpr std::size_t kRemembered = 120; // packets: a second
constexpr double kDegree = 0.017453292519943295;

/// What a camera system that was set up well still trembles by.
class Tremble {
public:
    explicit Tremble(std::uint32_t seed) : engine_(seed) {}
    Pose operator()(const Pose& pose) {
        const LabErrors errors;
        const glm::dvec3 turn = 0.5 * errors.trackerNoiseDegrees * kDegree * three();
        return {pose.position + 1e-3 * errors.trackerNoiseMillimetres * three(),
                glm::normalize(pose.rotation * glm::dquat(1.0, turn.x, turn.y, turn.z))};
    }

private:
    glm::dvec3 three() {
        const double x = dice_(engine_), y = dice_(engine_), z = dice_(engine_);
        return {x, y, z};
    }
    std::mt19937 engine_;
    std::normal_distribution<double> dice_;
};

Pose poseOf(const glm::dmat4& matrix) {
    return {glm::dvec3(matrix[3]), glm::normalize(glm::quat_cast(glm::dmat3(matrix)))};
}

natnet::RigidBody rigidBody(std::size_t number, const std::optional<Pose>& pose) {
    natnet::RigidBody body;
    body.id = static_cast<std::int32_t>(number + 1);
    body.valid = pose.has_value();
    if (!pose) return body;
    body.position = glm::vec3(pose->position);
    body.rotation = glm::quat(pose->rotation);
    return body;
}

/// Who listens: whoever spoke last.
struct Client {
    sockaddr_in at{};
    bool isThere = false;
};

} // namespace

TrackerServer::TrackerServer(const Table& table) : table_(table), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
        ::close(socket_);
        throw DeviceError("tracker of the table", "there is no free port", "end programs that hold ports");
    }
    port_ = ntohs(at.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

TrackerServer::~TrackerServer() {
    thread_.request_stop();
    thread_.join();
    ::close(socket_);
}

std::string TrackerServer::address() const {
    return "natnet://127.0.0.1?mode=unicast&command=" + std::to_string(port_);
}

std::optional<Microseconds> TrackerServer::sentAfter(Microseconds time) const {
    const std::scoped_lock lock(mutex_);
    const auto first = std::ranges::find_if(sent_, [time](const auto& one) { return one.first >= time; });
    return first == sent_.end() ? std::nullopt : std::optional(first->second);
}

void TrackerServer::serve(const std::stop_token& stop) {
    NatNetWriter writer(kVersion);
    Client client;
    const auto send = [&](const std::vector<std::byte>& bytes) {
        ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&client.at),
                 sizeof client.at);
    };
    const auto answer = [&](std::span<const std::byte> datagram) {
        const natnet::Packet packet = natnet::readPacket(datagram);
        if (packet.message == natnet::Message::connect)
            send(writer.serverInfo({"Lumorph table", {1, 0, 0, 0}, kVersion, {}}));
        if (packet.message != natnet::Message::requestModels) return;
        std::vector<natnet::Model> models;
        for (std::size_t k = 0; k < kTableBodies.size(); ++k) {
            const auto id = static_cast<std::int32_t>(k + 1);
            models.push_back(
                {natnet::Model::Kind::rigidBody, kTableBodies[k], id, {{kTableBodies[k], id, -1, {}}}, {}});
        }
        send(writer.models(models));
    };
    const Installation& room = table_.truth().room;
    const Pose trackerFromWorld = inverseOf(poseOf(glm::dmat4(room.worldFromTracker)));
    const Microseconds late(std::llround(1e6 * room.trackerSeconds));
    Tremble tremble(table_.truth().seed * 77U + 5U);
    const SteadyClock clock;
    const Microseconds begun = clock.now();
    auto next = std::chrono::steady_clock::now();
    for (std::int32_t number = 1; !stop.stop_requested(); ++number) {
        std::array<std::byte, 65536> bytes;
        sockaddr_in from{};
        socklen_t size = sizeof from;
        for (ssize_t got = 0; (got = ::recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                                reinterpret_cast<sockaddr*>(&from), &size)) > 0;) {
            client = {from, true};
            try {
                answer({bytes.data(), static_cast<std::size_t>(got)});
            } catch (const DataError&) {
                // Whoever sends that is none of its clients.
            }
        }
        if (client.isThere) {
            const Microseconds now = clock.now();
            natnet::Frame frame;
            frame.number = number;
            frame.latency = static_cast<float>(1e-6 * static_cast<double>((now - begun).count()));
            frame.timestamp = 1e-6 * static_cast<double>((now - begun).count());
            for (std::size_t k = 0; k < kTableBodies.size(); ++k) {
                std::optional<Pose> pose = table_.body(static_cast<TableBody>(k), now - late);
                if (dropsOut_) pose.reset();
                if (pose) pose = trackerFromWorld * *pose;
                if (pose && trembles_) pose = tremble(*pose);
                const std::size_t called = swapsBodies_ && k < 2 ? 1 - k : k;
                frame.bodies.push_back(rigidBody(called, pose));
            }
            send(writer.frame(frame));
            const std::scoped_lock lock(mutex_);
            sent_.emplace_back(now - late, clock.now());
            if (sent_.size() > kRemembered) sent_.pop_front();
        }
        next += kPeriod;
        std::this_thread::sleep_until(next);
    }
}

} // namespace lumorph::table
