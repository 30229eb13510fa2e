#pragma once

#include <string>

#include "devices/controllers/device_profile.h"

namespace lumorph {

/// The file channels.h of the sketch in devices/firmware/tablet for this profile: a servo's channel is the Pro Mini's
/// pin (2 to 13, A1 to A5 as 15 to 19), its limits are rounded inwards to whole microseconds, and the baud rate is the
/// address's (57600 where it names none, 9600 for Bluetooth, as its modules are sold).
/// Throws InvalidInput that names the servo: none or more than 12, two on one pin, a pin that servos cannot have,
/// limits beyond 500 to 2500 us or the wrong way round; or an address or a baud rate that the board cannot have.
[[nodiscard]] std::string channelsHeader(const DeviceProfile& profile);

} // namespace lumorph
