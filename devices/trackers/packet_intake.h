#pragma once

#include <memory>
#include <optional>
#include <string>

#include "devices/trackers/tracker.h"
#include "devices/trackers/tracker_advice.h"
#include "devices/trackers/tracker_log.h"
#include "devices/trackers/udp_port.h"

namespace lumorph {

/// What every tracker on a socket does with what comes: who may send, what is counted, what is passed on.
class PacketIntake {
public:
    PacketIntake(const TrackerOptions& options, std::shared_ptr<TrackerLog> log);

    [[nodiscard]] const PacketGate& gate() const noexcept { return gate_; }
    /// Counts a packet; false for one that must not be looked at.
    bool admit(const QHostAddress& sender, Microseconds now);
    void reject(const std::string& why, Microseconds now);
    void reject(const std::string& why, const QHostAddress& sender, quint16 port, Microseconds now);
    void deliver(const TrackerFrame& frame, std::optional<double> latencyMilliseconds);
    void tick(Microseconds now);
    [[nodiscard]] TrackerSituation situation(Microseconds now) const;

private:
    std::shared_ptr<TrackerLog> log_;
    std::function<void(const TrackerFrame&)> onFrame_;
    PacketGate gate_;
    Microseconds opened_;
    Microseconds nextLook_;
    std::optional<Microseconds> frame_, rejected_, droppedAt_;
    std::string lastRejected_;
    std::uint64_t dropped_ = 0;
    std::string lastDropped_;
};

} // namespace lumorph
