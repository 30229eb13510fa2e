#include "app/tracking/any_tracker.h"

#include <utility>
#include <variant>

#include "app/tracking/board_tracker.h"
#include "devices/trackers/tracker_address.h"

namespace lumorph {

std::unique_ptr<Tracker> openAnyTracker(const std::string& uri, TrackerOptions options,
                                        std::shared_ptr<SimulatedSteering> steering) {
    if (isBoardAddress(uri)) return openBoard(parseBoardAddress(uri), uri, std::move(options));
    if (steering && std::holds_alternative<SimulatedBodyAddress>(parseTrackerAddress(uri)))
        return openSteered(uri, std::move(options), std::move(steering));
    return openTracker(uri, std::move(options));
}

const char* fitWord(double reprojectionError) {
    constexpr double kGood = 0.6, kFair = 1.5; // pixels
    if (reprojectionError <= kGood) return "good";
    return reprojectionError <= kFair ? "fair" : "poor";
}

} // namespace lumorph
