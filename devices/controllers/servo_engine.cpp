#include "devices/controllers/servo_engine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "devices/controllers/controller_base.h"
#include "devices/controllers/servo_engine_data.h"
#include "devices/transport/address.h"

namespace lumorph {
namespace {

constexpr Microseconds kBusyPause{5'000};
constexpr Microseconds kIdlePause{50'000};
constexpr Microseconds kOffPause{1'000'000}; // an order wakes it; the processor rests
constexpr Microseconds kStaysBusy{200'000};   // after the last motion: the rate cap may hold its end back
constexpr Microseconds kCloseAtLast{750'000}; // after the time to close: not all was sent, or servos may not be limp
constexpr Microseconds kTrustedRest{2'000'000};
constexpr Microseconds kReadAnew{400'000}; // after its last pulse, a position that is told was read since
constexpr Microseconds kSilencePatience{4'000'000};
constexpr Microseconds kStallTold{200'000};
constexpr Microseconds kHang{1'000'000}; // without any input, where ticks come every 50 ms: as the failsafe process
constexpr Microseconds kWatchedHang{500'000}; // of a board that watches over its servos itself: it has let them go
constexpr double kMostUnsentSeconds = 0.025;  // of a serial link: what a STOP may find before it
constexpr double kMostUnsent = 128.0;         // bytes, whatever the link
constexpr double kLeastUnsent = 24.0;

// Times of inputs may be anything; differences of these are numbers.
constexpr Microseconds kFarthest{std::int64_t{1} << 60};
constexpr Microseconds kBegin{1'000'000'000}; // of the engine's own time: what has never been is long ago
constexpr Microseconds kLongestGap{86'400'000'000};

/// "where servos 1, 2 and 4 stand, so they were", of one or more.
std::string placesOf(const std::vector<std::size_t>& servos) {
    std::string text;
    for (const std::size_t servo : servos)
        text += (text.empty() ? "" : servo == servos.back() ? " and " : ", ") + std::to_string(servo + 1);
    return servos.size() == 1 ? "servo " + text + " stands, so it was" : "servos " + text + " stand, so they were";
}

} // namespace

ServoEngine::Data::Data(const DeviceProfile& its)
    : profile(its), made(its), guard(GuardKey(), its), watch([this](Kind kind, std::string text, std::string remedy) {
          tell(kind, std::move(text), std::move(remedy));
      }),
      now(kBegin) {
    make();
}

void ServoEngine::Data::make() {
    made = profile;
    const DeviceAddress address = parseDeviceAddress(profile.address);
    controller = makeController(profile, address);
    reboots = controller->state().reboots;
    const double taken = kMostUnsentSeconds * baudOf(address) / 10.0;
    mostUnsent = static_cast<std::uint64_t>(std::clamp(taken, kLeastUnsent, kMostUnsent));
}

Microseconds ServoEngine::Data::see(Microseconds time) {
    outside = time;
    const Microseconds bounded = std::clamp(time, -kFarthest, kFarthest);
    if (!origin) origin = bounded;
    const Microseconds before = std::exchange(now, kBegin + (bounded - *origin));
    const Microseconds pause = std::clamp(now - before, Microseconds{0}, kLongestGap);
    passed += pause;
    return pause;
}

/// This program was stopped, or had no processor: nobody could have pressed STOP, and hands may be anywhere by now.
void ServoEngine::Data::noticeHang(Microseconds pause) {
    if (open && pause >= (controller->state().traits.failsafe ? kWatchedHang : kHang)) letGoAfterHang(pause);
}

void ServoEngine::Data::letGoAfterHang(Microseconds pause) {
    if (!armed()) return;
    char text[120];
    std::snprintf(text, sizeof text, "Lumorph itself was stuck for %.1f s; the servos were let go.",
                  1e-6 * static_cast<double>(pause.count()));
    tell(Kind::failure, text,
         "Start them again when hands are out of the way; where it comes again, see what else this computer does.");
    guard.disarm();
    forget(); // limp servos may have been moved
    if (!open) return;
    send();
    controller->detachAgain();
    flush(true);
}

void ServoEngine::Data::tell(Kind kind, std::string text, std::string remedy) {
    output.emplace_back(servo_output::Tell{{outside, kind, std::move(text), std::move(remedy)}});
}

void ServoEngine::Data::noticeReboot() {
    if (std::exchange(reboots, controller->state().reboots) == controller->state().reboots) return;
    guard.disarm();
    forget();
    written.clear();
    silenceTold = false;
    tell(Kind::failure, "The board has restarted; its servos are limp, and nobody knows where they are.",
         "Check its battery and power supply, then start the servos again.");
}

/// What was read while a servo still moved is not where it was let go.
void ServoEngine::Data::readPositions() {
    const ControllerState& state = controller->state();
    for (std::size_t i = 0; i < std::min(state.readPulses.size(), profile.servos.size()); ++i)
        if (state.readPulses[i] && (i >= heldAt.size() || passed - heldAt[i] >= kReadAnew))
            guard.setKnown(i, strokeOf(profile.servos[i], *state.readPulses[i]));
}

bool ServoEngine::Data::stalled() {
    if (unsent <= mostUnsent) {
        stalledSince.reset();
        if (std::exchange(stallTold, false)) tell(Kind::information, "The link takes commands again.");
        return false;
    }
    if (!stalledSince) stalledSince = passed;
    if (!stallTold && passed - *stalledSince >= kStallTold) {
        stallTold = true;
        tell(Kind::warning, "The link does not take any more bytes: servos stay where they are.",
             "Bring the radio nearer or check the cable; it goes on by itself when the link does.");
    }
    return true;
}

/// At a second of silence servos are taken for lost. But a board that starts anew is silent for longer, and on USB it
/// does so whenever its port is opened: it must be left the time, or it would never come to its end. False: dropped.
bool ServoEngine::Data::waitOutSilence() {
    const ControllerState& state = controller->state();
    if (state.answering) {
        if (std::exchange(silentSince, std::nullopt) && silenceTold)
            tell(Kind::information, "The board answers again.");
        silenceTold = false;
        return true;
    }
    const LinkTrouble why = state.trouble.value_or(LinkTrouble{"the board does not answer", "check its power"});
    if (!silentSince) {
        silentSince = passed;
        silenceTold = state.phase != ControllerPhase::handshake;
        if (silenceTold) tell(Kind::failure, "The link is lost: " + why.why + ".", why.remedy);
        if (armed() && passed - movedAt < kTrustedRest) forget();
        guard.disarm();
    }
    if (passed - *silentSince < kSilencePatience) return true;
    open = false;
    output.emplace_back(servo_output::Drop{why});
    return false;
}

void ServoEngine::Data::take(const servo_input::Tick& tick) {
    unsent = tick.unsent;
    if (open) drive();
    finishRest();
    finishClosing();
}

void ServoEngine::Data::drive() {
    controller->tick(now);
    noticeReboot();
    const ControllerState& state = controller->state();
    if (!waitOutSilence()) return;
    if (armed() && !ready()) guard.disarm();
    // The user's word about this very board was kept with the profile.
    if (state.phase == ControllerPhase::unidentified && !foreign && profile.confirmed && !profile.identity.empty())
        controller->confirm();
    watch.look(state, now);
    readPositions();
    // Nothing is added to a queue that does not move, and no time passes for the guard: what comes after starts from
    // what was sent. A detached servo is told so all the same.
    if (stalled()) return;
    send();
    flush();
}

void ServoEngine::Data::send() {
    const GuardedPulses step = guard.step(now);
    pulses.assign(step.servos().begin(), step.servos().end());
    heldAt.resize(pulses.size(), passed - kReadAnew);
    for (std::size_t i = 0; i < pulses.size(); ++i)
        if (pulses[i].attached) heldAt[i] = passed;
    if (made != profile && guard.withinLimits()) {
        made = profile;
        controller->setLimits(made);
    }
    controller->send(step, now);
    if (guard.settled() && guard.phase() != ServoGuard::Phase::starting) return;
    movedAt = passed;
    busyUntil = passed + kStaysBusy;
}

void ServoEngine::Data::flush(bool urgent) {
    std::vector<std::vector<std::uint8_t>> messages = controller->takeOutput();
    if (messages.empty()) return;
    for (std::vector<std::uint8_t>& message : messages) {
        bytesSent += message.size();
        output.emplace_back(servo_output::Write{std::move(message), false, std::exchange(urgent, false)});
    }
    const double step = controller->state().traits.pulseStep;
    std::vector<long> steps;
    for (const GuardedPulse& pulse : pulses) steps.push_back(std::lround(pulse.microseconds / step));
    if (steps == written) return; // questions only
    written = std::move(steps);
    std::get<servo_output::Write>(output.back()).moves = true;
}

void ServoEngine::Data::finishRest() {
    if (!restUntil) {
        if (quitting && !closeAfter) close();
        return;
    }
    if (ready() && guard.phase() == ServoGuard::Phase::live && !guard.settled() && passed < *restUntil) return;
    close();
}

void ServoEngine::Data::finishClosing() {
    if (!closeAfter || passed < *closeAfter) return;
    const bool waits = open && (unsent > 0 || controller->state().detaching);
    if (waits && passed < *closeAfter + kCloseAtLast) return;
    closeAfter.reset();
    wanted = open = everOpen = false;
    linkTrouble.reset();
    output.emplace_back(servo_output::Close{});
    if (quitting) {
        done = true;
        return;
    }
    if (next) {
        const bool otherBoard = next->address != profile.address;
        profile = *std::exchange(next, std::nullopt);
        guard.setProfile(profile);
        if (otherBoard) forget();
        make();
        output.emplace_back(servo_output::Reach{profile.address});
    }
    if (connected) openLink();
}

void ServoEngine::Data::tellWaiting() {
    if (waitingTold) return;
    const std::vector<std::size_t> waiting = guard.waiting();
    if (waiting.empty()) return;
    waitingTold = true;
    tell(Kind::warning, "Nobody knows where " + placesOf(waiting) + " not started.",
         "Take hands away, and start again with jumps to the wanted positions allowed.");
}

ServoEngine::ServoEngine(const DeviceProfile& profile) : data_(std::make_unique<Data>(profile)) {}

ServoEngine::~ServoEngine() = default;

void ServoEngine::take(const ServoInput& input, Microseconds now) {
    Data& data = *data_;
    data.noticeHang(data.see(now));
    std::visit([&data](const auto& one) { data.take(one); }, input);
    data.tellWaiting();
}

std::vector<ServoOutput> ServoEngine::takeOutput() { return std::exchange(data_->output, {}); }

bool ServoEngine::moves() const noexcept { return !data_->guard.settled(); }

bool ServoEngine::live() const noexcept { return data_->guard.phase() == ServoGuard::Phase::live; }

std::optional<ServoRelease> ServoEngine::release() const {
    const Data& data = *data_;
    const bool driven = std::ranges::any_of(data.pulses, &GuardedPulse::attached);
    if (!data.open || (!driven && !data.controller->state().detaching)) return std::nullopt;
    return data.controller->release();
}

Microseconds ServoEngine::commandPeriod() const {
    const double link = data_->controller->state().traits.commandsPerSecond;
    return Microseconds{std::lround(1e6 / std::max(1.0, std::min(data_->profile.commandsPerSecond, link)))};
}

Microseconds ServoEngine::pause() const {
    const Data& data = *data_;
    if (idle() && !data.wanted) return kOffPause;
    const bool waits = data.closeAfter || data.restUntil || data.stalledSince;
    const ControllerState& state = data.controller->state();
    const bool asks = data.open && (state.phase == ControllerPhase::handshake || state.detaching);
    const bool works = data.armed() && (moves() || data.passed < data.busyUntil);
    return waits || asks || works ? kBusyPause : kIdlePause;
}

bool ServoEngine::idle() const noexcept {
    const Data& data = *data_;
    return !data.open && !data.closeAfter && !data.restUntil && !data.quitting;
}

bool ServoEngine::done() const noexcept { return data_->done; }

LinkStatus ServoEngine::status() const { return data_->status(); }

} // namespace lumorph
