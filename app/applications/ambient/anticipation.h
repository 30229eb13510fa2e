#pragma once

#include <deque>

#include "app/applications/ambient/sea.h"

namespace lumorph::ambient {

/// A change is seen first and felt a set time later (R38): what light shows is noted, and servos are given what was.
class Anticipation {
public:
    /// Throws InvalidInput unless 0 to 60 seconds.
    explicit Anticipation(double delay);

    /// What light shows now; times do not fall.
    void note(double seconds, const SeaState& shown);
    /// What servos are to follow at the time of the last note: what was shown `delay` seconds before it, or first.
    [[nodiscard]] SeaState followed() const noexcept;
    [[nodiscard]] double delay() const noexcept { return delay_; } ///< seconds

private:
    struct Note {
        double seconds;
        SeaState state;
    };
    double delay_;
    std::deque<Note> notes_; ///< the first is the newest that is old enough, where one is
};

/// From one state to another, the wind by the shorter way around.
[[nodiscard]] SeaState between(const SeaState& from, const SeaState& to, double share) noexcept;

} // namespace lumorph::ambient
