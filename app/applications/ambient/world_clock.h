#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "app/applications/ambient/place.h"
#include "app/applications/visitor.h"

namespace lumorph::ambient {

/// The time that is shown. It runs fast, a visitor makes it run faster or back, and while nobody is there each night
/// leads to the next day that is worth seeing.
class WorldClock {
public:
    static constexpr double kScrub = 8.0; ///< times as fast while a visitor holds left or right

    /// `days` are local midnights, at least one; `daySeconds` is how long a day takes, 86400 for the world's own time.
    /// With `now`, UTC, it shows that time and leaves it only while a visitor is there.
    WorldClock(const Place& place, std::vector<double> days, double begin, double daySeconds,
               std::function<double()> now = {});

    /// A step of the show's time, seconds.
    void advance(double step, const Visitor& visitor);
    /// Other days and another beginning, of a later forecast. The time that is shown stays where it lies among them;
    /// else it goes to the first of them.
    void setDays(std::vector<double> days, double begin);
    [[nodiscard]] double utc() const noexcept { return utc_; }
    /// Seconds of the world in one of the show, now; negative while it runs back.
    [[nodiscard]] double speed() const noexcept { return speed_; }

private:
    void goToNextDay(double hour);
    void returnToNow(double step);

    Place place_;
    std::vector<double> days_;
    std::function<double()> now_;
    double begin_, utc_;
    double usualSpeed_, speed_;
    std::size_t day_ = 0; ///< of `days_`: the one that was gone to last
};

} // namespace lumorph::ambient
