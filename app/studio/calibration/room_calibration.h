#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "calibration/solve/observations.h"
#include "calibration/solve/procam_calibration.h"
#include "core/scene/installation.h"

namespace lumorph::studio {

/// The room with this calibration in it. The board of `flatView` lay flat on the table: its middle becomes the world's
/// origin, its long side the world's x; of the two ways round, the one that puts the projector nearer to where the room
/// has it. `projector` is the number of the one that was calibrated; the first camera becomes the one that looked.
/// Throws InvalidInput where such a view is not there, or camera or projector would stand below the table.
[[nodiscard]] Installation roomWith(const Installation& room, const ProcamCalibration& solved,
                                    const ViewObservations& flatView, double metresPerUnit, std::size_t projector,
                                    const Origin& origin, const std::string& cameraAddress);

/// Root mean square distance, metres, by which light of `believed` lands beside where `truth` puts it, over a square of
/// `side` metres on the table around the world's origin; empty where neither lights it.
[[nodiscard]] std::optional<double> lightError(const CalibratedCamera& believed, const CalibratedCamera& truth,
                                               double side);

} // namespace lumorph::studio
