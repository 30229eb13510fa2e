#include "core/scene/measured_servos.h"

#include <algorithm>
#include <cmath>

namespace lumorph {

namespace {

using Point = MeasuredServo::Point;

/// Where both curves lead at a command, the lower one first.
struct Bounds {
    double rising = 0.0, falling = 0.0;
};

double between(double a, double b, double share) { return a + share * (b - a); }

Bounds boundsAt(const std::vector<Point>& points, double commanded) noexcept {
    const auto above = std::ranges::upper_bound(points, commanded, {}, &Point::commanded);
    const Point& high = above == points.end() ? points.back() : *above;
    const Point& low = above == points.begin() ? points.front() : *(above - 1);
    const double way = high.commanded - low.commanded;
    const double share = way > 0.0 ? std::clamp((commanded - low.commanded) / way, 0.0, 1.0) : 0.0;
    const double rising = std::clamp(between(low.rising, high.rising, share), 0.0, 1.0);
    const double falling = std::clamp(between(low.falling, high.falling, share), 0.0, 1.0);
    return {std::min(rising, falling), std::max(rising, falling)};
}

/// The curves as they are used: neither ever sinks, and the falling one is never below the rising one.
MeasuredServo sound(MeasuredServo servo) {
    double rising = -HUGE_VAL, falling = -HUGE_VAL;
    for (Point& point : servo.points) {
        rising = std::max(rising, std::min(point.rising, point.falling));
        falling = std::max(falling, std::max(point.rising, point.falling));
        point.rising = rising;
        point.falling = falling;
    }
    return servo;
}

/// The command at which one curve leads to `real`: the lowest such one of the rising curve and the highest of the
/// falling one, where it is level; the nearer end where it never gets there.
double inverseOf(const std::vector<Point>& points, double Point::*curve, double real) {
    if (real <= points.front().*curve) return points.front().commanded;
    if (real >= points.back().*curve) {
        const auto first = std::ranges::lower_bound(points, points.back().*curve, {}, curve);
        return first->commanded;
    }
    const auto above = std::ranges::upper_bound(points, real, {}, curve);
    const Point &low = *(above - 1), &high = *above;
    const double way = high.*curve - low.*curve;
    return between(low.commanded, high.commanded, (real - low.*curve) / way);
}

double commandFor(const MeasuredServo& servo, double wanted, double real, double commanded) {
    if (servo.points.empty()) return wanted;
    const double way = wanted - real;
    const Bounds bounds = boundsAt(servo.points, commanded);
    const bool followsUp = real <= bounds.rising, followsDown = real >= bounds.falling;
    if (way > 0.0 && (followsUp || way > ServoCurves::kTurn)) return inverseOf(servo.points, &Point::rising, wanted);
    if (way < 0.0 && (followsDown || -way > ServoCurves::kTurn))
        return inverseOf(servo.points, &Point::falling, wanted);
    return commanded;
}

} // namespace

double realStroke(const MeasuredServo& servo, double commanded, double previous) noexcept {
    if (servo.points.empty()) return commanded;
    const Bounds bounds = boundsAt(servo.points, commanded);
    return std::clamp(previous, bounds.rising, bounds.falling);
}

StrokeRange reachOf(const MeasuredServo& servo) noexcept {
    if (servo.points.empty()) return {};
    return {boundsAt(servo.points, 0.0).falling, boundsAt(servo.points, 1.0).rising};
}

std::vector<double> lagsOf(std::span<const Actuator> actuators, std::span<const MeasuredServo> servos) {
    std::vector<double> lags;
    for (const Actuator& actuator : actuators) {
        const auto servo = std::ranges::find(servos, actuator.name, &MeasuredServo::actuator);
        lags.push_back(servo == servos.end() ? 0.0 : servo->lagSeconds);
    }
    return lags;
}

ServoCurves::ServoCurves(std::span<const Actuator> actuators, std::span<const MeasuredServo> servos) {
    std::vector<MeasuredServo> found;
    bool any = false;
    for (const Actuator& actuator : actuators) {
        const auto servo = std::ranges::find(servos, actuator.name, &MeasuredServo::actuator);
        const bool measured = servo != servos.end() && servo->points.size() >= 2;
        found.push_back(measured ? sound(*servo) : MeasuredServo{.actuator = actuator.name, .points = {}});
        any = any || measured;
    }
    if (!any) return;
    servos_ = std::move(found);
    for (const MeasuredServo& servo : servos_) {
        const StrokeRange reach = reachOf(servo);
        reach_.push_back({std::min(reach.low, reach.high), reach.high});
    }
}

std::vector<double> ServoCurves::commandsFor(std::span<const double> wanted, std::span<const double> real,
                                             std::span<const double> commanded) const {
    std::vector<double> commands(wanted.begin(), wanted.end());
    for (std::size_t i = 0; i < servos_.size() && i < commands.size(); ++i)
        commands[i] = commandFor(servos_[i], wanted[i], real[i], commanded[i]);
    return commands;
}

void ServoCurves::follow(std::span<const double> commanded, std::span<double> real) const noexcept {
    if (empty()) {
        std::ranges::copy(commanded, real.begin());
        return;
    }
    for (std::size_t i = 0; i < real.size(); ++i) real[i] = realStroke(servos_[i], commanded[i], real[i]);
}

std::vector<double> ServoCurves::commandsAt(std::span<const double> real) const {
    std::vector<double> commands(real.begin(), real.end());
    for (std::size_t i = 0; i < servos_.size() && i < commands.size(); ++i) {
        const auto& points = servos_[i].points;
        if (points.empty()) continue;
        commands[i] = 0.5 * (inverseOf(points, &Point::rising, real[i]) + inverseOf(points, &Point::falling, real[i]));
    }
    return commands;
}

void ServoCurves::limit(std::span<double> wanted) const noexcept {
    for (std::size_t i = 0; i < servos_.size() && i < wanted.size(); ++i)
        if (!servos_[i].points.empty()) wanted[i] = std::clamp(wanted[i], reach_[i].low, reach_[i].high);
}

} // namespace lumorph
