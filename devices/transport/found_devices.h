#pragma once

#include "devices/transport/discovery.h"
#include "devices/transport/hid_devices.h"
#include "devices/transport/serial_ports.h"

namespace lumorph {

/// What a listed port probably is, and why it cannot be opened as things are.
[[nodiscard]] FoundDevice describeSerialPort(const SerialPort& port);
/// A Bluetooth serial port that the system has bound to a device node.
[[nodiscard]] FoundDevice describeBoundPort(const std::string& path);
[[nodiscard]] FoundDevice describeHidDevice(const HidDevice& device);

/// Serial ports, bound rfcomm ports and HID devices.
[[nodiscard]] std::vector<FoundDevice> findRealDevices();

} // namespace lumorph
