#pragma once

#include <array>
#include <string>

#include "devices/controllers/device_profile.h"

/// The boards of the simulated bench, as devices with two servos.
namespace lumorph::test {

struct SimulatedDevice {
    const char* name;
    ControllerKind controller;
    int first; ///< channel of the board's first servo
};
inline constexpr std::array<SimulatedDevice, 4> kSimulatedDevices = {
    SimulatedDevice{"tablet", ControllerKind::firmata, 2}, SimulatedDevice{"uno", ControllerKind::firmata, 2},
    SimulatedDevice{"xarm", ControllerKind::lewansoul, 1}, SimulatedDevice{"maestro", ControllerKind::maestro, 0}};

inline DeviceProfile profileOf(const SimulatedDevice& device) {
    DeviceProfile profile;
    profile.name = "the tablet in \"room 3\"";
    profile.address = "sim://" + std::string(device.name);
    profile.controller = device.controller;
    profile.staggerSeconds = 0.05;
    profile.servos = {{.channel = device.first}, {.channel = device.first + 1, .trim = 1.0 / 3.0}};
    return profile;
}

} // namespace lumorph::test
