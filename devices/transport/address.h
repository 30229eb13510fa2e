#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace lumorph {

/// Where a servo controller is reached, parsed from one URI.
struct SerialAddress {
    std::string path; ///< "/dev/rfcomm0"
    int baud = 57600;
    bool operator==(const SerialAddress&) const = default;
};
struct BluetoothAddress {
    std::string mac; ///< "98:D3:31:F4:12:AB", upper case
    bool operator==(const BluetoothAddress&) const = default;
};
struct HidAddress {
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string productText; ///< must be part of the device's product string; empty for any
    bool operator==(const HidAddress&) const = default;
};
struct SimulatedAddress {
    std::string device; ///< "tablet"
    std::map<std::string, std::string> options;
    bool operator==(const SimulatedAddress&) const = default;
};
using DeviceAddress = std::variant<SerialAddress, BluetoothAddress, HidAddress, SimulatedAddress>;

/// Parses `serial:///dev/ttyUSB0?baud=57600`, `bt://98:D3:31:F4:12:AB`,
/// `hid://0483:5750?product=LOBOT` or `sim://tablet?jitter=5`.
/// Throws InvalidInput naming the URI and the part that is wrong.
[[nodiscard]] DeviceAddress parseDeviceAddress(std::string_view uri);

} // namespace lumorph
