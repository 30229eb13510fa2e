#include "devices/simulator/servo_bank.h"

#include <algorithm>
#include <cmath>

namespace lumorph {

namespace {

constexpr double kLowEnd = 500.0; // microseconds; the horn's stops
constexpr double kHighEnd = 2500.0;
constexpr double kStill = 1.0; // microseconds

/// Commands closer than this are one: no wire carries two to the same servo in that time, so they came out of a buffer.
constexpr Microseconds kOneCommand{1000};

double secondsOf(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

double wayToGo(const SimulatedServo& servo) {
    return servo.pulse > 0.0 ? std::clamp(servo.pulse, kLowEnd, kHighEnd) - servo.position : 0.0;
}

} // namespace

ServoBank::ServoBank(std::size_t count, double speed) : speed_(speed), servos_(count), commands_(count) {}

void ServoBank::advance(Microseconds now) {
    if (now <= now_) return;
    const double reach = speed_ * secondsOf(now - now_);
    for (std::size_t k = 0; k < servos_.size(); ++k)
        if (k != held_) servos_[k].position += std::clamp(wayToGo(servos_[k]), -reach, reach);
    now_ = now;
}

void ServoBank::setPulse(std::size_t servo, double microseconds) {
    if (servo >= servos_.size()) return;
    if (microseconds > 0.0) measure(servos_[servo], commands_[servo], microseconds);
    servos_[servo].pulse = std::max(0.0, microseconds);
}

void ServoBank::measure(SimulatedServo& servo, Commands& commands, double pulse) const {
    if (servo.pulse <= 0.0) {
        commands = {.newest = now_};
    } else if (now_ - commands.newest >= kOneCommand) {
        commands = {.newest = now_, .isFirst = false, .before = commands.newest, .pulseBefore = servo.pulse};
    }
    if (commands.isFirst) {
        servo.largestJump = std::max(servo.largestJump, std::abs(pulse - servo.position));
    } else {
        const double speed = std::abs(pulse - commands.pulseBefore) / secondsOf(now_ - commands.before);
        servo.fastest = std::max(servo.fastest, speed);
    }
}

void ServoBank::allLimp() {
    for (SimulatedServo& servo : servos_) servo.pulse = 0.0;
}

std::size_t ServoBank::moving() const noexcept {
    return static_cast<std::size_t>(
        std::ranges::count_if(servos_, [](const SimulatedServo& servo) { return std::abs(wayToGo(servo)) > kStill; }));
}

} // namespace lumorph
