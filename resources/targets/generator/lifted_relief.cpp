#include "resources/targets/generator/lifted_relief.h"

#include <algorithm>
#include <cmath>

namespace lumorph {
namespace {

constexpr double kHalfWidth = 0.105, kHalfDepth = 0.075, kLift = 0.040; // metres

/// The value where it is positive and 0 elsewhere, without a corner between.
double softly(double value) {
    constexpr double kWidth = 0.06;
    return kWidth * std::log1p(std::exp(value / kWidth));
}

/// `x` and `z` are 1 at the lifted corner: the sheet rises beyond a line across it.
double cornerAt(double x, double z) { return softly((1.44 * x + 0.93 * z - 1.0) / 1.37); }

/// `z` is 1 at the lifted edge.
double edgeAt(double x, double z) { return softly((z - 0.2) / 0.8) * std::pow(std::max(0.0, 1.0 - x * x), 1.7); }

} // namespace

double liftedHeight(const std::array<double, 6>& lifts, double x, double z) {
    constexpr double kSharpness = 4.0; // of the valleys between two that are lifted
    const double u = x / kHalfWidth;
    const double v = z / kHalfDepth;
    const std::array heights{cornerAt(-u, v), cornerAt(u, v), cornerAt(-u, -v),
                             cornerAt(u, -v), edgeAt(u, v),   edgeAt(u, -v)};
    double sum = 0.0;
    for (std::size_t k = 0; k < lifts.size(); ++k) sum += std::pow(lifts[k] * heights[k], kSharpness);
    return kLift * std::pow(sum, 1.0 / kSharpness);
}

} // namespace lumorph
