#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/registration/fresh_points.h"
#include "calibration/registration/registration_fit.h"
#include "calibration/registration/touch.h"
#include "core/scene/installation.h"

/// The tracker's world in the room's, by points that a calibrated projector sees as rays.
namespace lumorph {

/// A dot that a projector shows at a pixel, and a pointer's tip held on it.
struct TouchedDot {
    std::size_t projector = 0;
    glm::dvec2 pixel{0.0};
    Touch touch;
};

/// The rows of dots and their rests. `height` is that of the table on which they lie, where it is known. Throws
/// CaptureRefused as restOf does, InvalidInput for a projector that is not there.
using DotRows = registration::NamedRows<registration::RayRow>;
[[nodiscard]] DotRows rowsOf(std::span<const TouchedDot> dots, const Installation& room, const glm::dvec3& tip,
                             std::optional<double> height, const CaptureFault* undo = nullptr);
/// Closed form (a rigid fit to where the rays meet the table, or where the table is unknown a perspective of the
/// points by SQPnP), then all together with the tip, which swings told before. Throws CaptureRefused:
/// `too_few_points`, `points_degenerate` (on one line, too close together), `mirrored` (the pointer would stand behind
/// what it touches), `model_does_not_fit`.
[[nodiscard]] registration::FittedPlace placeTracker(const DotRows& dots, const registration::TipRow& tip,
                                                     const Progress& progress = {});

} // namespace lumorph
