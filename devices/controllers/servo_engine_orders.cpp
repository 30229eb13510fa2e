// What a ServoEngine does when its user or its link tells it something.

#include <algorithm>

#include "devices/controllers/controller_kinds.h"
#include "devices/controllers/servo_engine_data.h"

namespace lumorph {
namespace {

constexpr Microseconds kRestAtMost{2'000'000};
constexpr Microseconds kCloseAfter{250'000}; // detaching is repeated meanwhile
constexpr Microseconds kTrustedRestOfOrders{2'000'000};
constexpr Microseconds kNoBeat{1'000'000}; // that the failsafe process waits for

/// The same board with the same wires: only limits and manners may differ.
bool sameWires(const DeviceProfile& made, const DeviceProfile& wanted) {
    return made.address == wanted.address && made.controller == wanted.controller && sameOptions(made, wanted) &&
           std::ranges::equal(made.servos, wanted.servos, {}, &ServoSetup::channel, &ServoSetup::channel);
}

/// A profile whose limits hold those of both: where limits are drawn in past a servo, the guard leads it back within
/// them slowly, and the controller must not cut that short. Velocities are those of `wanted`, in microseconds.
DeviceProfile hullOf(const DeviceProfile& made, const DeviceProfile& wanted) {
    DeviceProfile hull = wanted;
    for (std::size_t i = 0; i < hull.servos.size(); ++i) {
        ServoSetup& servo = hull.servos[i];
        const double span = servo.pulseMax - servo.pulseMin;
        servo.pulseMin = std::min(servo.pulseMin, made.servos[i].pulseMin);
        servo.pulseMax = std::max(servo.pulseMax, made.servos[i].pulseMax);
        servo.maxVelocity *= span / (servo.pulseMax - servo.pulseMin);
    }
    return hull;
}

} // namespace

void ServoEngine::Data::take(const servo_input::Connect&) {
    if (quitting) return;
    connected = true;
    if (closeAfter && !next) closeAfter.reset();
    if (!closeAfter) openLink();
}

void ServoEngine::Data::openLink() {
    if (std::exchange(wanted, true)) return;
    linkTrouble.reset();
    output.emplace_back(servo_output::Open{profile.identity});
}

void ServoEngine::Data::take(const servo_input::Disconnect&) {
    connected = false;
    close();
}

void ServoEngine::Data::take(const servo_input::Confirm&) {
    foreign = false;
    controller->confirm();
}

void ServoEngine::Data::take(const servo_input::Arm& arm) {
    if (quitting) return;
    if (!ready() || closeAfter) {
        tell(Kind::warning, "The servos cannot be started: the board is not ready.",
             foreign || controller->state().phase == ControllerPhase::unidentified
                 ? "Confirm first that it is the right board."
                 : "Connect it, and wait until it has answered.");
        return;
    }
    if (controller->state().traits.jumpsOnAttach && !armed())
        tell(Kind::warning, "With this firmware servos jump to their middle when they start.",
             "Keep hands away, or upload the firmware of the studio.");
    waitingTold = false;
    guard.arm(arm.jumpAllowed);
}

void ServoEngine::Data::take(const servo_input::Disarm&) { guard.disarm(); }

void ServoEngine::Data::take(const servo_input::Stop&) {
    restUntil.reset();
    if (guard.phase() != ServoGuard::Phase::stopped)
        tell(Kind::warning, "STOP: all servos are without power.", "Start them again when hands are out of the way.");
    guard.stop();
    if (!open) return;
    send();
    controller->detachAgain(); // also those that were let go before: who presses it sees one that is not
    flush(true);
}

void ServoEngine::Data::take(const servo_input::Command& command) {
    if (!quitting) (void)guard.want(command.strokes);
}

void ServoEngine::Data::take(const servo_input::Wiggle& wiggle) { (void)guard.wiggle(wiggle.servo); }

void ServoEngine::Data::take(const servo_input::Slow& order) {
    slow = order.on;
    guard.setSlow(slow);
}

void ServoEngine::Data::take(const servo_input::Profile& order) {
    // The identity of the very board that is there says nothing new.
    const bool sameBoard =
        order.profile.identity == made.identity || (open && !foreign && order.profile.identity == identity);
    if (next || !sameBoard || !sameWires(made, order.profile)) {
        next = order.profile;
        if (armed())
            tell(Kind::information, "Another board or other wires: the servos were let go.", "Start them again.");
        close();
        return;
    }
    profile = order.profile;
    made = hullOf(made, profile);
    controller->setLimits(made);
    guard.setProfile(profile);
}

void ServoEngine::Data::take(const servo_input::Quit&) {
    if (std::exchange(quitting, true)) return;
    connected = false;
    next.reset();
    if (!profile.restOnExit || !ready() || guard.phase() != ServoGuard::Phase::live) return close();
    std::vector<double> rest;
    for (const ServoSetup& servo : profile.servos) rest.push_back(servo.exitStroke);
    (void)guard.want(rest);
    restUntil = passed + kRestAtMost;
}

void ServoEngine::Data::take(const servo_input::Opened& opened) {
    open = true;
    linkTrouble.reset();
    silentSince.reset();
    silenceTold = stallTold = false;
    product = opened.product;
    identity = opened.identity;
    if (std::exchange(everOpen, true)) ++reconnects;
    foreign = !profile.identity.empty() && identity != profile.identity;
    if (foreign)
        tell(Kind::warning, "This is not the board that the profile was set up with.",
             "Plug in the right one, or confirm that its servos have the same limits.");
    made = profile; // no servo is on its way back within them
    controller->setLimits(made);
    controller->opened(product, now);
    watch.opened(controller->state());
    stalledSince.reset();
    written.clear();
    unsent = 0;
    // At once: who pressed STOP meanwhile wants nothing else said first.
    send();
    flush();
}

void ServoEngine::Data::take(const servo_input::Received& received) {
    if (!open) return;
    controller->received(received.bytes, now);
    noticeReboot();
}

void ServoEngine::Data::take(const servo_input::Lost& lost) {
    open = false;
    linkTrouble = lost.why;
    const bool wasArmed = armed();
    // What was sent last may never have arrived.
    if (wasArmed && passed - movedAt < kTrustedRestOfOrders) forget();
    guard.disarm();
    stalledSince.reset();
    silentSince.reset();
    stallTold = false;
    if (std::exchange(silenceTold, false)) return; // it was told
    tell(wasArmed ? Kind::failure : Kind::warning,
         std::string(everOpen ? "The link is lost: " : "There is no link: ") + lost.why.why + ".",
         lost.why.remedy +
             (wasArmed ? (lost.why.remedy.empty() ? "" : "; ") + std::string("start the servos again when it is back")
                       : ""));
}

void ServoEngine::Data::take(const servo_input::Released&) { letGoAfterHang(kNoBeat); }

void ServoEngine::Data::forget() {
    for (std::size_t i = 0; i < profile.servos.size(); ++i) guard.setKnown(i, std::nullopt);
}

/// Servos are let go, and the link is closed once the board should know.
void ServoEngine::Data::close() {
    restUntil.reset();
    guard.disarm();
    if (open) {
        send();
        flush();
    }
    closeAfter = passed + (open ? kCloseAfter : Microseconds{0});
}

} // namespace lumorph
