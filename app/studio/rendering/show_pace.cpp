#include "app/studio/rendering/show_pace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kRememberedShows = 3;
// Finer only when that will surely be in time, so that it does not swing.
constexpr double kRoom = 0.7;
// Pictures of few sizes come and go: memory that is freed fits the next.
constexpr double kStepsToFull = 20.0;

double inSteps(double resolution) { return std::floor(kStepsToFull * resolution) / kStepsToFull; }

} // namespace

void ShowPace::request(ShowRequest request, Time now) {
    still_ = request.refine;
    request_ = std::move(request);
    asked_ = now;
    moving_ = true;
}

std::optional<ShowPace::Work> ShowPace::nextMoving() {
    if (!pressing()) return std::nullopt;
    moving_ = false;
    // Frames that are as fine as they get need no second drawing.
    still_ = still_ && resolution_ < 1.0;
    return Work{*request_, false, resolution_};
}

std::optional<ShowPace::Work> ShowPace::nextStill(Time now) {
    const auto at = stillAt();
    if (!at || now < *at) return std::nullopt;
    still_ = false;
    return Work{*request_, true, 1.0};
}

std::optional<ShowPace::Time> ShowPace::stillAt() const {
    if (!request_ || moving_ || !still_) return std::nullopt;
    return asked_ + kQuiet;
}

void ShowPace::finished(const Work& work, double milliseconds) {
    if (work.still || work.resolution != resolution_) return;
    times_.push_back(milliseconds);
    if (times_.size() > kRememberedShows) times_.erase(times_.begin());
    if (times_.size() < kRememberedShows) return;
    // The time goes with the pixels, so with the square of a side.
    const double usual = std::max(median(times_), 0.1);
    const double fitting = resolution_ * std::sqrt(kBudgetMilliseconds / usual);
    double wanted = resolution_;
    if (usual > kBudgetMilliseconds)
        wanted = std::max(kLowestResolution, inSteps(0.97 * fitting));
    else if (usual < kRoom * kBudgetMilliseconds)
        wanted = std::min(1.0, inSteps(0.9 * fitting));
    if (wanted == resolution_ || (wanted > resolution_ && wanted < 1.05 * resolution_)) return;
    resolution_ = wanted;
    times_.clear();
}

} // namespace lumorph::studio
