#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lumorph {

/// Bytes that say how much light there was: darker ones are noise and the camera's own black, brighter ones are cut
/// off.
inline constexpr double kDarkestByte = 16.0, kBrightestByte = 242.0;

/// How one channel of a camera turns light into bytes, as found from exposures of different lengths. The unit of light
/// is what makes the byte 128 in a second: three channels with equal bytes are taken to be neutral.
class CameraResponse {
public:
    CameraResponse() = default;
    /// `logLight`: ln of light by rising bytes, at knots that are even in the logarithm of the byte; two at least.
    CameraResponse(std::vector<double> logLight, double rms) : logLight_(std::move(logLight)), rms_(rms) {}

    /// Light x seconds of a byte, which may be a mean and lie between two; beyond the trusted bytes as the curve goes
    /// on, 0 at byte 0.
    [[nodiscard]] double lightOf(double byte) const;
    /// Root mean square by which exposures contradict the curve, as a share of the light.
    [[nodiscard]] double rms() const noexcept { return rms_; }

private:
    std::vector<double> logLight_;
    double rms_ = 0.0;
};

/// A place whose light stays the same, photographed for some time.
struct ExposedByte {
    std::size_t place = 0; ///< places are counted from 0
    double seconds = 0.0;
    double byte = 0.0;
};

/// A smooth curve and the light of each place, by least squares of logarithms (as Debevec and Malik, "Recovering high
/// dynamic range radiance maps from photographs", 1997, but even in the logarithm of the byte, where a camera's gamma
/// is a straight line). Bytes outside of the trusted ones are left out. Throws CaptureRefused: `camera_adjusts` where
/// longer exposures are not brighter or contradict each other, `light_too_dark` where too few bytes can be trusted.
[[nodiscard]] CameraResponse estimateCameraResponse(std::span<const ExposedByte> seen);

} // namespace lumorph
