#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/capture/capture_camera.h"
#include "calibration/capture/pattern_display.h"
#include "calibration/doctor/boards_capture.h"
#include "core/base/clock.h"

namespace lumorph {

/// A camera and projectors at a table, before which somebody lays a board in one place after the other.
struct BoardsAtTable {
    CaptureCamera* camera = nullptr;
    std::string cameraName = "Camera";
    struct Projector {
        std::string name;
        PatternDisplay* display = nullptr;
    };
    std::vector<Projector> projectors;  ///< those that are on
    std::string board = "chess:9x7:25"; ///< millimetres
    std::string pattern = "graycode";
    int poses = 7;
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
};

/// Photographs a board in so many poses under each projector's patterns. What is to be done stands in the progress:
/// first it is laid flat on the table, then tilted to one side after the other. That it lies in a new place and at rest
/// is seen by itself. A pose that is refused (the board moved) is taken again from another place; the third refusal in
/// a row throws CaptureRefused. Throws what camera and displays throw; Cancelled.
[[nodiscard]] BoardsCapture captureBoards(const BoardsAtTable& table, const Progress& progress = {});

} // namespace lumorph
