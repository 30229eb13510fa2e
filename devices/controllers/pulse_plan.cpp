#include "devices/controllers/pulse_plan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

namespace {

struct Limits {
    long least, greatest;
};

/// Values whose pulses lie within a servo's limits.
Limits limitsOf(const ServoSetup& servo, const PulseScale& scale) {
    const double least = std::max(servo.pulseMin, scale.least) - scale.zero;
    const double greatest = std::min(servo.pulseMax, scale.greatest) - scale.zero;
    return {static_cast<long>(std::ceil(least / scale.step)), static_cast<long>(std::floor(greatest / scale.step))};
}

void checkServos(const std::vector<ServoSetup>& servos, const PulseScale& scale) {
    for (std::size_t i = 0; i < servos.size(); ++i) {
        const ServoSetup& servo = servos[i];
        const bool sound = servo.pulseMin >= 0.0 && servo.pulseMin <= servo.pulseMax && servo.pulseMax <= 1e6;
        if (!sound || limitsOf(servo, scale).least > limitsOf(servo, scale).greatest)
            throw InvalidInput("servo " + std::to_string(i + 1),
                               "its controller can send no pulse from " + std::to_string(servo.pulseMin) + " to " +
                                   std::to_string(servo.pulseMax) + " us",
                               "widen its range, or choose one that this controller knows");
    }
}

} // namespace

PulsePlan::PulsePlan(std::vector<ServoSetup> servos, const PulseScale& scale)
    : servos_(std::move(servos)), scale_(scale), states_(servos_.size()) {
    setRate(scale.perSecond);
    checkServos(servos_, scale_);
}

void PulsePlan::setRate(double perSecond) {
    perSecond = std::isfinite(perSecond) ? std::clamp(perSecond, 0.1, 1000.0) : 50.0;
    period_ = Microseconds(std::lround(1e6 / perSecond));
}

void PulsePlan::setServos(std::vector<ServoSetup> servos, double perSecond) {
    servos_ = std::move(servos);
    setRate(perSecond);
}

bool PulsePlan::hasValue(std::size_t servo) const {
    const Limits limits = limitsOf(servos_[servo], scale_);
    return limits.least <= limits.greatest;
}

long PulsePlan::valueOf(std::size_t servo, double microseconds) const {
    const Limits limits = limitsOf(servos_[servo], scale_);
    const long nearest = std::lround((microseconds - scale_.zero) / scale_.step);
    return std::min(std::max(nearest, limits.least), limits.greatest);
}

void PulsePlan::restart() {
    for (State& state : states_) {
        state.held = state.held || state.attach || state.told == Told::attached;
        state.attach = false;
        state.told = Told::nothing;
    }
    pending_ = due_ = ready_ = false;
}

void PulsePlan::want(std::span<const GuardedPulse> pulses, Microseconds now, bool ready) {
    ready_ = ready;
    for (const GuardedPulse& pulse : pulses)
        for (std::size_t i = 0; i < servos_.size(); ++i)
            if (servos_[i].channel == pulse.channel) wantOne(i, pulse, ready);
    tick(now);
}

void PulsePlan::wantOne(std::size_t servo, const GuardedPulse& pulse, bool ready) {
    State& state = states_[servo];
    if (!pulse.attached) {
        state.attach = state.held = false;
        if (state.told == Told::limp) return;
        state.told = Told::limp;
        state.detachFirst = true;
        state.confirmations = 0;
        return;
    }
    if (!ready || state.held || !std::isfinite(pulse.microseconds) || !hasValue(servo)) return;
    state.attach = true;
    state.value = valueOf(servo, pulse.microseconds);
    pending_ = pending_ || state.told != Told::attached || state.toldValue != state.value;
}

void PulsePlan::tick(Microseconds now) {
    now_ = now;
    if (!pending_ || due_) return;
    if (now < nextSlot_ && nextSlot_ - now <= period_) return; // further ahead: the clock was set back
    due_ = true;
    pending_ = false;
    nextSlot_ = now + period_;
}

void PulsePlan::confirmLimp(std::size_t servo) {
    if (states_[servo].told == Told::limp && !states_[servo].detachFirst) ++states_[servo].confirmations;
}

void PulsePlan::detachAgain(std::size_t servo) {
    State& state = states_[servo];
    if (state.told != Told::limp) return;
    state.confirmations = 0;
    state.quickUntil = now_ + kDetachQuickly;
}

PulsePlan::Verdict PulsePlan::hears(std::size_t servo, bool same, Microseconds asked) {
    State& state = states_[servo];
    if (state.told != Told::attached || asked <= state.toldAt || state.again) return Verdict::nothing;
    if (same) return std::exchange(state.repeats, 0) > 0 ? Verdict::mended : Verdict::nothing;
    if (state.repeats == kRepeats) return Verdict::refused;
    state.again = pending_ = true;
    ++state.repeats;
    return Verdict::nothing;
}

bool PulsePlan::doubtful(std::size_t servo) const {
    return states_[servo].told == Told::limp && states_[servo].confirmations < kConfirmations;
}

bool PulsePlan::detaching() const {
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (doubtful(i) && (states_[i].detachFirst || isQuick(states_[i]))) return true;
    return false;
}

bool PulsePlan::isQuick(const State& state) const {
    return now_ < state.quickUntil && state.quickUntil - now_ <= kDetachQuickly; // beyond: the clock was set back
}

bool PulsePlan::detachmentDue(const State& state) const {
    if (state.detachFirst) return true; // even if it was attached again since
    if (state.attach || state.confirmations >= kConfirmations) return false;
    const bool quickly = isQuick(state);
    if (!quickly && !ready_) return false; // what may be no servo controller is left in peace
    return now_ < state.detachedAt || now_ - state.detachedAt >= (quickly ? scale_.detachGap : kDetachSlowly);
}

void PulsePlan::detachAgain() {
    for (std::size_t i = 0; i < states_.size(); ++i) {
        detachAgain(i);
        states_[i].detachedAt = std::min(states_[i].detachedAt, now_ - scale_.detachGap);
    }
}

std::vector<std::size_t> PulsePlan::takeDetachments() {
    std::vector<std::size_t> servos;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        if (state.told != Told::limp || !detachmentDue(state)) continue;
        if (state.detachFirst) {
            state.since = now_;
            state.quickUntil = now_ + kDetachQuickly;
        }
        state.detachFirst = false;
        state.detachedAt = now_;
        servos.push_back(i);
    }
    return servos;
}

std::vector<PulsePlan::Change> PulsePlan::takeChanges() {
    std::vector<Change> changes;
    if (!due_) return changes;
    due_ = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        const bool news = state.told != Told::attached || state.toldValue != state.value;
        if (!state.attach || (!news && !state.again)) continue;
        changes.push_back({i, state.value, state.told != Told::attached});
        if (news) state.repeats = 0;
        state.again = false;
        state.toldAt = now_;
        if (state.told != Told::attached) state.since = now_;
        state.told = Told::attached;
        state.toldValue = state.value;
    }
    return changes;
}

bool PulsePlan::anyAttached() const {
    return std::any_of(states_.begin(), states_.end(), [](const State& s) { return s.told == Told::attached; });
}

} // namespace lumorph
