#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/capture/device_bench.h"
#include "calibration/delays/delays_calibration.h"
#include "calibration/doctor/boards_capture.h"
#include "calibration/lab/registration_lab.h"
#include "calibration/light/light_bench.h"
#include "calibration/light/light_patches.h"
#include "calibration/servos/servo_plan.h"
#include "calibration/solve/device_calibration.h"
#include "calibration/stages/recording.h"

/// Private to calibration/stages: the tables that a stage is recorded in, and what they say, without its solver. A file
/// for the tables of each kind of stage, beside the file of its row. Whatever a recording holds, all that reads throws
/// DataError and nothing else.
namespace lumorph::stages {

/// Decoded light as a table of camera and projector pixels, with the number of the look as its first column.
inline const std::vector<std::string> kLightColumns{"look", "camera_column", "camera_row", "light_column", "light_row"};
/// To a hundredth of a pixel, far less than decoding strays: more digits are noise, and most of a recording's bytes.
[[nodiscard]] std::vector<ProjectorPoint> asRecorded(std::vector<ProjectorPoint> light);
void addLight(RecordedTable& table, std::size_t look, const std::vector<ProjectorPoint>& light);
/// By looks; exactly `looks`. Throws DataError for a number that is none of a look.
[[nodiscard]] std::vector<std::vector<ProjectorPoint>> lightOf(const RecordedTable& table, std::size_t looks);

/// A number of a table that counts something, less than `end`. Throws DataError.
[[nodiscard]] std::size_t indexIn(double number, std::size_t end, const char* what);

/// Cameras and projectors, with the size of their pictures.
inline const std::vector<std::string> kDeviceColumns{"projector", "width", "height"};
struct NamedDevices {
    std::vector<NamedDevice> cameras, projectors; ///< at least one of each
};
[[nodiscard]] NamedDevices namedDevicesOf(const RecordedTable& table, const std::string& place);

// Boards before projectors and cameras, or before a mirror (board_tables.cpp).

[[nodiscard]] StageRecording recordingOf(const BoardsCapture& capture, StageRecording recording);
[[nodiscard]] StageRecording recordingOf(const MirrorCapture& capture, StageRecording recording);

/// What both kinds of recording hold, by pose; at least four poses, a camera and a projector.
struct RecordedBoards : BoardsCapture {
    std::vector<BoardPoints> direct; ///< past the mirror by the first camera, by pose
    std::vector<bool> isCheck;       ///< by pose
};
[[nodiscard]] RecordedBoards boardsOf(const StageRecording& recording);

// Light on the device alone (device_tables.cpp).

/// Strokes of each shot, after whether it checks.
[[nodiscard]] std::vector<std::string> shotColumns(std::size_t actuators);

struct RecordedShots {
    NamedDevice camera;
    std::vector<NamedDevice> projectors;
    std::vector<DeviceShot> shots; ///< with the one that checks as the last
    bool hasCheck = false;
};
[[nodiscard]] RecordedShots shotsOf(const StageRecording& recording, std::size_t actuators);

// What a pointer's tip touched (touch_tables.cpp).

/// Points of the device that were touched, and light on it where the bench could have it.
struct DeviceTouches {
    LandmarkCapture capture;
    std::optional<LitDeviceCapture> lit;
};
[[nodiscard]] StageRecording recordingOf(const PointerCapture& capture, StageRecording recording);
[[nodiscard]] StageRecording recordingOf(const DotCapture& capture, StageRecording recording);
[[nodiscard]] StageRecording recordingOf(const DeviceTouches& touches, StageRecording recording);
[[nodiscard]] StageRecording recordingOf(const EyeCapture& capture, StageRecording recording);

[[nodiscard]] PointerCapture pointerOf(const StageRecording& recording);
/// Of a room with so many projectors.
[[nodiscard]] DotCapture dotsOf(const StageRecording& recording, std::size_t projectors);
[[nodiscard]] DeviceTouches deviceTouchesOf(const StageRecording& recording);
[[nodiscard]] EyeCapture eyeOf(const StageRecording& recording);

// Steps of servos, with the light that was seen in each (servo_tables.cpp).

[[nodiscard]] StageRecording recordingOf(const ServoPlan& plan, std::size_t actuators, const ServoPlanOptions& options,
                                         StageRecording recording);
[[nodiscard]] ServoPlan planOf(const StageRecording& recording, std::size_t actuators);
[[nodiscard]] ServoPlanOptions timingOf(const StageRecording& recording);
/// The light of each look. A measurement ends early where the wiring is wrong: fewer looks than the plan has steps.
[[nodiscard]] std::vector<std::vector<ProjectorPoint>> looksOf(const StageRecording& recording, const ServoPlan& plan);

// Delays (delays_tables.cpp).

[[nodiscard]] StageRecording recordingOf(const DelaysCapture& capture, StageRecording recording);
[[nodiscard]] DelaysCapture delaysOf(const StageRecording& recording);

// Photographs of flat light (light_tables.cpp).

/// Seconds of exposure, then red, green and blue of each projector.
[[nodiscard]] std::vector<std::string> photographColumns(std::size_t projectors);
[[nodiscard]] std::vector<double> rowOf(const LightShow& show, double seconds);
[[nodiscard]] std::string lightPictureName(std::size_t index);
inline const std::vector<std::string> kSheetColumns{"x", "y", "z"};
inline const std::vector<std::string> kRangeColumns{"shortest", "longest", "found", "photographs_before"};
/// A recording as a bench: what is asked for again is the next photograph of its kind. Refers to the recording.
[[nodiscard]] std::unique_ptr<LightBench> recordedLight(const StageRecording& recording, std::size_t projectors);
/// Of its photographs, which are all of one size.
[[nodiscard]] cv::Size photographSize(const StageRecording& recording);
/// Where the sheet of white paper lay; empty where there was none.
[[nodiscard]] std::optional<WhiteSheet> sheetOf(const StageRecording& recording);

// Stands of the device and photographs of patterns on it (check_tables.cpp).

inline const std::vector<std::string> kPassColumns{"stand", "projector", "pictures"};
[[nodiscard]] std::vector<std::string> standColumns(std::size_t actuators);
[[nodiscard]] std::string checkPictureName(std::size_t pass, std::size_t index);
/// A recording as a bench: each pass is the one that was photographed of that projector after that stand. Refers to the
/// recording.
[[nodiscard]] std::unique_ptr<DeviceBench> recordedDevice(const StageRecording& recording, std::size_t actuators);

} // namespace lumorph::stages
