#pragma once

#include <optional>
#include <string>

#include "devices/controllers/device_profile.h"
#include "devices/firmware/board_sequence.h"

namespace lumorph::firmware_test {

/// Twelve servos on pins of all three ports, some at their widest limits, some narrow.
[[nodiscard]] DeviceProfile twelveServos();
/// As in the header that the sketch has of its own.
[[nodiscard]] DeviceProfile sixServos();

/// What the sketch is compiled with.
struct Variant {
    DeviceProfile profile;
    std::optional<BoardSequence> poses;
};
/// "twelve"; "button": twelve servos, one reversed, and a sequence with all easings that a button on pin 10 starts;
/// "power": six in a loop from power on; "full": as many steps of twelve as there is room for.
[[nodiscard]] Variant variantOf(const std::string& name);

} // namespace lumorph::firmware_test
