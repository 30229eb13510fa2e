#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/solve/installation_bundle.h"
#include "calibration/solve/installation_calibration.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What all cameras saw of all projectors' light with the device in one state.
struct DeviceShot {
    std::string name;
    std::vector<double> strokes; ///< one an actuator
    /// By camera, then by projector: decoded light on the device and whatever is beside it; empty where there is none.
    std::vector<std::vector<std::vector<ProjectorPoint>>> light;
};

/// Decoded light of a whole picture, averaged over squares that lie alike in all views of a camera.
[[nodiscard]] std::vector<ProjectorPoint> lightOf(const DecodedView& view, int most = 8000);

struct DeviceSolveOptions {
    /// Where cameras and projectors roughly stand and what lenses they have, the device's frame as the world, metres:
    /// needed only where fewer than four shots differ from the first by a raised part. Right to 10 cm, 10 degrees and
    /// 10 % of the focal length.
    std::optional<InstallationState> start;
};

/// Cameras and projectors, calibrated on the device alone.
struct DeviceCalibration {
    std::vector<CalibratedDevice> cameras, projectors;
    InstallationState state; ///< the world is the device's frame, metres
    InstallationState sigma; ///< standard deviations of the numbers in `state`
    double rms = 0.0; ///< of light on the device, robust (1.48 times the median length over root 2), projector pixels
    double onDevice = 0.0; ///< share of the decoded light that lies on the device and fits
    std::vector<Finding> warnings;
};

/// Solves for cameras and projectors, with distortion, from structured light on the device, whose shape the rig knows
/// in each shot: no board. The device stands still; only its actuators move between the shots. The first guess comes
/// from the light that changes when a part rises, so that shots with each actuator raised by itself, and one at rest,
/// need none. Throws CaptureRefused: too few shots, nothing of the device lit, cameras and projectors that share no
/// light, by name, nothing that fits; InvalidInput where the lists do not agree; Cancelled.
[[nodiscard]] DeviceCalibration calibrateOnDevice(const Rig& rig, const std::vector<DeviceShot>& shots,
                                                  const std::vector<NamedDevice>& cameras,
                                                  const std::vector<NamedDevice>& projectors,
                                                  const DeviceSolveOptions& options = {},
                                                  const Progress& progress = {});

} // namespace lumorph
