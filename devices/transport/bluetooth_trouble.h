#pragma once

#include <string>

#include "devices/transport/link_trouble.h"

namespace lumorph {

enum class BluetoothObstacle { noAdapter, switchedOff, notAllowed, notPaired, outOfRange, noSerialPort, brokenOff };

/// `device` is its name or its address, for the user's eyes.
[[nodiscard]] LinkTrouble bluetoothTrouble(BluetoothObstacle obstacle, const std::string& device);

/// What to do before the first connection.
[[nodiscard]] std::string pairingHint();

/// Asks the kernel alone: on a computer without Bluetooth the Bluetooth service is not there to be asked.
[[nodiscard]] bool hasBluetoothAdapter();

} // namespace lumorph
