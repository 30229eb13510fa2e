#include "core/motion/split_fit.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kMostPoints = 4000.0;
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

} // namespace

SplitFit::SplitFit(const Rig& rig, double spacing)
    : surface_(surfaceOf(rig, spacing)), fit_(surface_), speeds_(speedsOf(rig)) {
    joint_.emplace(surface_);
    if (!joint_->differsFrom(fit_)) joint_.reset();
}

double SplitFit::liftAt(std::size_t point, float height) const noexcept {
    if (std::isnan(height)) return 0.0;
    const auto rest = static_cast<double>(surface_.restHeights()[point]);
    return std::clamp(static_cast<double>(height) - rest, -kHighest, kHighest);
}

std::vector<double> SplitFit::best(std::span<const double> lifts, std::span<const double> from) {
    std::vector<double> strokes(from.begin(), from.end());
    strokes.resize(speeds_.size(), 0.0);
    const std::vector<double> before = strokes;
    fit_.improve(lifts, strokes);
    if (!joint_) return strokes;
    if (joint_->errorAt(lifts, before) < joint_->errorAt(lifts, strokes)) strokes = before;
    if (from.empty()) joint_->scan(lifts, strokes, kStatesScanned);
    joint_->improve(lifts, strokes, from.empty() ? kStepAnew : kStepOn, from.empty() ? kStatesAnew : kStatesOn);
    return strokes;
}

void SplitFit::limit(std::span<double> strokes, std::span<const double> before, double seconds) const noexcept {
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        const double most = speeds_[i] * seconds;
        strokes[i] = std::clamp(strokes[i], std::max(0.0, before[i] - most), std::min(1.0, before[i] + most));
    }
}

} // namespace lumorph
