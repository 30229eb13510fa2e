#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/transport/serial_ports.h"
#include "devices/transport/transport.h"

namespace lumorph {

/// What a LinkKeeper sees of the world; tests have one of their own.
struct LinkWorld {
    std::function<std::unique_ptr<Transport>(const DeviceAddress&, Transport::Events)> makeTransport;
    std::function<std::vector<SerialPort>()> serialPorts;
    /// Changes when the device may have come back; costs microseconds.
    std::function<std::string(const DeviceAddress&)> sight;
};

/// `bench` may be null and must outlive it.
[[nodiscard]] LinkWorld realLinkWorld(SimulatedBench* bench);

/// The sight of a device that is not simulated: of its node, and of the folder where the system puts nodes.
[[nodiscard]] std::string sightOfNode(const DeviceAddress& address);

} // namespace lumorph
