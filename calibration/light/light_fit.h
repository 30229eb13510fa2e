#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "calibration/light/light_series.h"
#include "core/scene/installation.h"

/// How photographs of flat light become figures: private to the measurement of light.
namespace lumorph::light {

/// What was photographed of one projector, the others showing black.
struct ProjectorShots {
    std::size_t projector = 0;
    LightShot dark, covered;
    /// By value, then channel: that channel alone at the value, the others 0.
    std::vector<std::array<LightShot, 3>> ramp;
    std::vector<double> values; ///< of the ramp, in (0, 1], the last 1
};

/// Light of one channel of a projector, by itself.
struct ChannelLight {
    std::vector<double> above; ///< by value, above black, 1 at the last; never falling
    double black = 0.0;        ///< at value 0, where its white is 1
};

/// Throws CaptureRefused: `surface_unseen` where too few patches are lit, `light_too_dark` where a channel's white
/// hardly shows, `response_not_rising`. `name`: the projector's.
[[nodiscard]] std::array<ChannelLight, 3> channelsOf(const ProjectorShots& shots, std::span<const LightPatch> patches,
                                                     const CameraResponses& responses, const std::string& name);

/// A projector's curve at even values from 0 to 1, smooth between what was measured.
[[nodiscard]] std::vector<InstalledProjector::ResponsePoint> curveOf(std::span<const double> values,
                                                                     const std::array<ChannelLight, 3>& channels);

/// Light of full white as the product of what makes it, each channel by itself.
struct WhiteFit {
    std::vector<glm::dvec3> gains;                 ///< one a projector; 0: it was not measured
    std::array<glm::dvec3, kLightSurfaces> albedo; ///< 0: the surface was not seen
    std::array<glm::dvec2, 3> fading{}; ///< a channel: ln of the light by radius^2 and radius^4 of the picture
    [[nodiscard]] double fadingOf(const LightPatch& patch, int channel) const;
};

/// By least squares of logarithms, in units of which only ratios say anything: of gains at one channel, of albedos at
/// one channel.
[[nodiscard]] WhiteFit fitWhites(std::span<const ProjectorShots> shots, std::span<const LightPatch> patches,
                                 const CameraResponses& responses, std::size_t projectors);

/// What a camera's channel (row) sees of a projector's channels (columns), where it sees 1 of its own.
[[nodiscard]] glm::dmat3 mixingOf(std::span<const ProjectorShots> shots, std::span<const LightPatch> patches,
                                  const CameraResponses& responses);

} // namespace lumorph::light
