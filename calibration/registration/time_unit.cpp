#include "calibration/registration/time_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::number;

constexpr double kLongestStep = 0.35; ///< seconds, as the longest gap of poseAt
constexpr std::size_t kLeastPoses = 20;
constexpr double kLongestFrameStep = 3.0;

// The search for a frame rate.
constexpr double kMostLonger = 3.0;      ///< one recording than the other
constexpr double kFirstSpan = 40.0;      ///< seconds of both that are compared first
constexpr double kStray = 0.25;          ///< seconds by which the end of a span may err while it still correlates
constexpr double kSureCorrelation = 0.8; ///< of angular speeds

double stepOf(const PoseTrack& track) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.poses.size(); ++i)
        steps.push_back(std::abs(track.poses[i].seconds - track.poses[i - 1].seconds));
    return median(std::move(steps));
}

double lengthOf(const PoseTrack& track) { return track.poses.back().seconds - track.poses.front().seconds; }

PoseTrack scaled(PoseTrack track, double seconds) {
    for (TimedPose& at : track.poses) at.seconds *= seconds;
    return track;
}

/// The part in its middle, that long.
PoseTrack middleOf(const PoseTrack& track, double seconds) {
    const double middle = 0.5 * (track.poses.front().seconds + track.poses.back().seconds);
    PoseTrack part;
    std::ranges::copy_if(track.poses, std::back_inserter(part.poses),
                         [&](const TimedPose& at) { return std::abs(at.seconds - middle) <= 0.5 * seconds; });
    return part;
}

struct Rate {
    double framesPerSecond = 0.0, evidence = 0.0, correlation = 0.0;
};

/// The best of rates from `low` to `high`, each `factor` times the one before, by a span of the frames.
Rate bestRate(const PoseTrack& other, const PoseTrack& frames, double low, double high, double factor, double span,
              const Progress& progress) {
    Rate best;
    for (double rate = low; rate <= high; rate *= factor) {
        progress.throwIfCancelled();
        progress.report(std::log(rate / low) / std::log(high / low), "frame rate");
        const PoseTrack part = middleOf(scaled(frames, 1.0 / rate), span);
        if (part.poses.size() < kLeastPoses) continue;
        const ClockOffset clocks = clockOffset(other, part);
        const double shared = std::min(lengthOf(part), lengthOf(other));
        const double evidence = std::atanh(std::clamp(clocks.correlation, 0.0, 0.999999)) * std::sqrt(shared);
        if (evidence > best.evidence) best = {rate, evidence, clocks.correlation};
    }
    return best;
}

/// Both halves of the frames tell their own offset; where these differ, the rate is a little off.
double nearerRate(const PoseTrack& other, const PoseTrack& frames, double rate) {
    const PoseTrack seconds = scaled(frames, 1.0 / rate);
    const double middle = 0.5 * (seconds.poses.front().seconds + seconds.poses.back().seconds);
    PoseTrack early, late;
    for (const TimedPose& at : seconds.poses) (at.seconds < middle ? early : late).poses.push_back(at);
    if (early.poses.size() < kLeastPoses || late.poses.size() < kLeastPoses) return rate;
    const ClockOffset first = clockOffset(other, early), second = clockOffset(other, late);
    const double gains = (second.seconds - first.seconds) / (second.middle - first.middle);
    const bool isKnown = std::min(first.correlation, second.correlation) > kSureCorrelation;
    return isKnown && std::abs(gains) < 0.02 ? rate / (1.0 - gains) : rate;
}

} // namespace

TimeUnit likelyTimeUnit(const PoseTrack& track) {
    if (track.poses.size() < kLeastPoses || countsFrames(track)) return {};
    constexpr std::array kUnits{TimeUnit{}, TimeUnit{1e-3, "milliseconds"}, TimeUnit{1e-6, "microseconds"},
                                TimeUnit{1e-9, "nanoseconds"}};
    constexpr double kShortestStep = 1e-3; // no tracker has more poses a second
    const double step = stepOf(track);
    for (const TimeUnit& unit : kUnits)
        if (step * unit.seconds <= kLongestStep)
            return unit.seconds == 1.0 || step * unit.seconds >= kShortestStep ? unit : TimeUnit{};
    return {};
}

bool countsFrames(const PoseTrack& track) {
    const double step = stepOf(track);
    return track.poses.size() >= kLeastPoses && step >= 1.0 && step <= kLongestFrameStep &&
           std::ranges::all_of(track.poses, [](const TimedPose& at) { return at.seconds == std::round(at.seconds); });
}

PoseTrack inSeconds(PoseTrack track, const std::string& name) {
    const TimeUnit unit = likelyTimeUnit(track);
    if (unit.seconds == 1.0) return track;
    PoseTrack seconds = scaled(std::move(track), unit.seconds);
    seconds.warnings.push_back(
        {Cause::timeUnit,
         name,
         {},
         std::string("its times are ") + unit.name + ": " + number(1.0 / stepOf(seconds), 0) + " poses a second",
         "they were taken as that; write seconds"});
    return seconds;
}

PoseTrack inKnownSeconds(PoseTrack track, const std::string& name) {
    if (countsFrames(track))
        registration::refuse(Cause::timeUnit, name.c_str(),
                             "its times are whole numbers that follow one another, as frames do",
                             "divide them by the frame rate, so that they are seconds");
    return inSeconds(std::move(track), name);
}

std::optional<PoseTrack> inSecondsBy(const PoseTrack& other, PoseTrack frames, const std::string& name,
                                     const Progress& progress) {
    const double length = lengthOf(other), count = lengthOf(frames);
    double low = count / (kMostLonger * length), high = kMostLonger * count / length, span = kFirstSpan;
    // A rate that is wrong by a share errs by that share of half the span at its ends.
    const auto factorOf = [](double seconds) { return 1.0 + kStray / seconds; };
    Rate best = bestRate(other, frames, low, high, factorOf(std::min(span, length)), span, progress.part(0.0, 0.8));
    if (best.correlation < 0.5) return std::nullopt;
    // Nearer with the whole, by spans that double: each tells the rate well enough to find the next one's.
    while (true) {
        const double used = std::min({span, length, count / best.framesPerSecond});
        const double from = std::pow(factorOf(used), 1.5);
        low = best.framesPerSecond / from;
        high = best.framesPerSecond * from;
        best = bestRate(other, frames, low, high, std::pow(high / low, 1.0 / 24.0), span, progress.part(0.8, 1.0));
        if (span >= count / best.framesPerSecond) break;
        span *= 2.0;
    }
    if (best.correlation < kSureCorrelation) return std::nullopt;
    for (int round = 0; round < 2; ++round) best.framesPerSecond = nearerRate(other, frames, best.framesPerSecond);
    PoseTrack found = scaled(std::move(frames), 1.0 / best.framesPerSecond);
    found.warnings.push_back({Cause::timeUnit,
                              name,
                              {},
                              "its times count frames, " + number(best.framesPerSecond, 2) + " a second",
                              "they were taken as that; write seconds"});
    return found;
}

} // namespace lumorph
