#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// The frequency split (R33) of a wish that nobody knows ahead, as an interactive program has it: heights come in frame
/// after frame, and only what has come counts. FrequencySplit looks as far into the future as into the past and so has
/// no lag; this one smooths by two equal first-order low-passes in a row, which lags behind.
///
/// The lag follows from the velocity limits: half the time that the slowest actuator takes for its whole stroke, and
/// never more than `kMostLag`. With a time constant of half the lag for each low-pass, a sudden wish for e/4 = 0.68
/// strokes becomes just as fast as that actuator may be; what is left of faster ways is cut by the limit itself.
class CausalSplit {
public:
    static constexpr double kMostLag = 1.0; ///< seconds

    /// Samples the rig's top surface as FrequencySplit does: costs tens of milliseconds, and throws as it does.
    explicit CausalSplit(const Rig& rig, double spacing = 0.006);
    ~CausalSplit();
    CausalSplit(CausalSplit&&) noexcept;
    CausalSplit& operator=(CausalSplit&&) noexcept;

    /// Where heights are wanted, and the height of the top at rest there: as of FrequencySplit; device metres.
    [[nodiscard]] std::span<const glm::vec2> points() const noexcept;
    [[nodiscard]] std::span<const float> restHeights() const noexcept;

    /// By how much the smoothed wish lies behind a wish that changes slowly, seconds. What is too fast for the
    /// actuators lags farther: after the wish has come to rest, by no more than the time they take for their whole
    /// stroke.
    [[nodiscard]] double lagSeconds() const noexcept;

    /// Strokes that carry the smooth part of the wish up to now. `heights` are wished at `points()` now, device metres;
    /// NaN counts as rest. `sinceLast` seconds have passed since the call before, in which the wish is taken to have
    /// changed evenly. No stroke moves faster than its actuator's velocity limit; the first call, and the first after
    /// `restart`, may go anywhere and takes the wish as one that has always been so. Throws InvalidInput for another
    /// number of heights than of points, and for a time that is negative or not finite.
    [[nodiscard]] std::vector<double> strokes(std::span<const float> heights, double sinceLast);

    /// Whether further calls with the last heights would change the strokes no more (within a micrometre of the wish).
    [[nodiscard]] bool atRest() const noexcept;

    /// Forgets what has come.
    void restart() noexcept;

    /// The wish as it is smoothed now, over rest at `points()`, metres: what the strokes fit, and what light need not
    /// add; empty before the first call.
    [[nodiscard]] std::span<const double> smoothed() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The lag that a rig's actuators give it, seconds: who knows the wish ahead can wish so much earlier.
[[nodiscard]] double causalLag(const Rig& rig) noexcept;

} // namespace lumorph
