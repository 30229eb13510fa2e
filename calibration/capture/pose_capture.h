#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/capture/capture_camera.h"
#include "calibration/capture/pattern_display.h"
#include "calibration/capture/shot_check.h"
#include "core/base/clock.h"

namespace lumorph {

/// How long a picture takes to be light that the camera sees completely, measured by switching white and black.
struct SettleTime {
    Microseconds delay{0}; ///< from `show` returning to when an exposure may begin
    int lateFrames = 0;    ///< frames after that which still showed something of the picture before
    int switches = 0;      ///< how many were watched
    double contrast = 0.0; ///< between black and white, grey levels
};

/// A shot as it comes.
struct Shot {
    int index = 0; ///< in the order
    int count = 0;
    cv::Mat image; ///< 8-bit grey
    std::string file;
};

struct PoseCaptureSettings {
    CaptureOrder order;
    std::optional<CalibrationBoard> board;   ///< that should be in sight
    std::function<void(const Shot&)> onShot; ///< in the capturing thread; must return at once
    bool isScalingChecked = true;            ///< before the first pose of a live camera
    Microseconds longestSettle{2'000'000};   ///< slower ones are refused
    int triesWhenLate = 1; ///< of a pose whose pictures come late, each after measuring anew how late they come
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
};

/// The images of one pose.
struct CapturedPose {
    std::string name;
    std::vector<cv::Mat> images;    ///< in the order; as far as they came where it was refused
    std::vector<std::string> files; ///< their names
    ShotFindings findings;
    cv::Mat evenLight; ///< the scene under even light, for showing; may be empty
    [[nodiscard]] bool isSound() const noexcept { return !findings.refusal; }
};

/// Photographs a board under all patterns of an order, one pose after the other. Camera and display outlive it; one
/// thread at a time.
class PoseCapture {
public:
    PoseCapture(CaptureCamera& camera, PatternDisplay& display, PoseCaptureSettings settings);

    /// Switches white and black and watches how long that takes to be seen; for recordings nothing is to be measured.
    /// The first `capture` does it by itself. Throws CaptureRefused where the camera sees no difference, or it takes
    /// longer than allowed; what the camera throws; Cancelled.
    const SettleTime& measureSettle(const Progress& progress = {});
    [[nodiscard]] const std::optional<SettleTime>& settle() const noexcept { return settle_; }

    /// The images of one pose, each checked as it comes: a refusal ends the pose at once and is told, not thrown; the
    /// screen is given back whatever happens. Throws what camera and display throw; Cancelled.
    [[nodiscard]] CapturedPose capture(const std::string& name, const Progress& progress = {});

private:
    [[nodiscard]] cv::Mat shoot(const cv::Mat& picture, const Progress& progress);
    [[nodiscard]] std::optional<Finding> scaling(const cv::Mat& white, const cv::Mat& black, const Progress& progress);
    [[nodiscard]] CapturedPose captureOnce(const std::string& name, const Progress& progress);
    void capturePatterns(CapturedPose& pose, const Progress& progress);

    CaptureCamera& camera_;
    PatternDisplay& display_;
    PoseCaptureSettings settings_;
    std::optional<SettleTime> settle_;
    std::optional<Finding> scalingWarning_;
    bool isScalingKnown_ = false;
};

/// Writes a pose as a folder of its name in `folder`, as `calibrateProcamFolder` reads it: whole or not at all, in
/// place of one of the same name. Throws DeviceError where the disk refuses, InvalidInput for a name that is no
/// folder's or a pose without images.
void savePose(const std::filesystem::path& folder, const CapturedPose& pose, const Progress& progress = {});

} // namespace lumorph
