#pragma once

#include <memory>
#include <string>

#include "devices/trackers/simulated_orders.h"
#include "devices/trackers/tracker.h"

namespace lumorph {

/// Opens what openTracker opens, and a marker board by camera: `board://camera0?..` (see parseBoardAddress). A
/// simulated tracker is steered by `steering`, if there is one. Throws as openTracker; a camera that cannot be opened
/// is no error but told by the tracker's status, and tried again.
[[nodiscard]] std::unique_ptr<Tracker> openAnyTracker(const std::string& uri, TrackerOptions options,
                                                      std::shared_ptr<SimulatedSteering> steering = nullptr);

/// How good a reprojection error is, for people: "good" up to 0.6 pixels, "fair" up to 1.5, else "poor".
[[nodiscard]] const char* fitWord(double reprojectionError);

} // namespace lumorph
