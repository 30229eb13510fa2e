#include "core/motion/causal_split.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/motion/split_fit.h"

namespace lumorph {

namespace {

constexpr double kShareOfStroke = 0.5; ///< of the time for a whole stroke

} // namespace

double causalLag(const Rig& rig) noexcept {
    double lag = rig.actuatorCount() > 0 ? 0.0 : CausalSplit::kMostLag;
    for (const Actuator& actuator : rig.actuators()) lag = std::max(lag, kShareOfStroke / actuator.maxVelocity);
    return std::min(lag, CausalSplit::kMostLag);
}

struct CausalSplit::Data {
    Data(const Rig& rig, double spacing) : fit(rig, spacing), lag(causalLag(rig)) {}

    void begin(std::span<const float> heights);
    void pass(std::span<const float> heights, double seconds);

    SplitFit fit;
    double lag; ///< seconds; of both low-passes together

    // Lifts over rest, one a point; empty before the first call:
    std::vector<double> wish;  ///< that came last
    std::vector<double> once;  ///< after the first low-pass
    std::vector<double> twice; ///< after the second
    std::vector<double> lastStrokes;
    bool limited = false; ///< they would be elsewhere without the velocity limits
};

void CausalSplit::Data::begin(std::span<const float> heights) {
    wish.resize(fit.points());
    for (std::size_t p = 0; p < wish.size(); ++p) wish[p] = fit.liftAt(p, heights[p]);
    once = twice = wish;
}

/// Both low-passes in closed form for a wish that goes evenly from the last to the new one, so that many short steps
/// and one long one of the same way agree. In each the new value is a mean of what was there and of both wishes.
void CausalSplit::Data::pass(std::span<const float> heights, double seconds) {
    if (seconds == 0.0) return; // no time in which anything could follow; the next step knows the wish of its end
    const double t = seconds / (0.5 * lag); // in time constants
    const double kept = std::exp(-t);
    const double lost = std::expm1(-t);
    const double onceOfNext = (t + lost) / t;
    const double onceOfWish = 1.0 - kept - onceOfNext;
    const double twiceOfOnce = t * kept;
    const double twiceOfNext = (2.0 * t + (2.0 + t) * lost) / t;
    const double twiceOfWish = 1.0 - kept - twiceOfOnce - twiceOfNext;
    for (std::size_t p = 0; p < wish.size(); ++p) {
        const double next = fit.liftAt(p, heights[p]);
        twice[p] = kept * twice[p] + twiceOfOnce * once[p] + twiceOfWish * wish[p] + twiceOfNext * next;
        once[p] = kept * once[p] + onceOfWish * wish[p] + onceOfNext * next;
        wish[p] = next;
    }
}

CausalSplit::CausalSplit(const Rig& rig, double spacing) : data_(std::make_unique<Data>(rig, spacing)) {}
CausalSplit::~CausalSplit() = default;
CausalSplit::CausalSplit(CausalSplit&&) noexcept = default;
CausalSplit& CausalSplit::operator=(CausalSplit&&) noexcept = default;

std::span<const glm::vec2> CausalSplit::points() const noexcept { return data_->fit.surface().points(); }
std::span<const float> CausalSplit::restHeights() const noexcept { return data_->fit.surface().restHeights(); }
double CausalSplit::lagSeconds() const noexcept { return data_->lag; }
std::span<const double> CausalSplit::smoothed() const noexcept { return data_->twice; }

std::vector<double> CausalSplit::strokes(std::span<const float> heights, double sinceLast) {
    Data& data = *data_;
    if (heights.size() != data.fit.points())
        throw InvalidInput("heights", "their number is not that of the points", "give one for each point");
    if (!(sinceLast >= 0.0) || !std::isfinite(sinceLast))
        throw InvalidInput("time step", "it is negative or not finite",
                           "use a finite time that does not run backwards");
    const bool goesOn = !data.twice.empty();
    if (goesOn)
        data.pass(heights, sinceLast);
    else
        data.begin(heights);
    std::vector<double> strokes = data.fit.best(data.twice, data.lastStrokes);
    const std::vector<double> unlimited = strokes;
    if (goesOn) data.fit.limit(strokes, data.lastStrokes, sinceLast);
    data.limited = strokes != unlimited;
    data.lastStrokes = strokes;
    return strokes;
}

bool CausalSplit::atRest() const noexcept {
    constexpr double kNear = 1e-6; // metres
    const auto near = [](double a, double b) { return std::abs(a - b) <= kNear; };
    return !data_->limited && std::ranges::equal(data_->once, data_->wish, near) &&
           std::ranges::equal(data_->twice, data_->wish, near);
}

void CausalSplit::restart() noexcept {
    for (std::vector<double>* kept : {&data_->wish, &data_->once, &data_->twice, &data_->lastStrokes}) kept->clear();
}

} // namespace lumorph
