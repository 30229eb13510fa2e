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
    /// Samples the rig's top surface on a grid of about `spacing` metres. Costs milliseconds.
    explicit FrequencySplit(const Rig& rig, double spacing = 0.006);
    ~FrequencySplit();
    FrequencySplit(FrequencySplit&&) noexcept;
    FrequencySplit& operator=(FrequencySplit&&) noexcept;

    /// Where heights are wanted: x and z of the top surface at rest, device metres.
    [[nodiscard]] std::span<const glm::vec2> points() const noexcept;
    /// Height of the top at rest at those points, device metres.
    [[nodiscard]] std::span<const float> restHeights() const noexcept;

    /// Writes the wished height of the surface at `points()` at a time, device metres.
    using Wish = std::function<void(double seconds, std::span<float> heights)>;

    /// Strokes that carry the slow, long part of the wish at a time; where the wish lies below what a device can do, 0.
    /// What they ask for never moves faster than the rig's velocity limits.
    [[nodiscard]] std::vector<double> strokes(const Wish& wish, double seconds);

    /// Height of the surface at `points()` for these strokes, device metres: the model of the fit, and the estimated
    /// physical state.
    void heights(std::span<const double> strokes, std::span<float> out) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
