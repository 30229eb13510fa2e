#pragma once

#include <cstdint>
#include <functional>

#include "calibration/capture/device_bench.h"
#include "calibration/servos/servo_calibration.h"

namespace lumorph {

/// Servos as they were measured.
struct ServoMeasurement {
    Installation room; ///< believed, with the measured servos where they may be used
    ServoPlan plan;
    double seconds = 0.0; ///< that the device moved and was photographed, by the plan's own figures
    ServoCalibration measured;
};

/// Moves the servos slowly to a step's commands and looks at the device. Throws what its hardware throws; Cancelled.
using ServoLook = std::function<ServoPass(const std::vector<double>& commanded, const Progress& progress)>;

/// Plans with the room as it is believed to be, steps, looks and solves. Reports stages in words for the user ("hands
/// off: ..."). Throws what solveServos and `look` throw; Cancelled leaves nothing behind.
[[nodiscard]] ServoMeasurement measureServos(const Rig& rig, const Installation& believed, std::uint32_t seed,
                                             const ServoLook& look, const Progress& progress = {},
                                             const ServoPlanOptions& options = {});

/// The room with what was measured, where it is usable.
[[nodiscard]] Installation withMeasuredServos(const Installation& room, const ServoCalibration& measured);

/// Has a device stand as it is told, and decodes the first projector's phase shifts as the first camera sees them.
/// Throws what the bench throws; DeviceError for a camera that stops.
[[nodiscard]] std::vector<ProjectorPoint> lookBy(DeviceBench& bench, const Installation& room,
                                                 const std::vector<double>& commanded, const Progress& progress);
/// Pictures that it takes.
[[nodiscard]] int picturesOfLook(const Installation& room);

} // namespace lumorph
