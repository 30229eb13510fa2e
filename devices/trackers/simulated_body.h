#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <utility>

#include "devices/trackers/simulated_orders.h"
#include "devices/trackers/tracker.h"
#include "devices/trackers/tracker_address.h"

namespace lumorph {

[[nodiscard]] SimulatedOrders ordersOf(const SimulatedBodyAddress& address);

/// A body on a slow path of its own, or where a person holds it, as a tracker sees it: with noise, late, and not every
/// time. The same at every run.
class SimulatedBody {
public:
    SimulatedBody(const SimulatedBodyAddress& address, Microseconds start);

    /// From `now` on.
    void order(const SimulatedOrders& orders, Microseconds now);
    /// The room in which it truly moves, as SimulatedSteering::room has it.
    void setRoom(std::shared_ptr<const Installation> room);
    /// Hands over all frames that have arrived by `now`, oldest first; after a pause at most those of a second.
    void advance(Microseconds now, const std::function<void(const TrackerFrame&)>& onFrame);
    /// Where it is on its own way, so many seconds after the start: within 0.3 m of its place, never faster than 0.5
    /// m/s.
    [[nodiscard]] Pose path(double seconds) const;
    /// Where what the body stands for truly was in the room at a time of the last second or so.
    [[nodiscard]] Pose truth(Microseconds time) const;

private:
    [[nodiscard]] Microseconds timeOf(std::uint64_t step) const;
    void spoil(TrackedBody& body);
    [[nodiscard]] Pose reported(Microseconds time) const;

    std::string name_;
    PoseRole role_;
    std::shared_ptr<const Installation> room_; ///< null: the tracker's world
    SimulatedOrders orders_;
    Microseconds start_;
    Microseconds paced_;                                            ///< since when frames come at this rate
    std::uint64_t step_ = 0;                                        ///< of the next frame, since then
    std::uint64_t frames_ = 0;                                      ///< number of the next frame
    std::deque<std::pair<Microseconds, std::optional<Pose>>> held_; ///< since when; the newest last
    int jumping_ = 0, lacking_ = 0;                                 ///< frames still to spoil
    std::mt19937_64 random_;
    TrackerFrame frame_;
};

} // namespace lumorph
