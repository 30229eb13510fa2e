#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// The device photographed in the lab in place of a board: at rest, and with each actuator raised by itself.
struct DeviceLabCapture {
    Installation room; ///< its first projector and camera are the true ones
    std::string pattern = "graycode";
    std::uint32_t seed = 1; ///< other noise for another number
};

/// Writes the capture as `readDeviceCapture` reads it: a folder a shot, `states.csv`, and `truth.json`, whose R and T
/// take the device's frame to camera and projector. All of it appears at once, at the end, or nothing. Throws
/// InvalidInput for a room without a projector or camera, a pattern that is none, a device that the projector does not
/// light, or a folder that holds something; DeviceError where the disk refuses; Cancelled.
void writeDeviceLabCapture(const DeviceLabCapture& capture, const Rig& rig, const std::filesystem::path& folder,
                           const Progress& progress = {});

} // namespace lumorph
