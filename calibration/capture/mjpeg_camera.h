#pragma once

#include <memory>
#include <string>

#include "calibration/capture/capture_camera.h"

namespace lumorph {

/// Whether a camera's address is one of MJPEG over HTTP: "http://192.168.0.7:8080/video".
[[nodiscard]] bool isMjpegAddress(const std::string& address);

/// A telephone or network camera that sends MJPEG over HTTP (multipart/x-mixed-replace), with "user:password@" before
/// the host where it asks for that. A thread of its own reads all that comes and keeps the newest picture; after an
/// interruption it connects anew. Such cameras say neither when a picture was taken nor let their exposure be set, and
/// send late: a picture counts as taken after a call where its first byte comes 0.4 s after the call or later. Throws
/// DeviceError for an address that is none; where nobody answers the first picture does.
[[nodiscard]] std::unique_ptr<CaptureCamera> openMjpegCamera(const std::string& address);

} // namespace lumorph
