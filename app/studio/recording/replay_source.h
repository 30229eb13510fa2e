#pragma once

#include <memory>
#include <mutex>

#include "app/recording/recording.h"
#include "core/loop/frame_source.h"
#include "core/loop/match_frame.h"

namespace lumorph::studio {

/// Shows the frames of a recording at its user's pace: what a frame says is what its row says, whenever it is shown.
/// STOP holds its time. Any thread.
class ReplaySource : public FrameSource {
public:
    /// The recording has a frame.
    explicit ReplaySource(std::shared_ptr<const Recording> recording);

    /// Rows of another rig than the wish's are left out; throws InvalidInput where the first is one.
    [[nodiscard]] std::shared_ptr<const MatchFrame> frame(const MatchWish& wish, Microseconds now) override;
    [[nodiscard]] bool moves() const override;

    /// From the beginning where it has come to its end.
    void play();
    void pause();
    void seek(double seconds);
    void setSpeed(double times); ///< 0.05 to 20
    [[nodiscard]] bool playing() const;
    [[nodiscard]] double position() const; ///< seconds
    [[nodiscard]] double speed() const;
    [[nodiscard]] double duration() const noexcept { return duration_; }

private:
    void pass(bool stopped, Microseconds now);

    const std::shared_ptr<const Recording> recording_;
    const double duration_;
    mutable std::mutex mutex_; ///< guards what follows
    bool playing_ = false;
    double speed_ = 1.0;
    double position_ = 0.0;
    std::optional<Microseconds> last_; ///< when time was passed on
    const FrameRow* row_ = nullptr;    ///< that `shown_` is of
    std::shared_ptr<const MatchFrame> shown_;
};

} // namespace lumorph::studio
