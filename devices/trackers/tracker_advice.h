#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/clock.h"
#include "devices/trackers/tracker_address.h"

namespace lumorph {

/// What a tracker's thread has seen, from which it can be told why nothing arrives.
struct TrackerSituation {
    bool openToNetwork = false;
    bool localMissing = false; ///< the address says local=, and this machine has no such address
    std::string ownAddresses;
    std::string trouble; ///< a socket that could not be had; a sentence
    Microseconds sinceOpened{0};
    std::optional<Microseconds> sinceFrame;    ///< the newest good frame
    std::optional<Microseconds> sinceRejected; ///< the newest packet that was wrong
    std::string lastRejected;                  ///< why, and from whom
    std::uint64_t dropped = 0;                 ///< packets of other machines, while not open
    std::string lastDropped;                   ///< from whom
    std::optional<Microseconds> sinceDropped;
};

struct NatNetSituation : TrackerSituation {
    bool hostIsHere = false;
    std::optional<natnet::ServerInfo> server;
    bool framesWithoutVersion = false;
};

/// A body that is not followed, because another tracker brings one of the same name and came first.
struct SharedName {
    std::string body;
    std::size_t more = 0; ///< other bodies of which the same is true
    std::string address;  ///< of the tracker that is followed
    std::string source;   ///< as its status tells it; empty where that is not known
};

// Plain sentences on what to check, in order; empty while all is well or it is too early to tell.
[[nodiscard]] std::string adviceFor(const NatNetAddress& address, const NatNetSituation& situation);
[[nodiscard]] std::string adviceFor(const OpenTrackAddress& address, const TrackerSituation& situation);
/// `onlyRotations`: positions are what is missing.
[[nodiscard]] std::string adviceFor(const OscAddress& address, const TrackerSituation& situation, bool onlyRotations);
/// Why a tracker that sends is not followed; never empty.
[[nodiscard]] std::string adviceFor(const SharedName& shared);

} // namespace lumorph
