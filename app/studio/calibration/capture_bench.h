#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "app/studio/calibration/calibration_setup.h"
#include "calibration/capture/pose_capture.h"
#include "calibration/solve/bundle.h"
#include "core/base/progress.h"
#include "core/scene/installation.h"

namespace lumorph::studio {

/// The outline of a board in the camera's picture: its corners in turn, camera pixels.
using BoardOutline = std::vector<cv::Point2d>;

/// Camera, projector and board of a calibration, wherever they are. Whoever uses it locks it, one thread at a time.
class CaptureBench {
public:
    virtual ~CaptureBench() = default;

    /// Photographs the board in the pose of this number under all patterns. Throws what `PoseCapture` throws.
    [[nodiscard]] virtual CapturedPose capture(int pose, const std::function<void(const Shot&)>& onShot,
                                               const Progress& progress) = 0;
    /// What the camera sees, the projector being white; 8-bit grey.
    [[nodiscard]] virtual cv::Mat look(const Progress& progress) = 0;
    /// Whether `look` sees other things by itself.
    [[nodiscard]] virtual bool isLive() const = 0;
    /// Where the board should be for the pose of this number. `lit`: where in the camera's picture the projector's
    /// light was seen; empty: not known.
    [[nodiscard]] virtual BoardOutline ghost(int pose, const cv::Rect& lit) const = 0;
    /// What is said of the board now; of another kind it is another bench's.
    virtual void setBoard(const CalibrationBoard& board) = 0;
    /// From now on this pose (the camera from the board, in its unit) is the one to take next; nothing: as planned.
    virtual void setWanted(const std::optional<PoseVector>& /*cameraFromBoard*/) {}
    /// Automatics of the camera that are still on, and what to do about them.
    [[nodiscard]] virtual std::vector<std::string> automatics() const { return {}; }
    /// Camera and projector as they truly are; null where nobody knows.
    [[nodiscard]] virtual const Installation* truth() const { return nullptr; }

    std::mutex mutex;
};

/// The virtual lab: a board before a projector that stands a little aside from where `room` has it. Takes a second or
/// two. Throws InvalidInput where the board does not fit.
[[nodiscard]] std::shared_ptr<CaptureBench> openLabBench(const CalibrationSetup& setup, const Installation& room,
                                                         const Progress& progress = {});

/// A camera of this machine, and whatever shows the patterns. Throws DeviceError with what to do.
[[nodiscard]] std::shared_ptr<CaptureBench> openCameraBench(const CalibrationSetup& setup, const CameraOpener& open,
                                                            std::shared_ptr<PatternDisplay> display,
                                                            const Progress& progress = {});

/// Outlines of poses that together tell a camera well: flat first, then tilted to all sides and spread over `area` of
/// the picture, in which they lie whole; as a camera of that focal length (pixels) would see them.
[[nodiscard]] BoardOutline guideOutline(const CalibrationBoard& board, const cv::Rect& area, double focal, int pose);

/// The four corners of the area that the board's points span, in the board's frame.
[[nodiscard]] std::vector<cv::Point3d> cornersOf(const CalibrationBoard& board);

} // namespace lumorph::studio
