#pragma once

#include <memory>

#include "devices/transport/transport.h"

namespace lumorph {

/// The serial port of a paired Bluetooth device (RFCOMM).
[[nodiscard]] std::unique_ptr<Transport> makeBluetoothTransport(BluetoothAddress address, Transport::Events events);

} // namespace lumorph
