#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "app/table/table.h"

namespace lumorph::table {

/// The table's tracker: a NatNet 2.10 server (unicast) on the loopback that sends the bodies 120 times a second, in a
/// world of its own, with noise, `trackerSeconds` of the truth later than it says.
class TrackerServer {
public:
    /// `table` outlives it. Throws DeviceError where there is no port.
    explicit TrackerServer(const Table& table);
    ~TrackerServer();
    TrackerServer(const TrackerServer&) = delete;
    TrackerServer& operator=(const TrackerServer&) = delete;

    [[nodiscard]] std::string address() const;
    void setDropsOut(bool dropsOut) { dropsOut_ = dropsOut; } ///< it sees no body
    void setTrembles(bool trembles) { trembles_ = trembles; } ///< its poses are noisy; at first they are
    /// When the first packet with poses of `time` or later was sent; empty: not yet, or more than a second ago.
    [[nodiscard]] std::optional<Microseconds> sentAfter(Microseconds time) const;
    void setSwapsBodies(bool swaps) { swapsBodies_ = swaps; } ///< device and pointer are taken for each other

private:
    void serve(const std::stop_token& stop);

    const Table& table_;
    int socket_ = -1;
    int port_ = 0;
    std::atomic<bool> dropsOut_{false}, swapsBodies_{false}, trembles_{true};
    mutable std::mutex mutex_;
    std::deque<std::pair<Microseconds, Microseconds>> sent_; ///< of the last second: of when the poses were, and when
    std::jthread thread_;
};

} // namespace lumorph::table
