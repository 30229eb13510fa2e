#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How well a simulated tracker sees its body, and where a person holds it.
struct SimulatedOrders {
    double noiseMillimetres = 0.0; ///< standard deviation, per axis
    double dropShare = 0.0;        ///< of the frames, in [0, 1]
    double latencyMilliseconds = 0.0;
    double rateHertz = 100.0;
    std::optional<Pose> held; ///< in the room, as SimulatedSteering::truth; empty: it goes its own way
    bool hidden = false;      ///< frames come, and the body is lost in them
    // Each one more spoils the next frames: the body is said to be elsewhere, or at no number.
    std::uint32_t jumps = 0;
    std::uint32_t notNumbers = 0;
    bool operator==(const SimulatedOrders&) const = default;
};

/// The hand on one simulated tracker while it runs. Any thread.
class SimulatedSteering {
public:
    [[nodiscard]] SimulatedOrders orders() const {
        const std::scoped_lock lock(mutex_);
        return orders_;
    }
    void order(const SimulatedOrders& orders) {
        const std::scoped_lock lock(mutex_);
        orders_ = orders;
    }
    /// The room in which the body truly moves: where its tracker's world lies, where the device, the tip or the eye is
    /// on the body, and by how much poses are older than the tracker says. Null: the tracker's world is the room's, and
    /// bodies are what they stand for.
    [[nodiscard]] std::shared_ptr<const Installation> room() const {
        const std::scoped_lock lock(mutex_);
        return room_;
    }
    void setRoom(std::shared_ptr<const Installation> room) {
        const std::scoped_lock lock(mutex_);
        room_ = std::move(room);
    }
    /// Where the device, the pointer's tip or the eye truly is in the room, without noise and latency; told by the
    /// tracker.
    [[nodiscard]] Pose truth() const {
        const std::scoped_lock lock(mutex_);
        return truth_;
    }
    void tellTruth(const Pose& truth) {
        const std::scoped_lock lock(mutex_);
        truth_ = truth;
    }

private:
    mutable std::mutex mutex_;
    SimulatedOrders orders_;
    std::shared_ptr<const Installation> room_;
    Pose truth_;
};

struct TrackerOptions;
class Tracker;
/// As openTracker for an address `sim://..`, whose words are the first orders; `steering` gets them, and may change
/// them from then on.
[[nodiscard]] std::unique_ptr<Tracker> openSteered(const std::string& uri, TrackerOptions options,
                                                   std::shared_ptr<SimulatedSteering> steering);

} // namespace lumorph
