#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "calibration/tracking/board_address.h"
#include "core/base/clock.h"
#include "core/base/image.h"

namespace lumorph {

/// What one picture told of the body to which the board is fixed.
struct BoardPicture {
    std::uint64_t number = 0;
    Microseconds seen{0};     ///< when the camera took it, as well as that is known
    std::optional<Pose> pose; ///< in the world; empty where the board is not to be seen
};

struct CameraTrackerOptions {
    BoardAddress address;
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
    std::function<void(const BoardPicture&)> onPicture; ///< in the tracker's thread; must return at once
};

struct CameraTrackerStatus {
    bool open = false;
    bool ended = false; ///< a file came to its end
    glm::ivec2 size{0}; ///< of its pictures
    std::uint64_t pictures = 0;
    double picturesPerSecond = 0.0;
    std::optional<BoardSighting> sighting; ///< in the newest picture
    double foundShare = 0.0;               ///< of the last hundred pictures
    std::string assumptions;               ///< what lens and place are taken for; a sentence or two
    std::string advice;                    ///< what keeps it from seeing the board; empty while all is well
    std::shared_ptr<const Image> preview;  ///< a few times a second, while somebody asks for the status; null at first
};

/// A camera, or a video in its place, that sees a marker board fixed to a body; in a thread of its own. For those
/// without a motion capture system.
class CameraTracker {
public:
    /// Throws as checkBoard; a camera that cannot be opened is told by `status` and tried again every second.
    explicit CameraTracker(CameraTrackerOptions options);
    ~CameraTracker();
    [[nodiscard]] CameraTrackerStatus status() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
