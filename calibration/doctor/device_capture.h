#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/patterns/capture_order.h"
#include "calibration/solve/device_calibration.h"
#include "core/base/progress.h"

namespace lumorph {

/// A projector, by the name of its folders, and what the images of its patterns show.
struct NamedOrder {
    std::string name;
    CaptureOrder order;
};

/// What a capture of the device says of it.
struct DeviceCapture {
    std::vector<DeviceShot> shots;
    std::vector<NamedDevice> cameras;
    std::vector<Finding> warnings;
};

/// Name of the table in a capture's folder that says how the actuators stood: a line a shot, its folder and a stroke in
/// [0, 1] for each actuator, separated by commas; a first line that begins with `shot` names the columns.
inline constexpr const char* kStatesFile = "states.csv";

/// Reads a capture of the device: a folder a shot. With one projector, images may lie in it; else it has a folder a
/// camera, and that a folder a projector with images. Shots are in the order of the table. Throws DataError with file,
/// line and remedy where table and folders do not agree, CaptureRefused for images that cannot be trusted, Cancelled.
[[nodiscard]] DeviceCapture readDeviceCapture(const std::filesystem::path& folder, std::size_t actuators,
                                              const std::vector<NamedOrder>& projectors, const Progress& progress = {});

} // namespace lumorph
