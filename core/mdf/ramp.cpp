#include "core/mdf/ramp.h"

#include <array>
#include <cmath>

#include "core/base/units.h"

namespace lumorph {

namespace {

/// Sums over the first levels of a rise g, so that the error of any ramp takes constant time.
class RiseSums {
public:
    RiseSums(std::span<const double> expectation, double base) noexcept
        : levels_(static_cast<int>(expectation.size())) {
        for (int j = 0; j < levels_; ++j) {
            const double g = expectation[static_cast<std::size_t>(j)] - base;
            const auto at = static_cast<std::size_t>(j);
            sum_[at + 1] = sum_[at] + g;
            square_[at + 1] = square_[at] + g * g;
            moment_[at + 1] = moment_[at] + j * g;
        }
    }

    /// Squared error of rising by `rise` between v0 and v1.
    [[nodiscard]] double errorOf(int v0, int v1, double rise) const noexcept {
        const double slope = rise / (v1 - v0 + 1);
        const double n = v1 - v0;
        // In the middle the ramp is slope * (j - v0 + 1): sum of (g - that)^2, multiplied out.
        const double middleMoment = between(moment_, v0, v1) + (1 - v0) * between(sum_, v0, v1);
        const double middleSquares = n * (n + 1) * (2 * n + 1) / 6.0;
        const double middle = between(square_, v0, v1) - 2 * slope * middleMoment + slope * slope * middleSquares;
        const double upper =
            between(square_, v1, levels_) - 2 * rise * between(sum_, v1, levels_) + rise * rise * (levels_ - v1);
        return square_[static_cast<std::size_t>(v0)] + middle + upper;
    }

private:
    using Sums = std::array<double, kMaxLevels + 1>;
    [[nodiscard]] static double between(const Sums& sums, int first, int end) noexcept {
        return sums[static_cast<std::size_t>(end)] - sums[static_cast<std::size_t>(first)];
    }

    int levels_;
    Sums sum_{};
    Sums square_{};
    Sums moment_{};
};

/// The level of the only rise, or 0 when there are several.
int singleStep(std::span<const double> expectation) noexcept {
    int step = 0;
    for (std::size_t j = 1; j < expectation.size(); ++j) {
        if (expectation[j] == expectation[j - 1]) continue;
        if (step != 0) return 0;
        step = static_cast<int>(j);
    }
    return step;
}

} // namespace

Ramp fitRamp(std::span<const double> expectation) noexcept {
    Ramp ramp;
    ramp.base = static_cast<std::uint8_t>(std::lround(255.0 * expectation.front()));
    ramp.top = static_cast<std::uint8_t>(std::lround(255.0 * expectation.back()));
    if (ramp.base == ramp.top) return ramp;
    if (const int step = singleStep(expectation); step != 0) {
        ramp.v0 = ramp.v1 = static_cast<std::uint8_t>(step);
        return ramp;
    }
    const double rise = (ramp.top - ramp.base) / 255.0;
    const RiseSums sums(expectation, ramp.base / 255.0);
    double best = INFINITY;
    const int levels = static_cast<int>(expectation.size());
    for (int v0 = 1; v0 < levels; ++v0)
        for (int v1 = v0; v1 < levels; ++v1)
            if (const double error = sums.errorOf(v0, v1, rise); error < best) {
                best = error;
                ramp.v0 = static_cast<std::uint8_t>(v0);
                ramp.v1 = static_cast<std::uint8_t>(v1);
            }
    return ramp;
}

} // namespace lumorph
