#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <QString>

#include "app/studio/base/settings.h"
#include "calibration/decode/calibration_board.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph::studio {

/// Where the pictures of a calibration come from.
enum class CaptureWay {
    lab,
    folder,
    camera,
    crosshairs ///< no pictures: a person lays crosshairs onto points of the device (crosshair_service.h)
};
inline constexpr int kCaptureWays = 4;
/// Whether there is a camera to look through.
[[nodiscard]] constexpr bool isLive(CaptureWay way) noexcept {
    return way == CaptureWay::lab || way == CaptureWay::camera;
}

/// What a calibration is made with; lengths of the board in millimetres.
struct CalibrationSetup {
    CaptureWay way = CaptureWay::lab;
    CalibrationBoard board{CalibrationBoard::Kind::chess, 9, 7, 25.0, 0.0};
    cv::Size projector{1280, 800}; ///< of a folder; otherwise that of the installed projector
    std::string pattern = "graycode";
    std::filesystem::path order;  ///< of a folder: what each image shows, in place of `pattern`; empty: none
    std::filesystem::path folder; ///< one folder a pose; empty: not chosen yet
    std::string camera;           ///< "/dev/video0"; empty: not chosen yet
    std::size_t installed = 0;    ///< number of the room's projector that is calibrated
    int poses = 6;                ///< that are wanted
    std::filesystem::path saved;  ///< each calibration's poses are saved in a dated folder in here
    std::optional<Cause> fault;   ///< what goes wrong in the lab on purpose
    bool operator==(const CalibrationSetup&) const = default;
};

/// Whether its pictures are the virtual lab's, or those of a camera that another program poses as.
[[nodiscard]] bool isSimulatedWay(const CalibrationSetup& setup);

/// What was chosen last for this way, or what is usual.
[[nodiscard]] CalibrationSetup keptSetup(const Settings& settings, CaptureWay way);
/// Where poses are saved unless somebody chooses another folder: in the user's data.
[[nodiscard]] std::filesystem::path usualSaved();
/// The way that was chosen last.
[[nodiscard]] CaptureWay keptWay(const Settings& settings);
void keepSetup(Settings& settings, const CalibrationSetup& setup);

/// Poses that a camera photographed for what was chosen last, and that nobody used or threw away.
struct EarlierPoses {
    std::filesystem::path folder;
    int count = 0;
    QString when; ///< "yesterday, 17:12", of the last one
    bool operator==(const EarlierPoses&) const = default;
};
/// Nothing where there are none, or the disk has them no more.
[[nodiscard]] std::optional<EarlierPoses> earlierPoses(const Settings& settings);
[[nodiscard]] std::filesystem::path unfinishedFolder(const Settings& settings);
/// An empty folder: there are none.
void keepUnfinished(Settings& settings, const std::filesystem::path& folder);

/// "pose_1" is that of number 0.
[[nodiscard]] std::string nameOfPose(int number);
/// What the images of a pose show. Throws InvalidInput; DataError where the order file cannot be used.
[[nodiscard]] CaptureOrder orderOf(const CalibrationSetup& setup);
/// "Chessboard, 9 × 7 inner corners, squares of 25 mm".
[[nodiscard]] QString boardWords(const CalibrationBoard& board);
/// Why it cannot be used; empty where it can.
[[nodiscard]] QString problemOf(const CalibrationSetup& setup);

} // namespace lumorph::studio
