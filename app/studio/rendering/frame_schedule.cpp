#include "app/studio/rendering/frame_schedule.h"

#include <algorithm>

#include "core/base/statistics.h"

namespace lumorph::studio {
namespace {

constexpr double kStep = 0.92; // of a side; about 0.85 of the pixels
constexpr std::size_t kRememberedFrames = 5;

} // namespace

void FrameSchedule::request(int viewport, FrameRequest request, Time now) {
    Slot& slot = slots_[viewport];
    slot.still = request.refine;
    slot.request = std::move(request);
    slot.serial = ++serial_;
    slot.asked = now;
    slot.moving = true;
}

void FrameSchedule::forget(int viewport) { slots_.erase(viewport); }

std::optional<FrameSchedule::Work> FrameSchedule::next(Time now) {
    const auto take = [&](bool Slot::*wanted, ViewportQuality quality) -> std::optional<Work> {
        // In turn: first those after the one served last.
        for (const bool after : {true, false})
            for (auto& [viewport, slot] : slots_) {
                if ((viewport > last_) != after || !(slot.*wanted)) continue;
                if (quality == ViewportQuality::still && now < slot.asked + kQuiet) continue;
                slot.*wanted = false;
                last_ = viewport;
                const double resolution = quality == ViewportQuality::moving ? slot.resolution : 1.0;
                return Work{viewport, slot.request, quality, resolution, slot.serial};
            }
        return std::nullopt;
    };
    if (auto work = take(&Slot::moving, ViewportQuality::moving)) return work;
    return take(&Slot::still, ViewportQuality::still);
}

std::optional<FrameSchedule::Time> FrameSchedule::nextAt() const {
    std::optional<Time> soonest;
    for (const auto& [viewport, slot] : slots_) {
        if (!slot.moving && !slot.still) continue;
        const Time at = slot.moving ? slot.asked : slot.asked + kQuiet;
        if (!soonest || at < *soonest) soonest = at;
    }
    return soonest;
}

bool FrameSchedule::pressing() const {
    return std::any_of(slots_.begin(), slots_.end(), [](const auto& entry) { return entry.second.moving; });
}

void FrameSchedule::finished(const Work& work, double milliseconds) {
    const auto found = slots_.find(work.viewport);
    if (found == slots_.end() || work.quality != ViewportQuality::moving) return;
    if (work.resolution == found->second.resolution) adapt(found->second, milliseconds);
}

void FrameSchedule::givenUp(const Work& work) {
    const auto found = slots_.find(work.viewport);
    if (found != slots_.end() && found->second.serial == work.serial) found->second.still = true;
}

void FrameSchedule::adapt(Slot& slot, double milliseconds) {
    slot.times.push_back(milliseconds);
    if (slot.times.size() > kRememberedFrames) slot.times.erase(slot.times.begin());
    if (slot.times.size() < kRememberedFrames) return;
    const double usual = median(slot.times);
    double wanted = slot.resolution;
    // Upwards only when the larger frame will surely be in time, so that it does not swing.
    if (usual > kBudgetMilliseconds)
        wanted = std::max(kLowestResolution, slot.resolution * kStep);
    else if (usual < 0.92 * kBudgetMilliseconds * kStep * kStep)
        wanted = std::min(1.0, slot.resolution / kStep);
    if (wanted == slot.resolution) return;
    slot.resolution = wanted;
    slot.times.clear();
}

} // namespace lumorph::studio
