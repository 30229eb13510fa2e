#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "devices/trackers/tracker.h"
#include "devices/trackers/tracker_address.h"

namespace lumorph {

/// A body on a slow path of its own, as a tracker sees it: with noise, late, and not every time. The same at every run.
class SimulatedBody {
public:
    SimulatedBody(SimulatedBodyAddress address, Microseconds start);

    /// Hands over all frames that have arrived by `now`, oldest first; after a pause at most those of a second.
    void advance(Microseconds now, const std::function<void(const TrackerFrame&)>& onFrame);
    /// Where the body truly is, so many seconds after the start: within 0.3 m of its place, never faster than 0.5 m/s.
    [[nodiscard]] Pose truth(double seconds) const;

private:
    [[nodiscard]] Microseconds timeOf(std::uint64_t number) const;

    SimulatedBodyAddress address_;
    Microseconds start_;
    std::uint64_t number_ = 0;
    std::mt19937_64 random_;
    TrackerFrame frame_;
};

} // namespace lumorph
