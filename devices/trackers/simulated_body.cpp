#include "devices/trackers/simulated_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph {

namespace {

constexpr Microseconds kLongestPause{1'000'000};
constexpr std::uint64_t kSeed = 20;

/// Where a head is before a table, the device on it, a hand above it; metres.
glm::dvec3 placeOf(const std::string& body) {
    if (body == "head") return {0.0, 0.45, 0.6};
    if (body == "pointer") return {0.2, 0.2, 0.1};
    return {0.0, 0.0, 0.0};
}

} // namespace

SimulatedBody::SimulatedBody(SimulatedBodyAddress address, Microseconds start)
    : address_(std::move(address)), start_(start), random_(kSeed) {
    frame_.bodies = {{1, address_.body, true, {}}};
}

Pose SimulatedBody::truth(double seconds) const {
    const double reach = address_.body == "device" ? 0.05 : 0.2;
    const glm::dvec3 way(std::sin(0.7 * seconds), 0.3 * std::sin(0.5 * seconds), 0.6 * std::sin(1.1 * seconds + 1.0));
    return {placeOf(address_.body) + reach * way, glm::angleAxis(0.3 * std::sin(0.6 * seconds), glm::dvec3(0, 1, 0))};
}

Microseconds SimulatedBody::timeOf(std::uint64_t number) const {
    return start_ + Microseconds(std::llround(1e6 * static_cast<double>(number) / address_.rateHertz));
}

void SimulatedBody::advance(Microseconds now, const std::function<void(const TrackerFrame&)>& onFrame) {
    const Microseconds late(std::llround(1e3 * address_.latencyMilliseconds));
    const Microseconds oldest = now - late - kLongestPause - start_;
    if (oldest.count() > 0)
        number_ = std::max(number_,
                           static_cast<std::uint64_t>(1e-6 * static_cast<double>(oldest.count()) * address_.rateHertz));
    std::normal_distribution<double> noise(0.0, 1e-3 * address_.noiseMillimetres);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (; timeOf(number_) + late <= now; ++number_) {
        const bool dropped = chance(random_) < address_.dropShare;
        TrackedBody& body = frame_.bodies.front();
        body.pose = truth(1e-6 * static_cast<double>((timeOf(number_) - start_).count()));
        if (address_.noiseMillimetres > 0.0)
            for (int axis = 0; axis < 3; ++axis) body.pose.position[axis] += noise(random_);
        if (dropped) continue;
        frame_.number = number_;
        frame_.measured = timeOf(number_);
        frame_.arrived = frame_.measured + late;
        onFrame(frame_);
    }
}

} // namespace lumorph
