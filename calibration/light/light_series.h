#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/light/camera_response.h"
#include "calibration/light/light_bench.h"
#include "calibration/light/light_patches.h"

namespace lumorph {

/// The same light at several exposures: mean bytes of each patch.
struct LightShot {
    struct Exposed {
        double seconds = 0.0;
        std::vector<glm::dvec3> bytes; ///< one a patch
    };
    std::vector<Exposed> exposures; ///< by rising seconds
};

/// A bench, its exposures once they are set, and what is kept of each photograph: the mean bytes of patches.
class LightSeries {
public:
    /// Both outlive it.
    LightSeries(LightBench& bench, std::span<const LightPatch> patches) : bench_(bench), patches_(patches) {}

    /// Finds the exposure that shows the brightest patch under `white` just below where it is cut off. Throws
    /// CaptureRefused: `camera_saturates`, `light_too_dark`.
    void setExposure(const LightShow& white);
    /// At the exposure that was set and at longer ones, for darker light.
    [[nodiscard]] LightShot take(const LightShow& show);
    /// At many exposures, shares of the one that was set, as far as the camera can.
    [[nodiscard]] LightShot takeAll(const LightShow& show, double longest, double step, int count);
    [[nodiscard]] int photographs() const noexcept { return photographs_; }
    /// The camera sees no colour.
    [[nodiscard]] bool isMonochrome() const noexcept { return isMonochrome_; }

private:
    void lookForExposure(const LightShow& white);
    [[nodiscard]] LightShot::Exposed expose(const LightShow& show, double seconds);

    LightBench& bench_;
    std::span<const LightPatch> patches_;
    double seconds_ = 0.0;
    int photographs_ = 0;
    bool isMonochrome_ = false;
};

/// The three channels of a camera.
using CameraResponses = std::array<CameraResponse, 3>;

/// Light of a patch in one channel beyond that of another shot, from the longest exposure that is not cut off; empty
/// where all are. Without `dark`: all of its light.
[[nodiscard]] std::optional<double> lightBeyond(const LightShot& bright, const LightShot* dark,
                                                const CameraResponses& responses, std::size_t patch, int channel);

} // namespace lumorph
