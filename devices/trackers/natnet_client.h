#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "devices/protocol/natnet.h"
#include "devices/trackers/clock_match.h"
#include "devices/trackers/tracker.h"

namespace lumorph {

/// One conversation with a NatNet server, without its sockets: what to say and when, what the answers mean.
class NatNetClient {
public:
    enum class Outcome { frame, answer, waiting };
    using Send = std::function<void(std::span<const std::byte>)>;

    /// Servers in unicast are told again and again that somebody listens. `version` is for those that do not tell it.
    NatNetClient(bool unicast, std::optional<natnet::Version> version, Send send);

    /// Says what is due: who we are until the server answers and whenever it falls silent, that we still listen, what
    /// its names are, what its time is.
    void tick(Microseconds now);
    /// Throws DataError; then all stays as it was. `waiting`: a frame came before its version was known.
    Outcome take(std::span<const std::byte> datagram, Microseconds now);

    /// Of the last packet that was a frame.
    [[nodiscard]] const TrackerFrame& frame() const noexcept { return tracked_; }
    [[nodiscard]] std::optional<double> latencyMilliseconds() const noexcept { return latency_; }
    [[nodiscard]] const std::optional<natnet::ServerInfo>& server() const noexcept { return server_; }
    [[nodiscard]] std::optional<natnet::Version> version() const noexcept;
    /// Frames of this version were seen from real software.
    [[nodiscard]] bool isVerified() const noexcept;

private:
    void takeServer(std::span<const std::byte> payload, Microseconds now);
    void takeModels(std::span<const std::byte> payload);
    void takeEcho(std::span<const std::byte> payload, Microseconds now);
    void takeFrame(std::span<const std::byte> payload, Microseconds now);
    [[nodiscard]] Microseconds measuredAt(const natnet::Frame& frame, Microseconds now);
    void nameBody(TrackedBody& body);

    bool unicast_;
    std::optional<natnet::Version> given_;
    Send send_;
    std::optional<natnet::ServerInfo> server_;
    natnet::FrameReader reader_;
    std::map<std::int32_t, std::string> names_;
    std::set<std::int32_t> nameless_; ///< asked for once
    ClockMatch clocks_;
    TrackerFrame tracked_;
    std::optional<double> latency_;
    bool namesWanted_ = true;
    std::size_t echoes_ = 0; ///< answered since the server came
    std::optional<Microseconds> echoAsked_;
    std::optional<Microseconds> heard_; ///< a good packet
    Microseconds nextHello_, nextNames_, nextEcho_;
};

} // namespace lumorph
