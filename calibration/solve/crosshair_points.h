#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// A point of the device that a crosshair can be laid onto.
struct DevicePoint {
    std::string name;  ///< "corner front left, raised", "body, back right"
    cv::Point3d point; ///< device frame, metres, with the device in the state of its proposal
};

/// Points to aim at, and how the device is to stand meanwhile.
struct DevicePoints {
    std::vector<double> strokes; ///< one an actuator: all raised
    std::vector<DevicePoint> points;
};

/// Proposes corners of raised flaps and of the body, best first, at most `most`: those that a projector standing at
/// `projector` (device frame, metres) lights, and of which the crosshairs together tell lens and pose best wherever on
/// the device light may fall. Throws InvalidInput for a place that is not finite or lies within the device, and where
/// fewer than six corners are lit.
[[nodiscard]] DevicePoints proposeDevicePoints(const Rig& rig, const cv::Point3d& projector, int most = 8);

} // namespace lumorph
