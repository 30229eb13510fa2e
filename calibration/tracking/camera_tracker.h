#pragma once

#include <functional>
#include <memory>
#include <string>

#include "calibration/tracking/board_finder.h"

namespace lumorph {

struct CameraTrackerOptions {
    std::string source; ///< "0" or "/dev/video0" for a webcam, or a video file
    MarkerBoard board;
    CalibratedCamera camera; ///< intrinsics at the size of its pictures, and where it stands
    Pose deviceFromBoard;
    bool repeat = false; ///< a file begins anew at its end
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
    std::function<void(const PoseSample&)> onPose; ///< in the tracker's thread, for every picture; must return at once
};

struct CameraTrackerStatus {
    bool open = false;
    bool ended = false; ///< a file came to its end
    std::uint64_t pictures = 0;
    double picturesPerSecond = 0.0;
    std::optional<BoardSighting> sighting; ///< in the newest picture
    double foundShare = 0.0;               ///< of the last hundred pictures
    std::string advice;                    ///< what keeps it from seeing the board; empty while all is well
};

/// A camera that sees a marker board fixed to the device, in a thread of its own. For those without a motion capture
/// system.
class CameraTracker {
public:
    /// Throws as BoardFinder; a camera that cannot be opened is told by `status` and tried again every second.
    explicit CameraTracker(CameraTrackerOptions options);
    ~CameraTracker();
    [[nodiscard]] CameraTrackerStatus status() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
