#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "app/studio/rendering/render_thread.h"
#include "core/render/viewport/viewport_renderer.h"

namespace lumorph::studio {

/// What to draw next, out of what the viewports ask for: the newest request of each at once and coarse, in turn among
/// viewports; then, when a viewport has been quiet for a while, the same in full quality. Frames that take too long are
/// drawn at a lower resolution until there is time again. Not thread-safe; the time is given.
class FrameSchedule {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// How long a viewport must be quiet before it is drawn in full quality.
    static constexpr std::chrono::milliseconds kQuiet{120};
    /// A moving frame may take this long; handing it over and painting it take the rest of a thirtieth of a second.
    static constexpr double kBudgetMilliseconds = 23.0;
    static constexpr double kLowestResolution = 0.35;

    struct Work {
        int viewport = 0;
        FrameRequest request;
        ViewportQuality quality = ViewportQuality::moving;
        double resolution = 1.0; ///< of each side
        std::uint64_t serial = 0;
    };

    void request(int viewport, FrameRequest request, Time now);
    void forget(int viewport);
    [[nodiscard]] bool knows(int viewport) const { return slots_.contains(viewport); }

    /// Takes the most urgent work; empty when nothing is to be drawn now.
    [[nodiscard]] std::optional<Work> next(Time now);
    /// When `next` will have something without a new request.
    [[nodiscard]] std::optional<Time> nextAt() const;
    /// A request waits for its first frame: a frame in full quality is given up for it.
    [[nodiscard]] bool pressing() const;

    /// The work was drawn in this time.
    void finished(const Work& work, double milliseconds);
    /// The frame in full quality was given up; it comes again later.
    void givenUp(const Work& work);

private:
    struct Slot {
        FrameRequest request;
        std::uint64_t serial = 0;
        Time asked;
        bool moving = false; ///< waits for its first frame
        bool still = false;  ///< waits to be drawn in full quality
        double resolution = 1.0;
        std::vector<double> times; ///< of the last moving frames at this resolution
    };
    static void adapt(Slot& slot, double milliseconds);

    std::map<int, Slot> slots_;
    int last_ = 0; ///< viewport served last
    std::uint64_t serial_ = 0;
};

} // namespace lumorph::studio
