#include "devices/trackers/simulated_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/loop/tracked_room.h"

namespace lumorph {

namespace {

constexpr Microseconds kLongestPause{1'000'000};
constexpr Microseconds kRemembered{2'500'000}; ///< more than the longest latency and the longest pause
constexpr std::uint64_t kSeed = 20;
constexpr int kSpoiled = 10;  ///< frames
constexpr double kJump = 3.0; ///< metres

/// Where a head is before a table, the device on it, a hand above it; metres.
glm::dvec3 placeOf(const std::string& body) {
    if (body == "head") return {0.0, 0.45, 0.6};
    if (body == "pointer") return {0.2, 0.2, 0.1};
    return {0.0, 0.0, 0.0};
}

PoseRole roleOf(const std::string& body) {
    if (body == "head") return PoseRole::head;
    return body == "device" ? PoseRole::device : PoseRole::pointer;
}

} // namespace

SimulatedOrders ordersOf(const SimulatedBodyAddress& address) {
    SimulatedOrders orders;
    orders.noiseMillimetres = address.noiseMillimetres;
    orders.dropShare = address.dropShare;
    orders.latencyMilliseconds = address.latencyMilliseconds;
    orders.rateHertz = address.rateHertz;
    return orders;
}

SimulatedBody::SimulatedBody(const SimulatedBodyAddress& address, Microseconds start)
    : name_(address.body), role_(roleOf(address.body)), orders_(ordersOf(address)), start_(start), paced_(start),
      random_(kSeed) {
    held_.emplace_back(start, std::nullopt);
    frame_.bodies = {{1, name_, true, {}}};
}

void SimulatedBody::order(const SimulatedOrders& orders, Microseconds now) {
    if (orders == orders_) return;
    if (orders.rateHertz != orders_.rateHertz) {
        paced_ = timeOf(step_);
        step_ = 0;
    }
    if (orders.held != orders_.held) held_.emplace_back(now, orders.held);
    while (held_.size() > 1 && held_[1].first < now - kRemembered) held_.pop_front();
    if (orders.jumps != orders_.jumps) jumping_ = kSpoiled;
    if (orders.notNumbers != orders_.notNumbers) lacking_ = kSpoiled;
    orders_ = orders;
}

void SimulatedBody::setRoom(std::shared_ptr<const Installation> room) { room_ = std::move(room); }

Pose SimulatedBody::path(double seconds) const {
    const double reach = name_ == "device" ? 0.05 : 0.2;
    const glm::dvec3 way(std::sin(0.7 * seconds), 0.3 * std::sin(0.5 * seconds), 0.6 * std::sin(1.1 * seconds + 1.0));
    return {placeOf(name_) + reach * way, glm::angleAxis(0.3 * std::sin(0.6 * seconds), glm::dvec3(0, 1, 0))};
}

Pose SimulatedBody::truth(Microseconds time) const {
    auto last = std::find_if(held_.rbegin(), held_.rend(), [&](const auto& one) { return one.first <= time; });
    const std::optional<Pose>& held = last == held_.rend() ? held_.front().second : last->second;
    return held.value_or(path(1e-6 * static_cast<double>((time - start_).count())));
}

/// As the tracker has it in its own world, older than it knows.
Pose SimulatedBody::reported(Microseconds time) const {
    if (!room_) return truth(time);
    return trackedOf(*room_, role_, truth(time - Microseconds(std::llround(1e6 * room_->trackerSeconds))));
}

Microseconds SimulatedBody::timeOf(std::uint64_t step) const {
    return paced_ + Microseconds(std::llround(1e6 * static_cast<double>(step) / orders_.rateHertz));
}

void SimulatedBody::spoil(TrackedBody& body) {
    if (jumping_ > 0) {
        --jumping_;
        body.pose.position.x += kJump;
    }
    if (lacking_ > 0) {
        --lacking_;
        body.pose.position.y = std::numeric_limits<double>::quiet_NaN();
    }
}

void SimulatedBody::advance(Microseconds now, const std::function<void(const TrackerFrame&)>& onFrame) {
    const Microseconds late(std::llround(1e3 * orders_.latencyMilliseconds));
    const Microseconds oldest = now - late - kLongestPause - paced_;
    if (oldest.count() > 0) {
        const auto least = static_cast<std::uint64_t>(1e-6 * static_cast<double>(oldest.count()) * orders_.rateHertz);
        frames_ += least - std::min(least, step_);
        step_ = std::max(step_, least);
    }
    std::normal_distribution<double> noise(0.0, 1e-3 * orders_.noiseMillimetres);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (; timeOf(step_) + late <= now; ++step_, ++frames_) {
        const bool dropped = chance(random_) < orders_.dropShare;
        TrackedBody& body = frame_.bodies.front();
        body.pose = reported(timeOf(step_));
        body.valid = !orders_.hidden;
        if (orders_.noiseMillimetres > 0.0)
            for (int axis = 0; axis < 3; ++axis) body.pose.position[axis] += noise(random_);
        if (dropped) continue;
        spoil(body);
        frame_.number = frames_;
        frame_.measured = timeOf(step_);
        frame_.arrived = frame_.measured + late;
        onFrame(frame_);
    }
}

} // namespace lumorph
