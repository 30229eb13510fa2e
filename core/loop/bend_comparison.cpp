#include "core/loop/bend_comparison.h"

#include <algorithm>
#include <utility>

#include <glm/matrix.hpp>

namespace lumorph {

ShowFrame BendComparison::half(const MatchFrame& match, ShowFrame shown, Half half) {
    if (!shown.rig || !shown.eye) return shown;
    auto positions = std::make_shared<std::vector<glm::vec3>>(shown.rig->restMesh().positions.size());
    shown.rig->deform(strokes(match, shown, half), *positions);
    shown.devicePositions = std::move(positions);
    return shown;
}

std::vector<double> BendComparison::strokes(const MatchFrame& match, const ShowFrame& shown, Half half) {
    std::vector<double> strokes(shown.rig->actuatorCount(), 0.0);
    // Where the servos bend now, they are not seen where they would stand without it; they want to.
    if (match.comparesBend) strokes = match.unbentStrokes.empty() ? match.estimatedStrokes : match.unbentStrokes;
    if (half == Half::without) return strokes;
    if (ruleRig_ != shown.rig) {
        rule_.emplace(*shown.rig);
        ruleRig_ = shown.rig;
    }
    const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(shown.worldFromDevice));
    const glm::dvec3 eye(deviceFromWorld * glm::dvec4(glm::dvec3(*shown.eye), 1.0));
    const std::vector<double> bends = rule_->strokes(eye, shown.scene->viewDependence.theta);
    for (std::size_t i = 0; i < strokes.size(); ++i) strokes[i] = std::max(strokes[i], bends[i]);
    return strokes;
}

} // namespace lumorph
