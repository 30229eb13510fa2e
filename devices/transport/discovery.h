#pragma once

#include <functional>
#include <memory>
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

/// Looks for Bluetooth devices that offer a serial port; takes ten seconds or so. Lives in one thread that runs a Qt
/// event loop. Gone, it calls no more.
class BluetoothSearch {
public:
    struct Events {
        std::function<void(const FoundDevice&)> found;
        std::function<void(const LinkTrouble&)> ended; ///< texts are empty where it simply came to its end
    };
    explicit BluetoothSearch(Events events);
    ~BluetoothSearch();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
