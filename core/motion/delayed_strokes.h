#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace lumorph {

/// Strokes as they are some time after they were told, for each actuator another time: the dead time between a command
/// and its motion. Between two steps they go straight. An actuator without a delay is at once where it is told.
class DelayedStrokes {
public:
    /// Seconds, 0 or more, one an actuator; actuators beyond them have none.
    void setDelays(std::vector<double> seconds);
    /// All of them are there, and nothing is on its way.
    void standAt(std::span<const double> strokes);
    /// `seconds` have passed since the last step, and now they are told this.
    void step(std::span<const double> told, double seconds);
    /// Other actuators: each goes on as the one before at its place, or where it has none as one that rests at 0.
    void rearrange(std::span<const std::optional<std::size_t>> places);

    [[nodiscard]] std::span<const double> strokes() const noexcept { return now_; }
    /// Nothing is on its way: without another word they stay where they are.
    [[nodiscard]] bool stand() const noexcept;

private:
    struct Told {
        double seconds = 0.0; ///< since the one before
        std::vector<double> strokes;
    };
    [[nodiscard]] double strokeOf(std::size_t actuator) const noexcept;

    std::vector<double> delays_;
    double longest_ = 0.0;
    std::deque<Told> told_; ///< the newest last
    std::vector<double> now_;
};

} // namespace lumorph
