#pragma once

#include <array>
#include <string>
#include <vector>

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

/// Three that differ in all that a guard looks at; the third sits one channel further on.
inline std::vector<ServoSetup> unevenServos(int first) {
    return {
        {.channel = first, .pulseMin = 1000.0, .pulseMax = 2000.0},
        {.channel = first + 1,
         .pulseMin = 700.0,
         .pulseMax = 1800.0,
         .reversed = true,
         .trim = 30.0,
         .maxVelocity = 0.5,
         .maxAcceleration = 3.0},
        {.channel = first + 3, .pulseMin = 1400.0, .pulseMax = 2400.0, .maxVelocity = 2.0, .maxAcceleration = 20.0}};
}

} // namespace lumorph::test
