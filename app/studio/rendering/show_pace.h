#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/studio/rendering/show_request.h"

namespace lumorph::studio {

/// When to draw the show, and how finely: the newest request at once, as coarsely as the time it takes demands; then,
/// when there was quiet for a while, the same in full. Not thread-safe; the time is given.
class ShowPace {
public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr std::chrono::milliseconds kQuiet{140};
    /// A moving frame may take this long: 15 a second, with some room for what else is drawn.
    static constexpr double kBudgetMilliseconds = 58.0;
    static constexpr double kLowestResolution = 0.5;

    struct Work {
        ShowRequest request;
        bool still = false;
        double resolution = 1.0; ///< of each side
    };

    void request(ShowRequest request, Time now);
    void forget() { request_.reset(); }

    /// A request waits for its first picture.
    [[nodiscard]] bool pressing() const noexcept { return request_ && moving_; }
    /// Takes what waits for its first picture.
    [[nodiscard]] std::optional<Work> nextMoving();
    /// Takes what is due in full.
    [[nodiscard]] std::optional<Work> nextStill(Time now);
    /// When `nextStill` will have something.
    [[nodiscard]] std::optional<Time> stillAt() const;
    /// A moving frame took this long, drawn at `resolution`.
    void finished(const Work& work, double milliseconds);

private:
    std::optional<ShowRequest> request_; ///< the newest; stays for the picture in full
    Time asked_;
    bool moving_ = false;
    bool still_ = false;
    double resolution_ = 1.0;
    std::vector<double> times_; ///< of the last moving frames at this resolution
};

} // namespace lumorph::studio
