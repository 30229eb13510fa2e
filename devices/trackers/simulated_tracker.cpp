#include <algorithm>
#include <cmath>
#include <utility>

#include "devices/trackers/simulated_body.h"
#include "devices/trackers/tracker_thread.h"

namespace lumorph {

namespace {

class SimulatedWork final : public TrackerWork {
public:
    SimulatedWork(const SimulatedBodyAddress& address, std::shared_ptr<TrackerLog> log, TrackerOptions options)
        : body_(address, options.clock->now()), log_(std::move(log)), options_(std::move(options)) {
        log_->setSource("a simulated " + address.body, true);
    }

    void tick() override {
        body_.advance(options_.clock->now(), [this](const TrackerFrame& frame) {
            log_->notePacket();
            log_->noteFrame(frame, 1e-3 * static_cast<double>((frame.arrived - frame.measured).count()));
            if (options_.onFrame) options_.onFrame(frame);
        });
    }

private:
    SimulatedBody body_;
    std::shared_ptr<TrackerLog> log_;
    TrackerOptions options_;
};

} // namespace

std::unique_ptr<Tracker> openSimulated(const SimulatedBodyAddress& address, const std::string& uri,
                                       TrackerOptions options) {
    auto log = std::make_shared<TrackerLog>(uri, options.clock);
    const std::chrono::milliseconds step(std::max(1L, std::lround(1000.0 / address.rateHertz)));
    return std::make_unique<TrackerThread>(
        log, [=] { return std::make_unique<SimulatedWork>(address, log, options); }, step);
}

} // namespace lumorph
