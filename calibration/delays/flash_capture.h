#pragma once

#include "calibration/capture/capture_camera.h"
#include "calibration/capture/pattern_display.h"
#include "calibration/delays/flash_delay.h"
#include "core/base/clock.h"

namespace lumorph {

/// Flashes a projector `count` times at times that do not repeat, and records how bright the camera sees its light:
/// about half a second a flash. `drawSeconds` is by which a frame of the show is older than its picture when a
/// projector's window gets that: the flashes count from frames that would have come so early. The times of a camera
/// without a clock are those at which its pictures came, so that what they took to come is part of the delay.
///
/// Throws CaptureRefused: `flash_not_seen` where the camera does not see the projector's light; DeviceError, Cancelled.
[[nodiscard]] FlashRecording recordFlashes(CaptureCamera& camera, PatternDisplay& display, double drawSeconds,
                                           const Progress& progress, int count = 36);

} // namespace lumorph
