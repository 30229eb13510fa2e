#pragma once

#include <mutex>
#include <string>

#include "devices/trackers/rate_meter.h"
#include "devices/trackers/tracker.h"

namespace lumorph {

/// What a tracker's thread tells of itself, for those who ask from other threads.
class TrackerLog {
public:
    TrackerLog(std::string address, std::shared_ptr<const Clock> clock);

    void notePacket();
    void noteRejected(const std::string& why);
    /// A good frame; `latency` where it is known.
    void noteFrame(const TrackerFrame& frame, std::optional<double> latencyMilliseconds);
    /// A good packet that is no frame.
    void noteAnswer();
    void setSource(const std::string& source, bool verified);
    void setAdvice(const std::string& advice);
    [[nodiscard]] TrackerStatus status() const;

private:
    /// What moves farther between two frames than a body can.
    void noteJumps(const TrackerFrame& frame);
    void noteNonsense(const TrackerFrame& frame);

    mutable std::mutex mutex_;
    std::shared_ptr<const Clock> clock_;
    TrackerStatus status_;
    RateMeter packets_;
    RateMeter frames_;
    Microseconds lastGood_;    ///< never: a negative time long ago
    Microseconds measured_{0}; ///< of the newest frame
    Microseconds nextEvent_{0};
};

} // namespace lumorph
