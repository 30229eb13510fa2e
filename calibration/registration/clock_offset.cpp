#include "calibration/registration/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "core/base/statistics.h"

namespace lumorph {

namespace {

constexpr double kWindow = 0.16;          ///< seconds over which a turn is measured: noise of single poses averages out
constexpr double kShared = 1.0 / 3.0;     ///< of the shorter recording
constexpr double kFastest = 2.5;          ///< times the usual speed
constexpr double kMostlyRests = 0.5;      ///< of the usual speed of what moves: the median is of rests
constexpr double kFastestHand = 15.0;     ///< radians a second that a body is turned at
constexpr std::ptrdiff_t kElsewhere = 25; ///< steps from the best offset: another peak
constexpr std::size_t kMostSteps = 60'000; ///< 20 minutes

// The drift, by the offsets of parts.
constexpr std::size_t kParts = 12;
constexpr double kLeastPart = 5.0;      ///< seconds
constexpr std::ptrdiff_t kAround = 25;  ///< steps around the offset of the whole
constexpr double kSurePart = 0.7;       ///< correlation of a part whose offset counts
constexpr double kSmallDrift = 0.002;   ///< seconds over the recording that are not worth another look
constexpr double kOffLine = 0.01;       ///< seconds by which offsets of parts differ from an even drift
constexpr std::size_t kAskEvery = 4096; ///< steps between two questions whether it is cancelled
constexpr std::string_view kStage = "clocks";

/// The speed of the middle of all that was turned, not of all time: an arm may rest for most of it.
double usualSpeed(std::vector<double> speeds) {
    std::ranges::sort(speeds);
    double half = 0.0;
    for (const double speed : speeds) half += 0.5 * std::min(speed, kFastestHand);
    for (const double speed : speeds)
        if ((half -= std::min(speed, kFastestHand)) <= 0.0) return std::min(speed, kFastestHand);
    return 0.0;
}

/// Angular speeds on an even grid from the first pose on; NaN in gaps.
std::vector<double> speedsOf(const PoseTrack& track, const Progress& progress) {
    const double first = track.poses.front().seconds, last = track.poses.back().seconds;
    const auto steps = static_cast<std::size_t>(std::min((last - first) / kSpeedStep, double(kMostSteps)));
    std::vector<double> speeds(steps, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < steps; ++i) {
        if (i % kAskEvery == 0) {
            progress.throwIfCancelled();
            progress.report(static_cast<double>(i) / static_cast<double>(steps), kStage);
        }
        const double middle = first + kSpeedStep * static_cast<double>(i);
        const auto before = poseAt(track, middle - 0.5 * kWindow), after = poseAt(track, middle + 0.5 * kWindow);
        if (!before || !after) continue;
        const double speed = angleOf(glm::conjugate(before->rotation) * after->rotation) / kWindow;
        speeds[i] = speed;
    }
    // A tracker that jumps would count for more than all true turns.
    std::vector<double> known;
    std::ranges::copy_if(speeds, std::back_inserter(known), [](double speed) { return !std::isnan(speed); });
    const double middle = median(known), moving = usualSpeed(std::move(known));
    const double most = kFastest * (middle < kMostlyRests * moving ? moving : middle);
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
std::vector<Correlation> correlationsOf(const Series& a, const Series& b, std::size_t least, const Progress& progress) {
    const Products products(a, b);
    int done = 0;
    const auto of = [&](const std::vector<double>& x, const std::vector<double>& y) {
        progress.throwIfCancelled();
        progress.report(done++ / 6.0, kStage);
        return products.of(x, y);
    };
    const std::vector<double> counts = of(a.counts, b.counts);
    const std::vector<double> sumsA = of(a.values, b.counts), sumsB = of(a.counts, b.values);
    const std::vector<double> aa = of(a.squares, b.counts), bb = of(a.counts, b.squares);
    const std::vector<double> ab = of(a.values, b.values);
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

/// Pearson's correlation of a part of A's speeds with B's at one shift, NaN where too few are known.
double correlationAt(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t from, std::ptrdiff_t to,
                     std::ptrdiff_t shift) {
    double n = 0.0, sumA = 0.0, sumB = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::ptrdiff_t i = std::max(from, -shift); i < std::min(to, std::ssize(b) - shift); ++i) {
        const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i + shift)];
        if (std::isnan(x) || std::isnan(y)) continue;
        n += 1.0, sumA += x, sumB += y, aa += x * x, bb += y * y, ab += x * y;
    }
    const double varA = aa - sumA * sumA / n, varB = bb - sumB * sumB / n;
    const bool isKnown = n * kSpeedStep > 0.5 * kLeastPart && varA > 1e-9 * n && varB > 1e-9 * n;
    return isKnown ? (ab - sumA * sumB / n) / std::sqrt(varA * varB) : std::numeric_limits<double>::quiet_NaN();
}

/// Steps by which the offset differs from `shift` in a part of A's speeds; nothing where it cannot be told.
std::optional<double> offsetOfPart(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t from,
                                   std::ptrdiff_t to, std::ptrdiff_t shift) {
    std::vector<double> around;
    for (std::ptrdiff_t k = -kAround; k <= kAround; ++k) around.push_back(correlationAt(a, b, from, to, shift + k));
    if (std::ranges::any_of(around, [](double value) { return std::isnan(value); })) return std::nullopt;
    const std::ptrdiff_t best = std::ranges::max_element(around) - around.begin();
    if (best == 0 || best == 2 * kAround) return std::nullopt;
    const auto at = static_cast<std::size_t>(best);
    if (around[at] < kSurePart) return std::nullopt;
    return static_cast<double>(best - kAround) + peakOf(around[at - 1], around[at], around[at + 1]);
}

/// Offsets of parts lie on a line where one clock runs faster than the other. Seconds that B gains in one of A's; 0
/// where they do not: a clock has jumped, or the recordings are too short to tell.
double driftOf(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t shift,
               const Progress& progress) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, -shift);
    const std::ptrdiff_t last = std::min(std::ssize(a), std::ssize(b) - shift);
    if (static_cast<double>(last - first) * kSpeedStep < kParts * kLeastPart) return 0.0;
    std::vector<double> at, offsets;
    for (std::size_t part = 0; part < kParts; ++part) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(part) / kParts, kStage);
        const auto edge = [&](std::size_t k) {
            return first + static_cast<std::ptrdiff_t>(k) * (last - first) / static_cast<std::ptrdiff_t>(kParts);
        };
        const auto offset = offsetOfPart(a, b, edge(part), edge(part + 1), shift);
        if (!offset) continue;
        at.push_back(0.5 * kSpeedStep * static_cast<double>(edge(part) + edge(part + 1)));
        offsets.push_back(kSpeedStep * *offset);
    }
    if (at.size() < kParts / 2) return 0.0;
    // The median of the slopes between all pairs (Theil and Sen): single parts may be wrong.
    std::vector<double> slopes, left;
    for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) slopes.push_back((offsets[i] - offsets[k]) / (at[i] - at[k]));
    const double slope = median(std::move(slopes));
    for (std::size_t i = 0; i < at.size(); ++i) left.push_back(offsets[i] - slope * at[i]);
    const double middle = median(left);
    for (double& value : left) value = std::abs(value - middle);
    return std::abs(slope) <= kMostDrift && median(std::move(left)) < kOffLine ? slope : 0.0;
}

struct Best {
    std::ptrdiff_t shift = 0; ///< steps that B's speeds lie behind A's
    double beside = 0.0;      ///< of the peak, steps
    double correlation = 0.0, runnerUp = 0.0;
};

std::optional<Best> bestOf(const std::vector<double>& a, const std::vector<double>& b, const Progress& progress) {
    const Series seriesA(a), seriesB(b);
    const auto least = static_cast<std::size_t>(kShared * double(std::min(seriesA.known, seriesB.known)));
    if (least < 25) return std::nullopt; // half a second
    const std::vector<Correlation> correlations = correlationsOf(seriesA, seriesB, least, progress);
    const auto best = std::ranges::max_element(correlations, {}, &Correlation::evidence);
    const std::ptrdiff_t at = best - correlations.begin();
    Best found;
    found.shift = 1 - seriesA.size + at;
    found.correlation = std::max(0.0, best->value);
    for (std::ptrdiff_t i = 0; i < std::ssize(correlations); ++i)
        if (std::abs(i - at) > kElsewhere)
            found.runnerUp = std::max(found.runnerUp, correlations[static_cast<std::size_t>(i)].evidence());
    found.runnerUp /= std::max(1e-9, best->evidence());
    const bool inside = at > 0 && at + 1 < std::ssize(correlations);
    found.beside = inside ? peakOf((best - 1)->value, best->value, (best + 1)->value) : 0.0;
    return found;
}

/// By another clock, which says the same when this one says `middle`.
PoseTrack withoutDrift(PoseTrack track, double drift, double middle) {
    for (TimedPose& pose : track.poses) pose.seconds -= drift * (pose.seconds - middle);
    return track;
}

} // namespace

ClockOffset clockOffset(const PoseTrack& a, const PoseTrack& b, const Progress& progress) {
    const std::vector<double> speedsA = speedsOf(a, progress.part(0.0, 0.15));
    std::vector<double> speedsB = speedsOf(b, progress.part(0.15, 0.25));
    ClockOffset found;
    std::optional<Best> best = bestOf(speedsA, speedsB, progress.part(0.25, 0.5));
    if (!best) return found;
    const double beginA = a.poses.front().seconds, beginB = b.poses.front().seconds;
    double beginEven = beginB;
    const auto lengthB = static_cast<double>(std::ssize(speedsB)), lengthA = static_cast<double>(std::ssize(speedsA));
    const auto shift = static_cast<double>(best->shift);
    const double from = std::max(0.0, shift), to = std::min(lengthB, lengthA + shift);
    found.middle = beginB + 0.5 * kSpeedStep * (from + to);
    const double drift = driftOf(speedsA, speedsB, best->shift, progress.part(0.5, 0.6));
    if (std::abs(drift) * kSpeedStep * (to - from) > kSmallDrift) {
        const PoseTrack even = withoutDrift(b, drift, found.middle);
        speedsB = speedsOf(even, progress.part(0.6, 0.75));
        if (const auto again = bestOf(speedsA, speedsB, progress.part(0.75, 1.0));
            again && again->correlation >= best->correlation) {
            found.drift = drift;
            best = again;
            beginEven = even.poses.front().seconds;
        }
    }
    found.correlation = best->correlation;
    found.runnerUp = best->runnerUp;
    found.seconds = beginEven - beginA + kSpeedStep * (static_cast<double>(best->shift) + best->beside);
    return found;
}

} // namespace lumorph
