#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "core/base/error.h"
#include "devices/trackers/simulated_body.h"
#include "devices/trackers/tracker_thread.h"

namespace lumorph {

namespace {

bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class SimulatedWork final : public TrackerWork {
public:
    SimulatedWork(const SimulatedBodyAddress& address, std::shared_ptr<TrackerLog> log, TrackerOptions options,
                  std::shared_ptr<SimulatedSteering> steering)
        : body_(address, options.clock->now()), log_(std::move(log)), options_(std::move(options)),
          steering_(std::move(steering)) {
        log_->setSource("a simulated " + address.body, true);
    }

    void tick() override {
        const Microseconds now = options_.clock->now();
        const SimulatedOrders orders = steering_->orders();
        body_.order(orders, now);
        body_.setRoom(steering_->room());
        body_.advance(now, [this](const TrackerFrame& frame) { deliver(frame); });
        steering_->tellTruth(body_.truth(now));
        if (orders.dropShare >= 1.0)
            log_->setAdvice("Every frame is dropped, as it was ordered; lower the dropout.");
        else
            log_->setAdvice(orders.hidden ? "The body is hidden from the tracker, as it was ordered." : "");
    }

private:
    /// As real trackers do: what is no number is refused at the door.
    void deliver(const TrackerFrame& frame) {
        log_->notePacket();
        if (!isFinite(frame.bodies.front().pose.position))
            return log_->noteRejected("the position of " + frame.bodies.front().name + " is no number");
        log_->noteFrame(frame, 1e-3 * static_cast<double>((frame.arrived - frame.measured).count()));
        if (options_.onFrame) options_.onFrame(frame);
    }

    SimulatedBody body_;
    std::shared_ptr<TrackerLog> log_;
    TrackerOptions options_;
    std::shared_ptr<SimulatedSteering> steering_;
};

std::unique_ptr<Tracker> openWith(const SimulatedBodyAddress& address, const std::string& uri, TrackerOptions options,
                                  std::shared_ptr<SimulatedSteering> steering) {
    auto log = std::make_shared<TrackerLog>(uri, options.clock);
    steering->order(ordersOf(address));
    const std::chrono::milliseconds step(std::clamp(std::lround(1000.0 / address.rateHertz), 1L, 10L));
    return std::make_unique<TrackerThread>(
        log,
        [address, log, options = std::move(options), steering = std::move(steering)] {
            return std::make_unique<SimulatedWork>(address, log, options, steering);
        },
        step);
}

} // namespace

std::unique_ptr<Tracker> openSimulated(const SimulatedBodyAddress& address, const std::string& uri,
                                       TrackerOptions options) {
    return openWith(address, uri, std::move(options), std::make_shared<SimulatedSteering>());
}

std::unique_ptr<Tracker> openSteered(const std::string& uri, TrackerOptions options,
                                     std::shared_ptr<SimulatedSteering> steering) {
    const TrackerAddress address = parseTrackerAddress(uri);
    const auto* simulated = std::get_if<SimulatedBodyAddress>(&address);
    if (simulated == nullptr)
        throw InvalidInput("tracker address '" + uri + "'", "it is no simulated one", "write sim://head");
    return openWith(*simulated, uri, std::move(options), std::move(steering));
}

} // namespace lumorph
