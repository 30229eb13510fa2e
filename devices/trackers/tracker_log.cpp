#include "devices/trackers/tracker_log.h"

#include <cstdio>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph {

namespace {

constexpr Microseconds kReceiving{1'000'000};
constexpr Microseconds kNever{-1'000'000'000'000};
constexpr Microseconds kEventPause{100'000}; ///< a stream may be odd in every frame
constexpr double kFastest = 6.0;             ///< metres a second: a hand that strikes
constexpr double kLeastJump = 0.2;           ///< metres
constexpr double kLongestGap = 1.0;          ///< seconds; after that it may be anywhere

double secondsOf(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

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
    noteJumps(frame);
    noteNonsense(frame);
    measured_ = frame.measured;
    lastGood_ = frame.arrived;
    status_.bodies = frame.bodies;
    status_.latencyMilliseconds = latencyMilliseconds;
}

void TrackerLog::noteJumps(const TrackerFrame& frame) {
    const double gap = secondsOf(frame.measured - measured_);
    if (status_.bodies.size() != frame.bodies.size() || gap > kLongestGap || frame.arrived < nextEvent_) return;
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
        const TrackedBody& now = frame.bodies[i];
        const TrackedBody& before = status_.bodies[i];
        if (!now.valid || !before.valid || now.id != before.id) continue;
        const double way = glm::distance(now.pose.position, before.pose.position);
        if (!(way > kLeastJump + kFastest * gap)) continue;
        char metres[32];
        std::snprintf(metres, sizeof metres, "%.2f m", way);
        status_.event = now.name + " jumped by " + metres;
        ++status_.events;
        nextEvent_ = frame.arrived + kEventPause;
    }
}

void TrackerLog::noteNonsense(const TrackerFrame& frame) {
    if (frame.arrived < nextEvent_) return;
    for (const TrackedBody& body : frame.bodies) {
        if (body.isNumber) continue;
        status_.event = "the pose of " + body.name + " is no number, so it counts as not seen";
        ++status_.events;
        nextEvent_ = frame.arrived + kEventPause;
    }
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
