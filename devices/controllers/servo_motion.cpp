#include "devices/controllers/servo_motion.h"

#include <algorithm>
#include <cmath>

namespace lumorph {
namespace {

/// The greatest speed v from which it can still be stopped in time: v dt is gone with this step, and v^2 / 2a is the
/// longest that braking takes, whatever the steps are (each brakes first and moves then). So v dt + v^2 / 2a =
/// distance.
double approachSpeed(double distance, double seconds, double acceleration) noexcept {
    const double gained = acceleration * seconds;
    return 2.0 * acceleration * distance / (gained + std::sqrt(gained * gained + 2.0 * acceleration * distance));
}

/// For a velocity >= 0: how far it may change, braking, turning back and speeding up.
struct Reach {
    double low;
    double high;
};

Reach reachOf(double velocity, double seconds, const ServoMotionLimits& limits) noexcept {
    return {std::max(velocity - limits.brake * seconds, -limits.speedUp * seconds),
            velocity + limits.speedUp * seconds};
}

} // namespace

ServoMotion movedServo(ServoMotion now, double target, double seconds, const ServoMotionLimits& limits) noexcept {
    // What is left shrinks quadratically, but rounding would let it tremble in the last digit for ever.
    constexpr double kThere = 1e-12;
    constexpr double kStill = 1e-9;
    if (seconds <= 0.0) return now;
    const double way = target - now.position;
    if (std::abs(way) < kThere && std::abs(now.velocity) < kStill) return {target, 0.0};

    const double speed =
        way == 0.0 ? 0.0 : std::min(limits.velocity, approachSpeed(std::abs(way), seconds, limits.speedUp));
    const double side = now.velocity < 0.0 ? -1.0 : 1.0;
    const Reach reach = reachOf(side * now.velocity, seconds, limits);
    const double velocity = side * std::clamp(side * std::copysign(speed, way), reach.low, reach.high);
    return {now.position + velocity * seconds, velocity};
}

} // namespace lumorph
