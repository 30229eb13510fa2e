#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/registration/fresh_points.h"
#include "calibration/registration/registration_fit.h"
#include "calibration/registration/touch.h"

/// Where the device lies on its tracked body.
namespace lumorph {

/// A point of the device's model, picked beforehand, and the pointer's tip held on it. The touch has a body: the
/// device's. Where the room is known does not matter.
struct TouchedLandmark {
    glm::dvec3 onModel{0.0};           ///< device frame, metres
    std::optional<glm::dvec3> outward; ///< the surface's normal there, by which mirror images show
    Touch touch;
};

/// The rows of touches. Throws CaptureRefused as restOf does, and `tracker_lost` for a touch without the device's body.
struct LandmarkRows : registration::NamedRows<registration::ModelRow> {
    std::vector<std::optional<glm::dvec3>> outward; ///< one a row
};
[[nodiscard]] LandmarkRows rowsOf(std::span<const TouchedLandmark> touches, const glm::dvec3& tip,
                                  const CaptureFault* undo = nullptr);

/// Rigid fit, then together with the tip. Throws CaptureRefused: `too_few_points`, `points_degenerate`, `mirrored`,
/// `model_does_not_fit`.
[[nodiscard]] registration::FittedPlace placeDevice(const LandmarkRows& touches, const registration::TipRow& tip,
                                                    const Progress& progress = {});

} // namespace lumorph
