#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "devices/protocol/natnet.h"

namespace lumorph {

/// Where poses come from, parsed from one URI. Machines are named by IPv4 numbers or "localhost", so that no name has
/// to be looked up.
struct NatNetAddress {
    std::string host;
    bool multicast = true;
    std::uint16_t command = 1510;
    std::uint16_t data = 1511;
    bool dataGiven = false; ///< frames may come to that port in unicast too
    std::string local;      ///< our address on the network of the server; empty for any
    std::string group = "239.255.42.99";
    std::optional<natnet::Version> version; ///< for servers that do not tell it
    bool operator==(const NatNetAddress&) const = default;
};
struct OpenTrackAddress {
    std::string local;
    std::uint16_t port = 4242;
    bool operator==(const OpenTrackAddress&) const = default;
};
struct OscAddress {
    std::string local;
    std::uint16_t port = 9000;
    bool operator==(const OscAddress&) const = default;
};
struct SimulatedBodyAddress {
    std::string body; ///< "head", "device" or "pointer"
    double noiseMillimetres = 0.0;
    double dropShare = 0.0; ///< of the frames, in [0, 1]
    double latencyMilliseconds = 0.0;
    double rateHertz = 100.0;
    bool operator==(const SimulatedBodyAddress&) const = default;
};
using TrackerAddress = std::variant<NatNetAddress, OpenTrackAddress, OscAddress, SimulatedBodyAddress>;

/// Throws InvalidInput naming the URI and the part that is wrong.
[[nodiscard]] TrackerAddress parseTrackerAddress(std::string_view uri);

} // namespace lumorph
