#include "devices/trackers/tracker_log.h"

#include <utility>

namespace lumorph {

namespace {

constexpr Microseconds kReceiving{1'000'000};
constexpr Microseconds kNever{-1'000'000'000'000};

} // namespace

TrackerLog::TrackerLog(std::string address, std::shared_ptr<const Clock> clock)
    : clock_(std::move(clock)), lastGood_(kNever) {
    status_.address = std::move(address);
}

void TrackerLog::notePacket() {
    const Microseconds now = clock_->now();
    const std::scoped_lock lock(mutex_);
    ++status_.packets;
    packets_.note(now);
}

void TrackerLog::noteRejected(const std::string& why) {
    const std::scoped_lock lock(mutex_);
    ++status_.rejected;
    status_.lastRejected = why;
}

void TrackerLog::noteFrame(const TrackerFrame& frame, std::optional<double> latencyMilliseconds) {
    const std::scoped_lock lock(mutex_);
    frames_.note(frame.arrived);
    lastGood_ = frame.arrived;
    status_.bodies = frame.bodies;
    status_.latencyMilliseconds = latencyMilliseconds;
}

void TrackerLog::noteAnswer() {
    const Microseconds now = clock_->now();
    const std::scoped_lock lock(mutex_);
    lastGood_ = now;
}

void TrackerLog::setSource(const std::string& source, bool verified) {
    const std::scoped_lock lock(mutex_);
    status_.source = source;
    status_.verified = verified;
}

void TrackerLog::setAdvice(const std::string& advice) {
    const std::scoped_lock lock(mutex_);
    status_.advice = advice;
}

Microseconds TrackerLog::lastGood() const {
    const std::scoped_lock lock(mutex_);
    return lastGood_;
}

TrackerStatus TrackerLog::status() const {
    const Microseconds now = clock_->now();
    const std::scoped_lock lock(mutex_);
    TrackerStatus status = status_;
    status.receiving = now - lastGood_ <= kReceiving;
    status.packetsPerSecond = packets_.perSecond(now);
    status.framesPerSecond = frames_.perSecond(now);
    return status;
}

} // namespace lumorph
