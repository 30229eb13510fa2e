#pragma once

#include "devices/controllers/device_profile.h"

namespace lumorph::firmware_test {

/// Twelve servos on pins of all three ports, some at their widest limits, some narrow.
DeviceProfile twelveServos();
/// As in the header that the sketch has of its own.
DeviceProfile sixServos();

} // namespace lumorph::firmware_test
