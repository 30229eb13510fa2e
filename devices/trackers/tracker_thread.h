#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include <QThread>

#include "devices/trackers/tracker.h"
#include "devices/trackers/tracker_log.h"

namespace lumorph {

/// What one kind of tracker does; made, called and ended in the tracker's own thread, which has an event loop.
class TrackerWork {
public:
    virtual ~TrackerWork() = default;
    /// At even steps of time, whatever arrives.
    virtual void tick() = 0;
};

class TrackerThread final : public Tracker {
public:
    /// Throws what `make` throws.
    TrackerThread(std::shared_ptr<TrackerLog> log, std::function<std::unique_ptr<TrackerWork>()> make,
                  std::chrono::milliseconds step);
    ~TrackerThread() override;
    TrackerThread(const TrackerThread&) = delete;
    TrackerThread& operator=(const TrackerThread&) = delete;

    [[nodiscard]] TrackerStatus status() const override { return log_->status(); }

private:
    std::shared_ptr<TrackerLog> log_;
    std::unique_ptr<QThread> thread_;
};

// One a scheme; `address` is the URI, for the status. Throw DeviceError where a port cannot be had.
struct NatNetAddress;
struct OpenTrackAddress;
struct OscAddress;
struct SimulatedBodyAddress;
[[nodiscard]] std::unique_ptr<Tracker> openNatNet(const NatNetAddress& address, const std::string& uri,
                                                  TrackerOptions options);
[[nodiscard]] std::unique_ptr<Tracker> openOpenTrack(const OpenTrackAddress& address, const std::string& uri,
                                                     TrackerOptions options);
[[nodiscard]] std::unique_ptr<Tracker> openOsc(const OscAddress& address, const std::string& uri,
                                               TrackerOptions options);
[[nodiscard]] std::unique_ptr<Tracker> openSimulated(const SimulatedBodyAddress& address, const std::string& uri,
                                                     TrackerOptions options);

} // namespace lumorph
