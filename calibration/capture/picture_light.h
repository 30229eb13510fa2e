#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "calibration/capture/capture_camera.h"

namespace lumorph {

/// How a picture is exposed, and how sharp it is.
struct PictureLight {
    static constexpr int kClipped = 250; ///< grey from which on a camera may have more light than it tells

    std::array<float, 64> histogram{}; ///< share of the pixels at each of 64 greys
    double bright = 0.0;               ///< grey that 99 % of the pixels do not exceed
    double clipped = 0.0;              ///< share of the pixels
    /// Energy of the picture's gradients to that of the same picture blurred by two pixels: 1 where nothing is sharp,
    /// the larger the sharper, whatever contrast and exposure are. For turning a lens ring to its best.
    double sharpness = 0.0;
};

/// `grey` is 8-bit.
[[nodiscard]] PictureLight lightOf(const cv::Mat& grey);

/// Exposes so that the brightest of what the camera sees now stays a little below white, and leaves it so; from a
/// sixtieth of a second on in whole sixtieths, as projectors' light goes. Returns the seconds; empty for a camera
/// without exposure control, or one that does not react to it. Throws what grab and setExposure throw.
std::optional<double> findExposure(CaptureCamera& camera, const Progress& progress = {});

} // namespace lumorph
