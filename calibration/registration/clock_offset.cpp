#include "calibration/registration/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include <opencv2/core.hpp>

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

/// What one recording adds to the sums of Pearson's correlation, 0 in gaps.
struct Series {
    explicit Series(const std::vector<double>& speeds) : size(std::ssize(speeds)) {
        double sum = 0.0;
        for (const double speed : speeds)
            if (!std::isnan(speed)) sum += speed, ++known;
        const double mean = known > 0 ? sum / static_cast<double>(known) : 0.0; // correlations do not depend on it
        for (const double speed : speeds) {
            const bool is = !std::isnan(speed);
            const double value = is ? speed - mean : 0.0;
            counts.push_back(is ? 1.0 : 0.0);
            values.push_back(value);
            squares.push_back(value * value);
        }
    }
    std::ptrdiff_t size = 0;
    std::size_t known = 0;
    std::vector<double> counts, values, squares;
};

/// sum_i a[i] b[i + shift] for all shifts that leave an overlap, from 1 - a.size() on, by Fourier transforms.
class Products {
public:
    Products(const Series& a, const Series& b)
        : first_(1 - a.size), shifts_(a.size + b.size - 1), length_(cv::getOptimalDFTSize(static_cast<int>(shifts_))) {}

    [[nodiscard]] std::vector<double> of(const std::vector<double>& a, const std::vector<double>& b) const {
        cv::Mat product;
        cv::mulSpectrums(spectrum(b), spectrum(a), product, 0, true);
        cv::Mat sums;
        cv::dft(product, sums, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
        std::vector<double> all(static_cast<std::size_t>(shifts_));
        for (std::ptrdiff_t k = 0; k < shifts_; ++k) // a shift below 0 is at the end
            all[static_cast<std::size_t>(k)] = sums.at<double>(0, static_cast<int>((first_ + k + length_) % length_));
        return all;
    }

private:
    [[nodiscard]] cv::Mat spectrum(const std::vector<double>& series) const {
        cv::Mat padded = cv::Mat::zeros(1, length_, CV_64F);
        std::ranges::copy(series, padded.ptr<double>());
        cv::dft(padded, padded);
        return padded;
    }
    std::ptrdiff_t first_, shifts_;
    int length_;
};

/// Of a[i] and b[i + shift] where both are known, for each shift; none where fewer than `least` are.
std::vector<Correlation> correlationsOf(const Series& a, const Series& b, std::size_t least) {
    const Products products(a, b);
    const std::vector<double> counts = products.of(a.counts, b.counts);
    const std::vector<double> sumsA = products.of(a.values, b.counts), sumsB = products.of(a.counts, b.values);
    const std::vector<double> aa = products.of(a.squares, b.counts), bb = products.of(a.counts, b.squares);
    const std::vector<double> ab = products.of(a.values, b.values);
    std::vector<Correlation> correlations(counts.size());
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const double n = std::round(counts[k]);
        if (n < static_cast<double>(least)) continue;
        const double varA = aa[k] - sumsA[k] * sumsA[k] / n, varB = bb[k] - sumsB[k] * sumsB[k] / n;
        if (!(varA > 1e-9 * n) || !(varB > 1e-9 * n)) continue;
        correlations[k] = {(ab[k] - sumsA[k] * sumsB[k] / n) / std::sqrt(varA * varB), n};
    }
    return correlations;
}

/// Where the parabola through three correlations is highest, in steps from the middle one.
double peakOf(double before, double middle, double after) {
    const double bend = before - 2.0 * middle + after;
    return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

} // namespace

ClockOffset clockOffset(const PoseTrack& a, const PoseTrack& b) {
    const Series seriesA(speedsOf(a)), seriesB(speedsOf(b));
    const auto least = static_cast<std::size_t>(kShared * double(std::min(seriesA.known, seriesB.known)));
    ClockOffset found;
    if (least < 25) return found; // half a second
    const std::vector<Correlation> correlations = correlationsOf(seriesA, seriesB, least);
    const auto best = std::ranges::max_element(correlations, {}, &Correlation::evidence);
    const std::ptrdiff_t at = best - correlations.begin();
    found.correlation = std::max(0.0, best->value);
    for (std::ptrdiff_t i = 0; i < std::ssize(correlations); ++i)
        if (std::abs(i - at) > kElsewhere)
            found.runnerUp = std::max(found.runnerUp, correlations[static_cast<std::size_t>(i)].evidence());
    found.runnerUp /= std::max(1e-9, best->evidence());
    const bool inside = at > 0 && at + 1 < std::ssize(correlations);
    const double beside = inside ? peakOf((best - 1)->value, best->value, (best + 1)->value) : 0.0;
    const double steps = static_cast<double>(1 - seriesA.size + at) + beside;
    found.seconds = b.poses.front().seconds - a.poses.front().seconds + kSpeedStep * steps;
    return found;
}

} // namespace lumorph
