#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// Splits a wish over the device's top into what servos carry and what light carries (R33). The smooth part is the
/// bounded least-squares fit of the wish by what the actuators do to the surface (reach in space), of the wish averaged
/// over a window of time around now, as long as their velocity limits need (reach in time).
class FrequencySplit {
public:
    /// Samples the rig's top surface on a grid of about `spacing` metres (coarser where that were more than 4000
    /// points). Costs tens of milliseconds. Throws InvalidInput for a spacing that is no finite number above zero.
    explicit FrequencySplit(const Rig& rig, double spacing = 0.006);
    ~FrequencySplit();
    FrequencySplit(FrequencySplit&&) noexcept;
    FrequencySplit& operator=(FrequencySplit&&) noexcept;

    /// Where heights are wanted: x and z of places over which the device at rest has a top, device metres. Heights are
    /// those of the uppermost surface over such a place, whatever part of the device lies there.
    [[nodiscard]] std::span<const glm::vec2> points() const noexcept;
    /// Height of the top at rest at those points, device metres.
    [[nodiscard]] std::span<const float> restHeights() const noexcept;

    /// Writes the wished height of the surface at `points()` at a time, device metres. It finds the heights at rest,
    /// which it may leave where it wishes nothing; NaN counts as rest.
    using Wish = std::function<void(double seconds, std::span<float> heights)>;

    /// Strokes that carry the slow, long part of the wish at a time; where the wish lies below what a device can do, 0.
    /// The wish is asked for at times around this one, whole multiples of one step. From call to call, with times that
    /// do not fall, no stroke moves faster than its actuator's velocity limit; an earlier time begins anew. Throws
    /// InvalidInput for a time beyond 1e9 seconds.
    [[nodiscard]] std::vector<double> strokes(const Wish& wish, double seconds);

    /// Begins anew: the next strokes may be anywhere.
    void restart() noexcept;

    /// Strokes that fit these heights best, whatever the time they need. Throws InvalidInput for another number of
    /// heights than of points.
    [[nodiscard]] std::vector<double> fit(std::span<const float> heights);

    /// Height of the surface at `points()` for these strokes, device metres: the deformed rig seen from above.
    void heights(std::span<const double> strokes, std::span<float> out) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
