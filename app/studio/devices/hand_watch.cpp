#include "app/studio/devices/hand_watch.h"

#include <utility>

#include "app/studio/devices/device_log.h"
#include "core/loop/hand_near.h"

namespace lumorph::studio {

std::vector<LinkEvent> handEvents(const HandSense& before, const HandSense& after, Microseconds now) {
    using Kind = LinkEvent::Kind;
    std::vector<LinkEvent> events;
    if (after.near && !before.near) events.push_back({now, Kind::information, "A hand is near: servos are slow.", ""});
    if (before.near && !after.near)
        events.push_back({now, Kind::information, "No hand is near any more: servos are as fast as before.", ""});
    if (after.held == before.held) return events;
    if (after.held.empty())
        events.push_back({now, Kind::information, "All servos follow again, and are as fast as before.", ""});
    else
        events.push_back({now, Kind::warning,
                          servosText(after.held) + (after.held.size() == 1 ? " is" : " are") +
                              " held or stuck: all servos are slow.",
                          "Take your hands off it; if none are there, look what it is stuck on."});
    return events;
}

void HandWatch::setPoses(std::shared_ptr<const PoseBoard> poses) {
    const std::scoped_lock lock(mutex_);
    poses_ = std::move(poses);
}

void HandWatch::setLimit(double metres) {
    const std::scoped_lock lock(mutex_);
    limit_ = metres;
}

void HandWatch::follow(const MatchFrame& frame) {
    const std::scoped_lock lock(mutex_);
    worldFromDevice_ = frame.worldFromDevice;
    if (frame.installation) installation_ = frame.installation;
    if (frame.devicePositions == measured_) return;
    measured_ = frame.devicePositions;
    box_ = measured_ ? boundingBox(*measured_) : Box{};
}

bool HandWatch::look(Microseconds now) {
    const std::scoped_lock lock(mutex_);
    distance_ = poses_ ? handDistance(*poses_, box_, worldFromDevice_, now, *installation_) : std::nullopt;
    if (limit_ <= 0.0) return near_ = false;
    if (distance_ && *distance_ <= limit_ + (near_ ? kMargin : 0.0)) {
        nearAt_ = now;
        return near_ = true;
    }
    return near_ = near_ && now >= nearAt_ && now - nearAt_ < (distance_ ? kAwayFor : kLostFor);
}

std::optional<double> HandWatch::distance() const {
    const std::scoped_lock lock(mutex_);
    return distance_;
}

bool HandWatch::near() const {
    const std::scoped_lock lock(mutex_);
    return near_;
}

} // namespace lumorph::studio
