#include "core/motion/frequency_split.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/motion/split_fit.h"

namespace lumorph {

namespace {

constexpr double kLongestWindow = 4.0; // seconds
constexpr double kLongestStep = 0.05;  // seconds between samples of the wish
constexpr double kFewestSteps = 16.0;  // in a window
constexpr double kLongestTime = 1e9;   // seconds

/// One and a half times as long as the slowest actuator takes for its whole stroke; what is left of faster ways is cut
/// by the limit itself.
double windowOf(const std::vector<double>& speeds) {
    if (speeds.empty()) return kLongestWindow;
    return std::min(1.5 / std::ranges::min(speeds), kLongestWindow);
}

} // namespace

struct FrequencySplit::Data {
    Data(const Rig& rig, double spacing)
        : fit(rig, spacing), window(windowOf(fit.speeds())), wished(fit.points()), lifts(fit.points()) {}

    void average(const Wish& wish, double seconds);
    void add(std::span<const float> heights, double weight);

    SplitFit fit;
    double window; ///< seconds

    std::vector<float> wished; ///< buffers
    std::vector<double> lifts;
    std::vector<double> lastStrokes; ///< strokes at `lastSeconds`; empty before the first
    double lastSeconds = 0.0;
};

/// The wish averaged under a raised cosine. It is asked for at whole multiples of a step only, so that who works it out
/// with effort may keep what he has found.
void FrequencySplit::Data::average(const Wish& wish, double seconds) {
    std::ranges::fill(lifts, 0.0);
    const double step = std::min(window / kFewestSteps, kLongestStep);
    double weights = 0.0;
    const auto weightAt = [&](double k) {
        return std::max(0.0, 1.0 + std::cos(2.0 * std::numbers::pi * (k * step - seconds) / window));
    };
    const double first = std::ceil((seconds - 0.5 * window) / step);
    const double last = std::floor((seconds + 0.5 * window) / step);
    for (double k = first; k <= last; k += 1.0) weights += weightAt(k);
    for (double k = first; k <= last; k += 1.0) {
        std::ranges::copy(fit.surface().restHeights(), wished.begin());
        wish(k * step, wished);
        add(wished, weightAt(k) / weights);
    }
}

void FrequencySplit::Data::add(std::span<const float> heights, double weight) {
    for (std::size_t p = 0; p < lifts.size(); ++p) lifts[p] += weight * fit.liftAt(p, heights[p]);
}

FrequencySplit::FrequencySplit(const Rig& rig, double spacing) : data_(std::make_unique<Data>(rig, spacing)) {}
FrequencySplit::~FrequencySplit() = default;
FrequencySplit::FrequencySplit(FrequencySplit&&) noexcept = default;
FrequencySplit& FrequencySplit::operator=(FrequencySplit&&) noexcept = default;

std::span<const glm::vec2> FrequencySplit::points() const noexcept { return data_->fit.surface().points(); }
std::span<const float> FrequencySplit::restHeights() const noexcept { return data_->fit.surface().restHeights(); }

std::vector<double> FrequencySplit::strokes(const Wish& wish, double seconds) {
    if (!(std::abs(seconds) <= kLongestTime))
        throw InvalidInput("time", "it is not finite, or is beyond thirty years",
                           "count the show's time from its start");
    Data& data = *data_;
    data.average(wish, seconds);
    const bool goesOn = !data.lastStrokes.empty() && seconds >= data.lastSeconds;
    std::vector<double> strokes =
        data.fit.best(data.lifts, goesOn ? std::span<const double>(data.lastStrokes) : std::span<const double>());
    if (goesOn) data.fit.limit(strokes, data.lastStrokes, seconds - data.lastSeconds);
    data.lastStrokes = strokes;
    data.lastSeconds = seconds;
    return strokes;
}

void FrequencySplit::restart() noexcept { data_->lastStrokes.clear(); }

std::vector<double> FrequencySplit::fit(std::span<const float> heights) {
    Data& data = *data_;
    if (heights.size() != data.lifts.size())
        throw InvalidInput("heights", "their number is not that of the points", "give one for each point");
    std::ranges::fill(data.lifts, 0.0);
    data.add(heights, 1.0);
    return data.fit.best(data.lifts, {});
}

void FrequencySplit::heights(std::span<const double> strokes, std::span<float> out) const {
    if (strokes.size() != data_->fit.speeds().size() || out.size() != data_->fit.points())
        throw InvalidInput("heights", "the counts do not agree with the rig",
                           "give a stroke an actuator and a height a point");
    data_->fit.surface().heights(strokes, out);
}

} // namespace lumorph
