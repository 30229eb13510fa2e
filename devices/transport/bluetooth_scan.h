#pragma once

#include <memory>

#include "devices/transport/bluetooth_search.h"

namespace lumorph {

/// Begins to look for classic Bluetooth devices by the computer's adapter; see BluetoothSearch::Begin.
[[nodiscard]] std::unique_ptr<BluetoothScan> beginBluetoothScan(BluetoothSearch::Events events);

} // namespace lumorph
