#include "calibration/registration/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "core/base/statistics.h"

namespace lumorph {

namespace {

constexpr double kWindow = 0.16;          ///< seconds over which a turn is measured: noise of single poses averages out
constexpr double kShared = 1.0 / 3.0;     ///< of the shorter recording
constexpr double kFastest = 2.5;          ///< times the usual speed
constexpr std::ptrdiff_t kElsewhere = 25; ///< steps from the best offset: another peak
constexpr std::size_t kMostSteps = 60'000; ///< 20 minutes

/// Angular speeds on an even grid from the first pose on; NaN in gaps.
std::vector<double> speedsOf(const PoseTrack& track) {
    const double first = track.poses.front().seconds, last = track.poses.back().seconds;
    const auto steps = static_cast<std::size_t>(std::min((last - first) / kSpeedStep, double(kMostSteps)));
    std::vector<double> speeds(steps, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < steps; ++i) {
        const double middle = first + kSpeedStep * static_cast<double>(i);
        const auto before = poseAt(track, middle - 0.5 * kWindow), after = poseAt(track, middle + 0.5 * kWindow);
        if (!before || !after) continue;
        const double speed = angleOf(glm::conjugate(before->rotation) * after->rotation) / kWindow;
        speeds[i] = speed;
    }
    // A tracker that jumps would count for more than all true turns.
    std::vector<double> known;
    std::ranges::copy_if(speeds, std::back_inserter(known), [](double speed) { return !std::isnan(speed); });
    const double most = kFastest * median(std::move(known));
    for (double& speed : speeds)
        if (speed > most) speed = most;
    return speeds;
}

/// Pearson's correlation, and of how many samples.
struct Correlation {
    double value = 0.0, samples = 0.0;
    /// By how many of its standard deviations it differs from none (Fisher's z): a short overlap correlates by chance.
    [[nodiscard]] double evidence() const { return std::atanh(std::min(value, 1.0 - 1e-9)) * std::sqrt(samples); }
};

/// Of a[i] and b[i + shift] where both are known; none where too few are.
Correlation correlationAt(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t shift,
                          std::size_t least) {
    double n = 0.0, sumA = 0.0, sumB = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    const auto from = std::max<std::ptrdiff_t>(0, -shift);
    const auto to = std::min<std::ptrdiff_t>(std::ssize(a), std::ssize(b) - shift);
    for (std::ptrdiff_t i = from; i < to; ++i) {
        const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i + shift)];
        if (std::isnan(x) || std::isnan(y)) continue;
        n += 1.0;
        sumA += x;
        sumB += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    if (n < static_cast<double>(least)) return {};
    const double varA = aa - sumA * sumA / n, varB = bb - sumB * sumB / n;
    if (!(varA > 1e-9 * n) || !(varB > 1e-9 * n)) return {};
    return {(ab - sumA * sumB / n) / std::sqrt(varA * varB), n};
}

/// Where the parabola through three correlations is highest, in steps from the middle one.
double peakOf(double before, double middle, double after) {
    const double bend = before - 2.0 * middle + after;
    return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

} // namespace

ClockOffset clockOffset(const PoseTrack& a, const PoseTrack& b) {
    const std::vector<double> speedsA = speedsOf(a), speedsB = speedsOf(b);
    const auto known = [](const std::vector<double>& speeds) {
        return static_cast<std::size_t>(std::ranges::count_if(speeds, [](double s) { return !std::isnan(s); }));
    };
    const auto least = static_cast<std::size_t>(kShared * double(std::min(known(speedsA), known(speedsB))));
    ClockOffset found;
    if (least < 25) return found; // half a second
    const std::ptrdiff_t first = 1 - std::ssize(speedsA), last = std::ssize(speedsB);
    std::vector<Correlation> correlations;
    for (std::ptrdiff_t shift = first; shift < last; ++shift)
        correlations.push_back(correlationAt(speedsA, speedsB, shift, least));
    const auto best = std::ranges::max_element(correlations, {}, &Correlation::evidence);
    const std::ptrdiff_t at = best - correlations.begin();
    found.correlation = std::max(0.0, best->value);
    for (std::ptrdiff_t i = 0; i < std::ssize(correlations); ++i)
        if (std::abs(i - at) > kElsewhere)
            found.runnerUp = std::max(found.runnerUp, correlations[static_cast<std::size_t>(i)].evidence());
    found.runnerUp /= std::max(1e-9, best->evidence());
    const bool inside = at > 0 && at + 1 < std::ssize(correlations);
    const double beside = inside ? peakOf((best - 1)->value, best->value, (best + 1)->value) : 0.0;
    const double steps = static_cast<double>(first + at) + beside;
    found.seconds = b.poses.front().seconds - a.poses.front().seconds + kSpeedStep * steps;
    return found;
}

} // namespace lumorph
