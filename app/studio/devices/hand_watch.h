#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "core/loop/match_frame.h"
#include "core/loop/pose_stream.h"
#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// What is known of hands at the device.
struct HandSense {
    std::optional<double> distance; ///< metres of the nearest tracked one; empty: none is seen
    bool near = false;
    std::vector<std::size_t> held; ///< servos that do not follow
    bool feels = false;            ///< the board reads where its servos are
    bool operator==(const HandSense&) const = default;
};

/// What there is to tell of a change, while servos are driven.
[[nodiscard]] std::vector<LinkEvent> handEvents(const HandSense& before, const HandSense& after, Microseconds now);

/// Whether a tracked hand is near the device. Near hands stay near for a moment after they were seen to be, and for
/// longer where the tracker lost them there. Any thread.
class HandWatch {
public:
    static constexpr Microseconds kAwayFor{500'000}; ///< that long must a hand be seen away
    static constexpr Microseconds kLostFor{
        2'000'000};                         ///< that long a hand that was near counts when it is seen no more
    static constexpr double kMargin = 0.02; ///< metres beyond the limit that a near hand must leave by

    /// Who sees hands; null: nobody.
    void setPoses(std::shared_ptr<const PoseBoard> poses);
    /// Metres to the device's box at which a hand is near; 0: no hand ever is.
    void setLimit(double metres);
    /// Where the device and its trackers are, and how large it is right now.
    void follow(const MatchFrame& frame);
    /// Whether a hand is near `now`, by the clock of the poses.
    [[nodiscard]] bool look(Microseconds now);
    /// Metres, as `look` found it; empty where no hand is seen.
    [[nodiscard]] std::optional<double> distance() const;
    [[nodiscard]] bool near() const;

private:
    mutable std::mutex mutex_;
    std::shared_ptr<const PoseBoard> poses_;
    std::shared_ptr<const std::vector<glm::vec3>> measured_; ///< what `box_` is of
    Box box_;
    glm::mat4 worldFromDevice_{1.0F};
    std::shared_ptr<const Installation> installation_ = std::make_shared<const Installation>();
    double limit_ = 0.1;
    std::optional<double> distance_;
    bool near_ = false;
    Microseconds nearAt_{0};
};

} // namespace lumorph::studio
