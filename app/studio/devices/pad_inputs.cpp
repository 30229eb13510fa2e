#include "app/studio/devices/pad_inputs.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::studio {
namespace {

constexpr double kStickStep = 0.01; ///< smaller moves are a tremble

/// Nothing near the middle, and from there evenly to the edge.
glm::dvec2 toldOf(const glm::dvec2& stick) {
    if (!std::isfinite(stick.x) || !std::isfinite(stick.y)) return glm::dvec2(0.0);
    const double length = glm::length(stick);
    if (length <= PadInputs::kRests) return glm::dvec2(0.0);
    const double share = std::min(1.0, (length - PadInputs::kRests) / (PadInputs::kWhole - PadInputs::kRests));
    return glm::clamp(glm::round(stick / length * share / kStickStep) * kStickStep, -1.0, 1.0);
}

} // namespace

std::vector<ShowInput> PadInputs::take(const PadReading& reading) {
    PadReading now = reading;
    now.stick = toldOf(reading.stick);
    std::vector<ShowInput> inputs;
    const auto tell = [&inputs](const char* name, double was, double is) {
        if (was != is) inputs.push_back({name, is});
    };
    tell("pad.x", before_.stick.x, now.stick.x);
    tell("pad.y", before_.stick.y, now.stick.y);
    tell("key.restart", before_.restart, now.restart);
    tell("key.next", before_.next, now.next);
    tell("key.attract", before_.attract, now.attract);
    before_ = now;
    return inputs;
}

} // namespace lumorph::studio
