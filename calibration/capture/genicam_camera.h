#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/capture/capture_camera.h"
#include "calibration/tracking/camera_source.h"

namespace lumorph {

/// Whether a camera's address is one of GenICam: "genicam://Basler-21438501", maker and serial number.
[[nodiscard]] bool isGenicamAddress(const std::string& address);

/// Industrial cameras on the network (GigE Vision) and at USB (USB3 Vision), by their addresses. Asks all networks,
/// which takes about a second.
[[nodiscard]] std::vector<CameraInfo> listGenicamCameras();

/// An industrial camera by Aravis: all pixels of its sensor, 8 bits where it has them, automatics switched off. A
/// picture counts as taken after a call by the camera's own time, less its exposure; one that lost packets is never
/// given. A camera that was unplugged is found again by maker and serial number. Throws DeviceError with what to do.
[[nodiscard]] std::unique_ptr<CaptureCamera> openGenicamCamera(const std::string& address);

} // namespace lumorph
