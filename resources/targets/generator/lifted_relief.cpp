#include "resources/targets/generator/lifted_relief.h"

#include <algorithm>
#include <cmath>

namespace lumorph {
namespace {

constexpr double kHalfWidth = 0.105, kHalfDepth = 0.075, kLift = 0.036; // metres

/// The value where it is positive and 0 elsewhere, without a corner between.
double softly(double value) {
    constexpr double kWidth = 0.03;
    return kWidth * std::log1p(std::exp(value / kWidth));
}

/// A part of the sheet rises along a slope and ends under the path of its rim, which draws inwards as it rises: by
/// `inwards` at full lift, and with the square of the lift before. All as shares of a full lift.
double liftedPart(double lift, double slope, double toRim, double inwards) {
    constexpr double kSharpness = 4.0; // of the crest between the two
    const double path = std::sqrt(std::max(1e-6, toRim / inwards));
    return std::pow(std::pow(std::max(1e-6, lift * slope), -kSharpness) + std::pow(path, -kSharpness),
                    -1.0 / kSharpness);
}

/// `x` and `z` are 1 at the lifted corner: the sheet rises beyond a line across it.
double cornerAt(double lift, double x, double z) { return lift * softly((1.44 * x + 0.93 * z - 1.0) / 1.37); }

/// `z` is 1 at the lifted edge.
double edgeAt(double lift, double x, double z) {
    return liftedPart(lift, softly((z - 0.2) / 0.8) * std::pow(std::max(0.0, 1.0 - x * x), 1.7), 1.0 - z, 0.23);
}

} // namespace

double liftedHeight(const std::array<double, 6>& lifts, double x, double z) {
    constexpr double kSharpness = 4.0; // of the valleys between two that are lifted
    const double u = x / kHalfWidth;
    const double v = z / kHalfDepth;
    const std::array heights{cornerAt(lifts[0], -u, v), cornerAt(lifts[1], u, v), cornerAt(lifts[2], -u, -v),
                             cornerAt(lifts[3], u, -v), edgeAt(lifts[4], u, v),   edgeAt(lifts[5], u, -v)};
    double sum = 0.0;
    for (const double height : heights) sum += std::pow(height, kSharpness);
    return kLift * std::pow(sum, 1.0 / kSharpness);
}

} // namespace lumorph
