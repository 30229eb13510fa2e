#include "devices/controllers/controller_base.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kRecovered = 0.2;         // volts above the limit that end the warning: under load it sags
constexpr double kLeastBattery = 0.5;      // volts; less is an input that nothing is wired to
constexpr double kBatteryLeap = 1.0;       // volts between two readings of which the newer one is in doubt
constexpr double kMostBattery = 30.0;      // volts; more is a broken answer
constexpr double kShareOfLink = 0.47;      // of its bytes, for pulses; the rest is for questions and hiccups
constexpr double kDetachShare = 0.65;      // of its bytes, for letting servos go: nothing else matters then
constexpr Microseconds kDetachGap{25'000}; // at least
constexpr std::size_t kMostQuestions = 64;
constexpr Microseconds kLongestTickPause{250'000}; // that counts as listening: ticks come every 50 ms or more often
constexpr Microseconds kStuck{400'000};            // a board's own watchdog is at 500 ms, and may have begun before

/// The scale with what follows from the traits.
PulseScale scaleOf(PulseScale scale, const DeviceProfile& profile, const ControllerTraits& traits) {
    scale.step = traits.pulseStep;
    scale.perSecond = setsPerSecond(profile, traits);
    return scale;
}

} // namespace

ControllerBase::ControllerBase(const DeviceProfile& profile, const PulseScale& scale, ControllerTraits traits)
    : plan_(profile.servos, scaleOf(scale, profile, traits)) {
    state_.traits = std::move(traits);
    state_.readPulses.resize(profile.servos.size());
}

void ControllerBase::opened(const std::string& product, Microseconds now) {
    now_ = heard_ = lastWritten_ = now;
    everHeard_ = false;
    stuckAt_.reset();
    heardVolts_.reset();
    product_ = product;
    questions_.clear();
    plan_.restart();
    troubles_ = {};
    ControllerState fresh;
    fresh.traits = std::move(state_.traits);
    fresh.readPulses.resize(plan_.servos().size());
    fresh.reboots = state_.reboots;
    fresh.errors = state_.errors;
    state_ = std::move(fresh);
    begin(now);
}

void ControllerBase::passTo(Microseconds now) {
    if (now < now_) {
        heard_ = lastWritten_ = now; // the clock was set back
        stuckAt_.reset();
    } else if (const Microseconds pause = now - now_; pause > kLongestTickPause) {
        heard_ += pause - kLongestTickPause;
        if (pause >= kStuck) stuckAt_ = now;
    }
    now_ = now;
}

void ControllerBase::received(std::span<const std::uint8_t> bytes, Microseconds now) {
    passTo(now);
    take(bytes, now);
}

void ControllerBase::tick(Microseconds now) {
    passTo(now);
    plan_.tick(now);
    work(now);
    state_.detaching = plan_.detaching();
    if (now - heard_ < kSilence) return;
    state_.answering = false;
    trouble(Concern::silence, silence(!everHeard_));
}

void ControllerBase::ask(std::vector<std::uint8_t> message) {
    if (questions_.size() < kMostQuestions) questions_.push_back(std::move(message));
}

void ControllerBase::noteAnswer(Microseconds now) {
    heard_ = now;
    everHeard_ = true;
    state_.answering = true;
    trouble(Concern::silence, std::nullopt);
}

void ControllerBase::setLimits(const DeviceProfile& profile) {
    plan_.setServos(profile.servos, setsPerSecond(profile, state_.traits));
    limitsChanged(profile);
}

void ControllerBase::confirm() {
    if (state_.phase == ControllerPhase::unidentified) becomeReady();
}

/// What was told before may have met a board that did not listen yet.
void ControllerBase::becomeReady() {
    plan_.restart();
    state_.phase = ControllerPhase::ready;
}

void ControllerBase::refuse(LinkTrouble why) {
    state_.phase = ControllerPhase::refused;
    plan_.restart();
    trouble(Concern::refusal, std::move(why));
}

void ControllerBase::rebooted() {
    ++state_.reboots;
    state_.phase = ControllerPhase::handshake;
    std::fill(state_.readPulses.begin(), state_.readPulses.end(), std::nullopt);
    trouble(Concern::refusal, std::nullopt);
    plan_.restart();
}

void ControllerBase::trouble(Concern concern, std::optional<LinkTrouble> trouble) {
    troubles_[static_cast<std::size_t>(concern)] = std::move(trouble);
    const auto first = std::find_if(troubles_.begin(), troubles_.end(), [](const auto& t) { return t.has_value(); });
    state_.trouble = first == troubles_.end() ? std::nullopt : *first;
    state_.batteryTrouble = first == troubles_.begin() + static_cast<std::ptrdiff_t>(Concern::battery);
}

bool ControllerBase::takeVoltage(double volts) {
    if (!(volts >= 0.0 && volts <= kMostBattery)) {
        ++state_.errors;
        return false;
    }
    // No battery leaps; a reading that noise has hit does. What the next one confirms is true.
    const std::optional<double> before = std::exchange(heardVolts_, volts);
    if (before && std::abs(volts - *before) > kBatteryLeap) return false;
    state_.volts = volts < kLeastBattery ? std::nullopt : std::optional(volts);
    const bool warned = troubles_[static_cast<std::size_t>(Concern::battery)].has_value();
    if (!state_.volts || volts >= kLowBattery + (warned ? kRecovered : 0.0)) {
        trouble(Concern::battery, std::nullopt);
        return true;
    }
    char text[40];
    std::snprintf(text, sizeof(text), "battery at %.1f V", volts);
    trouble(Concern::battery, LinkTrouble{text, "charge it or change it: servos lose their strength, and the board "
                                                "may start anew under load"});
    return true;
}

bool ControllerBase::takeValue(std::size_t servo, long value, bool same, Microseconds asked, const char* remedy) {
    const PulsePlan::Verdict verdict = plan_.hears(servo, same, asked);
    if (verdict == PulsePlan::Verdict::mended) ++state_.errors;
    if (verdict != PulsePlan::Verdict::refused) return false;
    const auto microseconds = [this](long steps) { return std::to_string(std::lround(plan_.microseconds(steps))); };
    trouble(Concern::board,
            LinkTrouble{"the board holds servo " + std::to_string(servo + 1) + " at " + microseconds(value) +
                            " us, where it was told " + microseconds(plan_.told(servo)) + " us",
                        remedy});
    return true;
}

std::optional<std::size_t> ControllerBase::servoOn(int channel) const {
    for (std::size_t i = 0; i < plan_.servos().size(); ++i)
        if (plan_.servos()[i].channel == channel) return i;
    return std::nullopt;
}

void ControllerBase::command(std::span<const GuardedPulse> pulses, Microseconds now) {
    passTo(now);
    plan_.want(pulses, now, state_.phase == ControllerPhase::ready);
}

std::vector<std::vector<std::uint8_t>> ControllerBase::takeOutput() {
    Messages output;
    if (const std::vector<std::size_t> limp = plan_.takeDetachments(); !limp.empty()) output = detachments(limp);
    output.insert(output.end(), std::make_move_iterator(questions_.begin()), std::make_move_iterator(questions_.end()));
    questions_.clear();
    if (const std::vector<PulsePlan::Change> changed = plan_.takeChanges(); !changed.empty()) {
        Messages moves = changes(changed);
        output.insert(output.end(), std::make_move_iterator(moves.begin()), std::make_move_iterator(moves.end()));
    }
    if (!output.empty()) lastWritten_ = now_;
    state_.detaching = plan_.detaching();
    return output;
}

int baudOf(const DeviceAddress& address) {
    if (const auto* serial = std::get_if<SerialAddress>(&address)) return serial->baud;
    if (std::holds_alternative<BluetoothAddress>(address)) return 9600;
    int baud = 57600;
    if (const auto* simulated = std::get_if<SimulatedAddress>(&address))
        if (const auto option = simulated->options.find("baud"); option != simulated->options.end()) {
            const std::string& text = option->second;
            std::from_chars(text.data(), text.data() + text.size(), baud);
        }
    return std::clamp(baud, 300, 4'000'000);
}

double setsPerSecond(int baud, std::size_t bytes) {
    return kShareOfLink * baud / 10.0 / static_cast<double>(std::max<std::size_t>(bytes, 1)); // 8N1: ten bits a byte
}

Microseconds detachGap(int baud, std::size_t bytes) {
    const double seconds = 10.0 * static_cast<double>(bytes) / (kDetachShare * baud);
    return std::max(kDetachGap, Microseconds(std::lround(1e6 * seconds)));
}

double setsPerSecond(const DeviceProfile& profile, const ControllerTraits& traits) {
    const double wanted = profile.commandsPerSecond;
    return wanted > 0.0 ? std::min(wanted, traits.commandsPerSecond) : traits.commandsPerSecond;
}

void refuseHid(const DeviceProfile& profile, const DeviceAddress& address, const char* why, const char* remedy) {
    if (std::holds_alternative<HidAddress>(address))
        throw InvalidInput("device address '" + profile.address + "'", why, remedy);
}

void checkChannels(const DeviceProfile& profile, int last) {
    for (std::size_t i = 0; i < profile.servos.size(); ++i)
        if (const int channel = profile.servos[i].channel; channel < 0 || channel > last)
            throw InvalidInput("channel " + std::to_string(channel) + " of servo " + std::to_string(i + 1),
                               "its controller has none of that number", "use 0 to " + std::to_string(last));
}

} // namespace lumorph
