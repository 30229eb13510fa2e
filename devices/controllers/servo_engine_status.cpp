#include "devices/controllers/servo_engine_data.h"

namespace lumorph {

LinkPhase ServoEngine::Data::phase() const {
    if (closeAfter || !connected) return connected ? LinkPhase::connecting : LinkPhase::off;
    if (!open) return everOpen ? LinkPhase::lost : LinkPhase::connecting;
    if (silenceTold) return LinkPhase::lost;
    switch (controller->state().phase) {
    case ControllerPhase::handshake:
    case ControllerPhase::refused:
        return LinkPhase::handshake;
    case ControllerPhase::unidentified:
        return LinkPhase::unidentified;
    case ControllerPhase::ready:
        break;
    }
    if (foreign) return LinkPhase::unidentified;
    switch (guard.phase()) {
    case ServoGuard::Phase::disarmed:
        return LinkPhase::disarmed;
    case ServoGuard::Phase::starting:
        return LinkPhase::starting;
    case ServoGuard::Phase::live:
        // Whoever waits for the user's word does not follow yet.
        return guard.waiting().empty() ? LinkPhase::live : LinkPhase::starting;
    case ServoGuard::Phase::stopped:
        return LinkPhase::stopped;
    }
    return LinkPhase::off;
}

LinkStatus ServoEngine::Data::status() const {
    LinkStatus status;
    status.phase = phase();
    status.controller = controller->state();
    status.product = product;
    status.identity = identity;
    status.trouble = open ? controller->state().trouble : linkTrouble;
    status.waiting = guard.waiting();
    status.bytesSent = bytesSent;
    status.reconnects = reconnects;
    status.clamped = guard.clamped();
    status.refused = guard.refused();
    status.slow = slow;
    const std::span<const double> strokes = guard.strokes();
    for (std::size_t i = 0; i < profile.servos.size(); ++i) {
        ServoStatus servo;
        servo.wanted = guard.wanted(i);
        servo.commanded = strokes[i];
        if (i < status.controller.readPulses.size() && status.controller.readPulses[i])
            servo.readBack = strokeOf(profile.servos[i], *status.controller.readPulses[i]);
        if (i < pulses.size()) {
            servo.microseconds = pulses[i].microseconds;
            servo.attached = pulses[i].attached && open;
        }
        servo.known = guard.known(i).has_value();
        status.servos.push_back(servo);
    }
    return status;
}

} // namespace lumorph
