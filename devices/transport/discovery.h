#pragma once

#include <string>
#include <vector>

#include "devices/transport/link_trouble.h"

namespace lumorph {

class SimulatedBench;

/// Something that may be a servo controller.
struct FoundDevice {
    std::string address; ///< a URI for parseDeviceAddress
    std::string name;    ///< for the user: "Arduino Nano on ttyUSB0"
    std::string hint;    ///< what it probably is, or what to do first ("pair it with PIN 1234"); may be empty
    std::string identity;
    LinkTrouble trouble; ///< why it cannot be opened as things are; both texts empty where it can
    bool operator==(const FoundDevice&) const = default;
};

/// Serial ports, bound rfcomm ports, HID devices and simulated boards, in this order. Takes milliseconds; opens
/// nothing.
[[nodiscard]] std::vector<FoundDevice> findDevices(const SimulatedBench* bench);

} // namespace lumorph
