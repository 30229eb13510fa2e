#pragma once

#include <functional>
#include <memory>
#include <string>

#include <QString>

#include "app/studio/devices/device_service.h"
#include "calibration/capture/capture_camera.h"
#include "calibration/capture/pattern_display.h"
#include "calibration/stages/bench.h"
#include "core/base/clock.h"
#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph::studio {

/// The device on the table, the room's first camera and its projectors' windows.
struct TableParts {
    DeviceService* devices = nullptr;
    /// In the window's thread.
    std::function<std::unique_ptr<PatternDisplay>(std::size_t projector)> openDisplay;
    /// In the thread that measures; the address is the room's, such as "/dev/video0".
    CameraOpener openCamera;
    /// By which pictures take time to be seen.
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
    std::string board = "chess:9x7:25"; ///< the printed board, millimetres
    /// Seconds from a frame of the show to its picture in a projector's window, of late; 0: nothing was shown yet.
    std::function<double()> drawSeconds = [] { return 0.0; };
};

/// Why nothing can be measured with what is connected, in a sentence with what to do; empty: it can.
/// `isMoved`: servos are needed too.
[[nodiscard]] QString tableObstacle(const Installation& room, const DeviceService& devices, bool isMoved = true);

/// The room with its device where the tracker sees it lie: the mean of a time in which it lay still, for which this
/// waits. Not the pose that the show is drawn for, which is predicted. Throws DeviceError where it is out of sight or
/// does not come to rest; Cancelled.
[[nodiscard]] Installation withRestingDevice(Installation room, const PoseBoard& poses, const Progress& progress);

/// Made in the window's thread, used and let go of in any. Servos go slowly where they are told, by the service's own
/// test of servos and so through the guard of their link; they go back to the show when the bench is gone. Throws
/// DeviceError where a projector's window cannot show patterns, or for what `tableObstacle` says.
[[nodiscard]] std::shared_ptr<Bench> openTable(const TableParts& parts, const Installation& room, bool isMoved = true);

} // namespace lumorph::studio
