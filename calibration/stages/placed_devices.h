#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/solve/mirror_calibration.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Reprojection error of light in a pose that was held out before the solve.
struct HeldOutLight {
    double median = 0.0, most = 0.0;             ///< 50 and 95 of 100 points, metres
    double medianPixels = 0.0, mostPixels = 0.0; ///< the same in the projector
    std::size_t points = 0;                      ///< 0: nothing was held out
};

/// Cameras and projectors of a room, with lenses and places, solved together: by boards, by a mirror, or by the device.
struct PlacedDevices {
    Installation room; ///< as it was where it was refused
    struct Device {
        std::string name;
        bool isProjector = false;
        double rms = 0.0;        ///< of what it saw or lit, its own pixels
        double focalSigma = 0.0; ///< pixels
        double shiftSigma = 0.0; ///< of its position, metres; 0 for the reference camera
        HeldOutLight heldOut;    ///< of a projector
    };
    std::vector<Device> devices;
    double rms = 0.0; ///< pixels, of all together
    HeldOutLight heldOut;
    std::optional<MirrorPlane> mirror; ///< in the camera's frame, millimetres
    std::string summary;
    std::optional<Finding> refusal;
    std::vector<Finding> warnings;
    [[nodiscard]] bool good() const noexcept { return !refusal; }
};

} // namespace lumorph
