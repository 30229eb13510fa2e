#pragma once

#include <memory>
#include <string>

#include "calibration/tracking/board_address.h"
#include "devices/trackers/tracker.h"

namespace lumorph {

/// A camera that sees a marker board, as one more tracker; `uri` is for the status.
[[nodiscard]] std::unique_ptr<Tracker> openBoard(const BoardAddress& address, const std::string& uri,
                                                 TrackerOptions options);

} // namespace lumorph
