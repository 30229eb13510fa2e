#include "app/studio/devices/held_servos.h"

#include <algorithm>

namespace lumorph::studio {

void HeldServos::look(Servo& servo, const ServoStatus& status, Microseconds now) {
    if (!status.attached) {
        servo = {};
        return;
    }
    if (!servo.told.empty() && now < servo.told.back().first) servo = {}; // the clock was set back
    servo.told.emplace_back(now, status.commanded);
    // The newest that is older than that is where it was told to be when that time began.
    while (servo.told.size() > 1 && now - servo.told[1].first >= kArrives) servo.told.pop_front();
    const bool judged = status.readBack && now - servo.told.front().first >= kArrives;
    const auto [least, most] = std::ranges::minmax(servo.told, {}, [](const auto& one) { return one.second; });
    const bool far = judged && (*status.readBack < least.second - kFar || *status.readBack > most.second + kFar);
    if (far == servo.held) {
        servo.changing.reset();
        return;
    }
    if (!servo.changing) {
        servo.changing = now;
        servo.went = servo.meant = {};
    }
    servo.went.take(status.readBack.value_or(status.commanded));
    servo.meant.take(status.commanded);
    if (now - *servo.changing < (far ? kHeldFor : kFreeFor)) return;
    // A show that comes by where a servo is held does not free it.
    if (servo.held && servo.went.width() < servo.meant.width() - kFar) {
        servo.changing.reset();
        return;
    }
    servo.held = far;
    servo.changing.reset();
}

void HeldServos::look(const LinkStatus& status, Microseconds now) {
    servos_.resize(status.servos.size());
    held_.clear();
    for (std::size_t k = 0; k < servos_.size(); ++k) {
        look(servos_[k], status.servos[k], now);
        if (servos_[k].held) held_.push_back(k);
    }
}

void HeldServos::forget() {
    servos_.clear();
    held_.clear();
}

} // namespace lumorph::studio
