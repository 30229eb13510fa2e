#include "devices/transport/bluetooth_trouble.h"

#include <filesystem>
#include <system_error>

namespace lumorph {

namespace fs = std::filesystem;

std::string pairingHint() {
    return "pair it in the system's Bluetooth settings; the PIN of an HC-06 or HC-05 is 1234 or 0000";
}

LinkTrouble bluetoothTrouble(BluetoothObstacle obstacle, const std::string& device) {
    switch (obstacle) {
    case BluetoothObstacle::noAdapter:
        return {"this computer has no Bluetooth adapter", "plug in a Bluetooth adapter, or connect the device by USB"};
    case BluetoothObstacle::switchedOff:
        return {"Bluetooth is switched off", "switch it on in the system's settings"};
    case BluetoothObstacle::notAllowed:
        return {
            "this user may not use Bluetooth",
            "add yourself to the group bluetooth (sudo usermod -aG bluetooth $USER), then log out and log in again"};
    case BluetoothObstacle::notPaired:
        return {device + " is not paired with this computer", pairingHint()};
    case BluetoothObstacle::outOfRange:
        return {device + " does not answer over Bluetooth",
                "switch the device on, bring it nearer, and disconnect other computers from it"};
    case BluetoothObstacle::noSerialPort:
        return {device + " does not answer as a serial port",
                "switch the device on and bring it nearer; if it is no serial module such as an HC-06, choose another"};
    case BluetoothObstacle::brokenOff:
        break;
    }
    return {"the Bluetooth link to " + device + " broke off",
            "check the device's power and its distance; it is connected again when it answers"};
}

bool hasBluetoothAdapter() {
    std::error_code none;
    for (fs::directory_iterator entry("/sys/class/bluetooth", none), end; !none && entry != end; entry.increment(none))
        // "hci0:11" is a connection of hci0, not an adapter.
        if (const std::string name = entry->path().filename().string();
            name.starts_with("hci") && name.find(':') == std::string::npos)
            return true;
    return false;
}

} // namespace lumorph
