#include "core/motion/frequency_split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/common.hpp>

#include "core/base/error.h"
#include "core/motion/joint_fit.h"
#include "core/motion/stroke_fit.h"

namespace lumorph {

namespace {

constexpr double kLongestWindow = 4.0; // seconds
constexpr double kLongestStep = 0.05;  // seconds between samples of the wish
constexpr double kFewestSteps = 16.0;  // in a window
constexpr double kMostPoints = 4000.0;
constexpr double kLongestTime = 1e9; // seconds
// States that a fit of joints in a row may look at: from one frame to the next it goes on from where it was.
constexpr int kStatesScanned = 100;
constexpr int kStatesAnew = 250;
constexpr int kStatesOn = 40;
constexpr double kStepAnew = 0.25; // strokes
constexpr double kStepOn = 0.03;
constexpr double kHighest = 10.0; // metres; beyond lies no wish

/// The middles of a grid's cells over a box in x and z.
std::vector<glm::vec2> gridOver(const Box& box, double spacing) {
    const glm::dvec2 low(box.min.x, box.min.z);
    const glm::dvec2 size(box.size().x, box.size().z);
    const double cell = std::max(spacing, std::sqrt(size.x * size.y / kMostPoints));
    const glm::ivec2 counts = glm::max(glm::ivec2(glm::round(size / cell)), glm::ivec2(1));
    std::vector<glm::vec2> points;
    for (int j = 0; j < counts.y; ++j)
        for (int i = 0; i < counts.x; ++i)
            points.emplace_back(low + size * (glm::dvec2(i, j) + 0.5) / glm::dvec2(counts));
    return points;
}

TopSurface surfaceOf(const Rig& rig, double spacing) {
    if (!(spacing > 0.0) || !std::isfinite(spacing))
        throw InvalidInput("spacing of the grid", "it must be a finite number above zero", "give a larger spacing");
    return {rig, gridOver(boundingBox(rig.restMesh().positions), spacing)};
}

std::vector<double> speedsOf(const Rig& rig) {
    std::vector<double> speeds;
    for (const Actuator& actuator : rig.actuators()) speeds.push_back(actuator.maxVelocity);
    return speeds;
}

/// One and a half times as long as the slowest actuator takes for its whole stroke; what is left of faster ways is cut
/// by the limit itself.
double windowOf(const std::vector<double>& speeds) {
    if (speeds.empty()) return kLongestWindow;
    return std::min(1.5 / std::ranges::min(speeds), kLongestWindow);
}

} // namespace

struct FrequencySplit::Data {
    Data(const Rig& rig, double spacing)
        : surface(surfaceOf(rig, spacing)), fit(surface), speeds(speedsOf(rig)), window(windowOf(speeds)),
          wished(surface.points().size()), lifts(surface.points().size()) {
        joint.emplace(surface);
        if (!joint->differsFrom(fit)) joint.reset();
    }

    void average(const Wish& wish, double seconds);
    void add(std::span<const float> heights, double weight);
    [[nodiscard]] std::vector<double> best(std::span<const double> from);

    TopSurface surface;
    StrokeFit fit;
    std::optional<JointFit> joint; ///< where the sum that `fit` takes is not what the actuators do together
    std::vector<double> speeds;    ///< strokes a second
    double window;                 ///< seconds

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
        std::ranges::copy(surface.restHeights(), wished.begin());
        wish(k * step, wished);
        add(wished, weightAt(k) / weights);
    }
}

void FrequencySplit::Data::add(std::span<const float> heights, double weight) {
    const std::vector<float>& rest = surface.restHeights();
    for (std::size_t p = 0; p < lifts.size(); ++p)
        if (!std::isnan(heights[p]))
            lifts[p] += weight *
                        std::clamp(static_cast<double>(heights[p]) - static_cast<double>(rest[p]), -kHighest, kHighest);
}

/// The strokes for `lifts`; `from` are those of the call before, or none.
std::vector<double> FrequencySplit::Data::best(std::span<const double> from) {
    std::vector<double> strokes(from.begin(), from.end());
    strokes.resize(speeds.size(), 0.0);
    const std::vector<double> before = strokes;
    fit.improve(lifts, strokes);
    if (!joint) return strokes;
    if (joint->errorAt(lifts, before) < joint->errorAt(lifts, strokes)) strokes = before;
    if (from.empty()) joint->scan(lifts, strokes, kStatesScanned);
    joint->improve(lifts, strokes, from.empty() ? kStepAnew : kStepOn, from.empty() ? kStatesAnew : kStatesOn);
    return strokes;
}

FrequencySplit::FrequencySplit(const Rig& rig, double spacing) : data_(std::make_unique<Data>(rig, spacing)) {}
FrequencySplit::~FrequencySplit() = default;
FrequencySplit::FrequencySplit(FrequencySplit&&) noexcept = default;
FrequencySplit& FrequencySplit::operator=(FrequencySplit&&) noexcept = default;

std::span<const glm::vec2> FrequencySplit::points() const noexcept { return data_->surface.points(); }
std::span<const float> FrequencySplit::restHeights() const noexcept { return data_->surface.restHeights(); }

std::vector<double> FrequencySplit::strokes(const Wish& wish, double seconds) {
    if (!(std::abs(seconds) <= kLongestTime))
        throw InvalidInput("time", "it is not finite, or is beyond thirty years",
                           "count the show's time from its start");
    Data& data = *data_;
    data.average(wish, seconds);
    const bool goesOn = !data.lastStrokes.empty() && seconds >= data.lastSeconds;
    std::vector<double> strokes =
        data.best(goesOn ? std::span<const double>(data.lastStrokes) : std::span<const double>());
    if (goesOn)
        for (std::size_t i = 0; i < strokes.size(); ++i) {
            const double most = data.speeds[i] * (seconds - data.lastSeconds);
            strokes[i] = std::clamp(strokes[i], std::max(0.0, data.lastStrokes[i] - most),
                                    std::min(1.0, data.lastStrokes[i] + most));
        }
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
    return data.best({});
}

void FrequencySplit::heights(std::span<const double> strokes, std::span<float> out) const {
    if (strokes.size() != data_->speeds.size() || out.size() != data_->surface.points().size())
        throw InvalidInput("heights", "the counts do not agree with the rig",
                           "give a stroke an actuator and a height a point");
    data_->surface.heights(strokes, out);
}

} // namespace lumorph
