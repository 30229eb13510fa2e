#include "core/motion/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace lumorph {
namespace {

// The approach seen from the target: the way left and the speed at which it shrinks, both >= 0.
struct Approach {
    double distance;
    double speed;
};

// The linear response: distance' = -speed, speed' = w^2 distance - 2 a speed, with decay rates
// a - d <= a + d. Between target changes 0 <= speed <= fast * distance holds: rest only accelerates,
// and the other border is the mode that decays fastest.
class Response {
public:
    explicit Response(const MotionLimits& limits)
        : frequency_(1.0 / limits.settleSeconds), mean_(limits.dampingRatio * frequency_),
          difference_(frequency_ * std::sqrt((limits.dampingRatio - 1.0) * (limits.dampingRatio + 1.0))),
          fast_(mean_ + difference_), slow_(frequency_ * frequency_ / fast_), limit_(limits.maxVelocity) {}

    [[nodiscard]] Approach allowed(Approach a) const noexcept {
        a.distance = std::max(a.distance, 0.0);
        a.speed = std::clamp(a.speed, 0.0, std::min(limit_, fast_ * a.distance));
        return a;
    }

    // Exact for any time: free until the speed meets the limit, along the limit while the response
    // would still accelerate, free to the end. It cannot meet the limit twice.
    [[nodiscard]] Approach after(Approach a, double seconds) const noexcept {
        const double peak = std::min(timeOfPeak(a), seconds);
        if (free(a, peak).speed >= limit_) {
            const double met = timeOfLimit(a, peak);
            a = {free(a, met).distance, limit_};
            seconds -= met;
            const double cruise = std::clamp((a.distance - brakingDistance()) / limit_, 0.0, seconds);
            a.distance -= cruise * limit_;
            seconds -= cruise;
        }
        return allowed(free(a, seconds));
    }

private:
    // Matrix exponential of the response, written with decaying terms only so that nothing overflows.
    [[nodiscard]] Approach free(const Approach& a, double t) const noexcept {
        const double slowTerm = std::exp(-slow_ * t);
        const double even = 0.5 * (slowTerm + std::exp(-fast_ * t));
        const double gap = 2.0 * difference_ * t;
        const double odd = slowTerm * t * (gap > 0.0 ? -std::expm1(-gap) / gap : 1.0);
        return {even * a.distance + odd * (mean_ * a.distance - a.speed),
                even * a.speed + odd * (frequency_ * frequency_ * a.distance - mean_ * a.speed)};
    }

    // When the speed is highest: tanh(d t) / d = acceleration / (w^2 speed + a acceleration).
    [[nodiscard]] double timeOfPeak(const Approach& a) const noexcept {
        const double acceleration = frequency_ * frequency_ * a.distance - 2.0 * mean_ * a.speed;
        if (acceleration <= 0.0) return 0.0;
        const double ratio = acceleration / (frequency_ * frequency_ * a.speed + mean_ * acceleration);
        const double argument = difference_ * ratio;
        return argument > 1e-8 ? std::atanh(std::min(argument, 1.0)) / difference_ : ratio;
    }

    // The speed rises over [0, peak] and is at or above the limit at its end.
    [[nodiscard]] double timeOfLimit(const Approach& a, double peak) const noexcept {
        double before = 0.0;
        double after = peak;
        for (int i = 0; i < 64 && a.speed < limit_; ++i) {
            const double middle = 0.5 * (before + after);
            (free(a, middle).speed < limit_ ? before : after) = middle;
        }
        return before;
    }

    [[nodiscard]] double brakingDistance() const noexcept { return 2.0 * mean_ * limit_ / (frequency_ * frequency_); }

    double frequency_;
    double mean_;
    double difference_;
    double fast_;
    double slow_;
    double limit_;
};

void requireWithin(const char* what, double value, double low, double high, const char* remedy) {
    if (value >= low && value <= high) return;
    throw InvalidInput(what, std::to_string(value) + " is not a number this motion can take", remedy);
}

void requireValid(const MotionLimits& limits) {
    requireWithin("maximum velocity", limits.maxVelocity, 1e-6, 1e6, "use 1e-6 to 1e6 strokes a second");
    requireWithin("damping ratio", limits.dampingRatio, 1.0, 1e3, "use 1 (critical) to 1000");
    requireWithin("settle time", limits.settleSeconds, 1e-6, 1e6, "use 1e-6 to 1e6 seconds");
}

void requirePosition(const char* what, double value) { requireWithin(what, value, 0.0, 1.0, "use a stroke in [0, 1]"); }

void requireVelocity(double value) {
    requireWithin("velocity", value, std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                  "use a finite velocity");
}

void requireTime(double seconds) {
    requireWithin("time step", seconds, 0.0, std::numeric_limits<double>::max(),
                  "use a finite time that does not run backwards");
}

void requireCount(std::size_t count, std::size_t actuators) {
    if (count == actuators) return;
    throw InvalidInput("motion", std::to_string(count) + " values for " + std::to_string(actuators) + " actuators",
                       "give one value for each actuator");
}

MotionState moved(MotionState now, double target, double seconds, const MotionLimits& limits) noexcept {
    const double way = target - now.position;
    const double direction = way < 0.0 ? -1.0 : 1.0;
    const Response response(limits);
    const Approach start = response.allowed({std::abs(way), direction * now.velocity});
    const Approach end = response.after(start, seconds);
    const double step = std::clamp(start.distance - end.distance, 0.0, limits.maxVelocity * seconds);
    const auto [low, high] = std::minmax(now.position, target);
    return {std::clamp(now.position + direction * step, low, high), direction * end.speed};
}

} // namespace

MotionState advance(MotionState now, double target, double seconds, const MotionLimits& limits) {
    requireValid(limits);
    requirePosition("position", now.position);
    requireVelocity(now.velocity);
    requirePosition("target", target);
    requireTime(seconds);
    return moved(now, target, seconds, limits);
}

MotionModel::MotionModel(std::vector<MotionLimits> limits)
    : limits_(std::move(limits)), positions_(limits_.size(), 0.0), velocities_(limits_.size(), 0.0) {
    for (const MotionLimits& limit : limits_) requireValid(limit);
}

std::span<const double> MotionModel::step(std::span<const double> targets, double seconds) {
    requireCount(targets.size(), limits_.size());
    requireTime(seconds);
    for (const double target : targets) requirePosition("target", target);
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const MotionState next = moved({positions_[i], velocities_[i]}, targets[i], seconds, limits_[i]);
        positions_[i] = next.position;
        velocities_[i] = next.velocity;
    }
    return positions_;
}

void MotionModel::reset(std::span<const double> positions) {
    requireCount(positions.size(), limits_.size());
    for (const double position : positions) requirePosition("position", position);
    std::copy(positions.begin(), positions.end(), positions_.begin());
    std::fill(velocities_.begin(), velocities_.end(), 0.0);
}

void MotionModel::resume(std::span<const double> positions, std::span<const double> velocities) {
    requireCount(velocities.size(), limits_.size());
    for (const double velocity : velocities) requireVelocity(velocity);
    reset(positions);
    std::copy(velocities.begin(), velocities.end(), velocities_.begin());
}

} // namespace lumorph
