#include "core/motion/stroke_lead.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace lumorph {
namespace {

/// How much of the past makes a trend. A longer one passes the end of a change by more than two levels of 33.
constexpr double kPastSeconds = 0.15;

} // namespace

StrokeLead::StrokeLead(std::span<const MotionLimits> limits) {
    // A damped approach follows a ramp by so much behind.
    for (const MotionLimits& limit : limits) lags_.push_back(2.0 * limit.dampingRatio * limit.settleSeconds);
}

std::span<const double> StrokeLead::step(std::span<const double> wanted, double seconds) {
    if (wanted.size() != lags_.size() || !(seconds >= 0.0) || !std::isfinite(seconds))
        throw InvalidInput("strokes of a frame",
                           std::to_string(wanted.size()) + " for " + std::to_string(lags_.size()) +
                               " actuators after " + std::to_string(seconds) + " s",
                           "give one for each actuator, and a time that does not run backwards");
    past_.push_back({seconds, {wanted.begin(), wanted.end()}});
    double age = 0.0; // of the oldest that is kept
    std::size_t kept = 1;
    while (kept < past_.size() && age + past_[past_.size() - kept].seconds <= kPastSeconds) {
        age += past_[past_.size() - kept].seconds;
        ++kept;
    }
    past_.erase(past_.begin(), past_.end() - static_cast<std::ptrdiff_t>(kept));
    commands_.resize(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
        commands_[i] = std::clamp(wanted[i] + lags_[i] * trendOf(i), 0.0, 1.0);
    return commands_;
}

/// Slope of the line through the past, strokes a second, by the share of the change that the line explains: a jump is
/// no trend.
double StrokeLead::trendOf(std::size_t actuator) const noexcept {
    double time = 0.0, sumTime = 0.0, sumStroke = 0.0;
    for (auto frame = past_.rbegin(); frame != past_.rend(); ++frame) {
        sumTime += time;
        sumStroke += frame->strokes[actuator];
        time -= frame->seconds;
    }
    const auto count = static_cast<double>(past_.size());
    const double meanTime = sumTime / count, meanStroke = sumStroke / count;
    double times = 0.0, strokes = 0.0, both = 0.0;
    time = 0.0;
    for (auto frame = past_.rbegin(); frame != past_.rend(); ++frame) {
        const double t = time - meanTime, s = frame->strokes[actuator] - meanStroke;
        times += t * t;
        strokes += s * s;
        both += t * s;
        time -= frame->seconds;
    }
    if (!(times > 0.0) || !(strokes > 0.0)) return 0.0;
    return both / times * (both * both / (times * strokes));
}

} // namespace lumorph
