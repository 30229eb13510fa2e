#include "devices/controllers/servo_link_worker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "devices/controllers/servo_link_traffic.h"
#include "devices/controllers/servo_link_watch.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/link_keeper.h"

namespace lumorph {
namespace {

using Kind = LinkEvent::Kind;

constexpr Microseconds kBusyPause{5'000};
constexpr Microseconds kIdlePause{50'000};
constexpr Microseconds kStaysBusy{200'000}; // after the last motion: the rate cap may hold its end back
constexpr Microseconds kRestAtMost{2'000'000};
constexpr Microseconds kCloseAfter{250'000};    // detaching is repeated meanwhile
constexpr Microseconds kCloseAtLast{1'000'000}; // though not all was sent, or not all servos are known to be limp
constexpr Microseconds kTrustedRest{2'000'000};
constexpr Microseconds kSilencePatience{4'000'000};
constexpr Microseconds kStallTold{200'000};
constexpr std::size_t kMostUnsent = 128; // bytes

Microseconds steadyNow() { return SteadyClock{}.now(); }

/// Whether a controller made for one profile serves another too: the same board and wires, and limits that are no
/// wider.
bool serves(const DeviceProfile& made, const DeviceProfile& wanted) {
    const auto sameServo = [](const ServoSetup& a, const ServoSetup& b) {
        return a.channel == b.channel && a.pulseMin <= b.pulseMin && a.pulseMax >= b.pulseMax;
    };
    return made.address == wanted.address && made.controller == wanted.controller &&
           made.controllerNumber == wanted.controllerNumber && made.maestroCrc == wanted.maestroCrc &&
           made.commandsPerSecond == wanted.commandsPerSecond &&
           std::ranges::equal(made.servos, wanted.servos, sameServo);
}

std::string placesOf(const std::vector<std::size_t>& servos) {
    std::string text;
    for (const std::size_t servo : servos) text += (text.empty() ? "" : ", ") + std::to_string(servo + 1);
    return servos.size() == 1 ? "servo " + text + " stands, so it was" : "servos " + text + " stand, so they were";
}

} // namespace

struct LinkWorker::Data {
    Data(const DeviceProfile& its, const LinkOptions& theOptions, Events theEvents)
        : profile(its), made(its), options(theOptions), events(std::move(theEvents)), guard(its),
          watch([this](Kind kind, std::string text, std::string remedy) {
              tell(kind, std::move(text), std::move(remedy));
          }) {
        make();
    }

    DeviceProfile profile;
    DeviceProfile made; ///< what keeper and controller were made for
    LinkOptions options;
    Events events;
    DeviceAddress address;
    std::unique_ptr<ServoController> controller;
    std::unique_ptr<LinkKeeper> keeper;
    ServoGuard guard;
    LinkWatch watch;
    LinkTraffic traffic;

    bool connected = false; ///< its user wants it to be
    bool everOpen = false;
    bool foreign = false; ///< not the board of the profile, and nobody has said that it will do
    bool slow = false;
    bool waitingTold = false;
    bool quitting = false;
    bool done = false;
    std::optional<Microseconds> restUntil; ///< by the steady clock, as all that follow
    std::optional<Microseconds> closeAfter;
    std::optional<DeviceProfile> next; ///< for after the closing
    std::optional<Microseconds> stalledSince;
    bool stallTold = false;
    std::optional<Microseconds> silentSince;
    bool silenceTold = false;
    Microseconds busyUntil{0};
    Microseconds movedAt{0};
    std::uint64_t reboots = 0;
    std::uint64_t reconnects = 0;
    std::uint64_t bytesSent = 0;
    std::vector<GuardedPulse> pulses; ///< of the last step
    std::vector<long> written;        ///< the same in the controller's steps, when pulses were last written

    void make();
    [[nodiscard]] Microseconds now() const;
    void tell(Kind kind, std::string text, std::string remedy = "");
    [[nodiscard]] bool armed() const {
        return guard.phase() == ServoGuard::Phase::starting || guard.phase() == ServoGuard::Phase::live;
    }
    [[nodiscard]] bool ready() const {
        return keeper->isOpen() && !foreign && !silentSince && controller->state().phase == ControllerPhase::ready;
    }

    // Events of the link.
    void onOpened();
    void onReceived(std::span<const std::uint8_t> bytes);
    void onLost(const LinkTrouble& why);

    // Orders.
    void stop();
    void order(const link_request::Connect&);
    void order(const link_request::Disconnect&);
    void order(const link_request::Confirm&);
    void order(const link_request::Arm& arm);
    void order(const link_request::Disarm&);
    void order(const link_request::Wiggle& wiggle);
    void order(const link_request::Slow& order);
    void order(const link_request::Profile& order);
    void command(const std::vector<double>& strokes, Microseconds at);
    void quit();

    // What is due.
    void drive();
    void noticeReboot();
    void readPositions();
    bool stalled();
    bool waitOutSilence();
    void forget();
    void send();
    void flush();
    void close();
    void finishRest();
    void finishClosing();
    void tellWaiting();

    [[nodiscard]] LinkPhase phase() const;
    [[nodiscard]] LinkStatus status();
};

void LinkWorker::Data::make() {
    made = profile;
    address = parseDeviceAddress(profile.address);
    controller = makeController(profile, address);
    reboots = controller->state().reboots;
    keeper = std::make_unique<LinkKeeper>(address,
                                          LinkKeeper::Events{[this] { onOpened(); },
                                                             [this](auto bytes) { onReceived(bytes); },
                                                             [this](const LinkTrouble& why) { onLost(why); }},
                                          options.bench);
}

/// A simulated board and the link to it live in the same time.
Microseconds LinkWorker::Data::now() const {
    if (options.bench && std::holds_alternative<SimulatedAddress>(address)) return options.bench->now();
    return steadyNow();
}

void LinkWorker::Data::tell(Kind kind, std::string text, std::string remedy) {
    events.tell({now(), kind, std::move(text), std::move(remedy)});
}

void LinkWorker::Data::onOpened() {
    if (std::exchange(everOpen, true)) ++reconnects;
    foreign = !profile.identity.empty() && keeper->identity() != profile.identity;
    if (foreign)
        tell(Kind::warning, "This is not the board that the profile was set up with.",
             "Plug in the right one, or confirm that its servos have the same limits.");
    controller->opened(keeper->product(), now());
    watch.opened(controller->state());
    stalledSince.reset();
    written.clear();
}

void LinkWorker::Data::onReceived(std::span<const std::uint8_t> bytes) {
    if (options.onWire) options.onWire(bytes, false);
    controller->received(bytes, now());
    noticeReboot();
}

void LinkWorker::Data::onLost(const LinkTrouble& why) {
    const bool wasArmed = armed();
    // What was sent last may never have arrived.
    if (wasArmed && now() - movedAt < kTrustedRest) forget();
    guard.disarm();
    stalledSince.reset();
    silentSince.reset();
    stallTold = false;
    if (std::exchange(silenceTold, false)) return; // it was told
    tell(wasArmed ? Kind::failure : Kind::warning,
         std::string(everOpen ? "The link is lost: " : "There is no link: ") + why.why + ".",
         why.remedy + (wasArmed
                           ? (why.remedy.empty() ? "" : "; ") + std::string("start the servos again when it is back")
                           : ""));
}

void LinkWorker::Data::forget() {
    for (std::size_t i = 0; i < profile.servos.size(); ++i) guard.setKnown(i, std::nullopt);
}

void LinkWorker::Data::stop() {
    restUntil.reset();
    if (guard.phase() != ServoGuard::Phase::stopped)
        tell(Kind::warning, "STOP: all servos are without power.", "Start them again when hands are out of the way.");
    guard.stop();
    // Past everything else that waits.
    if (!keeper->isOpen()) return;
    send();
    flush();
}

void LinkWorker::Data::order(const link_request::Connect&) {
    if (quitting) return;
    connected = true;
    if (closeAfter && !next) closeAfter.reset();
    if (!closeAfter) keeper->start(now());
}

void LinkWorker::Data::order(const link_request::Disconnect&) {
    connected = false;
    close();
}

void LinkWorker::Data::order(const link_request::Confirm&) {
    foreign = false;
    controller->confirm();
}

void LinkWorker::Data::order(const link_request::Arm& arm) {
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

void LinkWorker::Data::order(const link_request::Disarm&) { guard.disarm(); }

void LinkWorker::Data::order(const link_request::Wiggle& wiggle) { (void)guard.wiggle(wiggle.servo); }

void LinkWorker::Data::order(const link_request::Slow& order) {
    slow = order.on;
    guard.setSlow(slow);
}

void LinkWorker::Data::order(const link_request::Profile& order) {
    // The identity of the very board that is there says nothing new.
    const bool sameBoard = order.profile.identity == made.identity ||
                           (keeper->isOpen() && !foreign && order.profile.identity == keeper->identity());
    if (next || !sameBoard || !serves(made, order.profile)) {
        next = order.profile;
        if (armed())
            tell(Kind::information, "Other wires or wider limits: the servos were let go.", "Start them again.");
        close();
        return;
    }
    profile = order.profile;
    made.identity = profile.identity;
    guard.setProfile(profile);
}

void LinkWorker::Data::command(const std::vector<double>& strokes, Microseconds at) {
    if (quitting) return;
    const bool moving = !guard.settled();
    if (!guard.want(strokes)) return;
    // From a standstill it is the acceleration that takes its time, not the link.
    if (moving && guard.phase() == ServoGuard::Phase::live) traffic.commanded(at);
}

void LinkWorker::Data::quit() {
    if (std::exchange(quitting, true)) return;
    connected = false;
    next.reset();
    if (!profile.restOnExit || !ready() || guard.phase() != ServoGuard::Phase::live) return close();
    (void)guard.want(std::vector<double>(profile.servos.size(), 0.0));
    restUntil = steadyNow() + kRestAtMost;
}

/// Servos are let go, and the link is closed once the board should know.
void LinkWorker::Data::close() {
    restUntil.reset();
    guard.disarm();
    if (keeper->isOpen()) {
        send();
        flush();
    }
    closeAfter = steadyNow() + (keeper->isOpen() ? kCloseAfter : Microseconds{0});
}

void LinkWorker::Data::noticeReboot() {
    if (std::exchange(reboots, controller->state().reboots) == controller->state().reboots) return;
    guard.disarm();
    forget();
    written.clear();
    silenceTold = false;
    tell(Kind::failure, "The board has restarted; its servos are limp, and nobody knows where they are.",
         "Check its battery and power supply, then start the servos again.");
}

void LinkWorker::Data::readPositions() {
    const ControllerState& state = controller->state();
    for (std::size_t i = 0; i < std::min(state.readPulses.size(), profile.servos.size()); ++i)
        if (state.readPulses[i]) guard.setKnown(i, strokeOf(profile.servos[i], *state.readPulses[i]));
}

bool LinkWorker::Data::stalled() {
    const Microseconds steady = steadyNow();
    if (keeper->unsent() <= kMostUnsent) {
        stalledSince.reset();
        if (std::exchange(stallTold, false)) tell(Kind::information, "The link takes commands again.");
        return false;
    }
    if (!stalledSince) stalledSince = steady;
    if (!stallTold && steady - *stalledSince >= kStallTold) {
        stallTold = true;
        tell(Kind::warning, "The link does not take any more bytes: servos stay where they are.",
             "Bring the radio nearer or check the cable; it goes on by itself when the link does.");
    }
    return true;
}

/// At a second of silence servos are taken for lost. But a board that starts anew is silent for longer, and on USB it
/// does so whenever its port is opened: it must be left the time, or it would never come to its end. False: dropped.
bool LinkWorker::Data::waitOutSilence() {
    const ControllerState& state = controller->state();
    if (state.answering) {
        if (std::exchange(silentSince, std::nullopt) && silenceTold)
            tell(Kind::information, "The board answers again.");
        silenceTold = false;
        return true;
    }
    const LinkTrouble why = state.trouble.value_or(LinkTrouble{"the board does not answer", "check its power"});
    if (!silentSince) {
        silentSince = steadyNow();
        silenceTold = state.phase != ControllerPhase::handshake;
        if (silenceTold) tell(Kind::failure, "The link is lost: " + why.why + ".", why.remedy);
        if (armed() && now() - movedAt < kTrustedRest) forget();
        guard.disarm();
    }
    if (steadyNow() - *silentSince < kSilencePatience) return true;
    keeper->drop(why, now());
    return false;
}

void LinkWorker::Data::drive() {
    controller->tick(now());
    noticeReboot();
    const ControllerState& state = controller->state();
    if (!waitOutSilence()) return;
    if (armed() && !ready()) guard.disarm();
    watch.look(state, now());
    readPositions();
    // Nothing is added to a queue that does not move, and no time passes for the guard: what comes after starts from
    // what was sent. A detached servo is told so all the same.
    if (stalled()) return;
    send();
    flush();
}

void LinkWorker::Data::send() {
    const GuardedPulses step = guard.step(now());
    pulses.assign(step.servos().begin(), step.servos().end());
    controller->send(step, now());
    if (guard.settled() && guard.phase() != ServoGuard::Phase::starting) {
        traffic.settled();
        return;
    }
    movedAt = now();
    busyUntil = steadyNow() + kStaysBusy;
}

void LinkWorker::Data::flush() {
    const std::vector<std::vector<std::uint8_t>> messages = controller->takeOutput();
    for (const std::vector<std::uint8_t>& message : messages) {
        keeper->write(message);
        bytesSent += message.size();
        if (options.onWire) options.onWire(message, true);
    }
    if (messages.empty()) return;
    const ControllerTraits& traits = controller->state().traits;
    std::vector<long> steps;
    for (const GuardedPulse& pulse : pulses) steps.push_back(std::lround(pulse.microseconds / traits.pulseStep));
    if (steps == written) return; // questions only
    written = std::move(steps);
    const double rate = std::max(1.0, std::min(profile.commandsPerSecond, traits.commandsPerSecond));
    traffic.wrote(steadyNow(), Microseconds{std::lround(1e6 / rate)});
}

void LinkWorker::Data::finishRest() {
    if (!restUntil) {
        if (quitting && !closeAfter) close();
        return;
    }
    if (ready() && guard.phase() == ServoGuard::Phase::live && !guard.settled() && steadyNow() < *restUntil) return;
    close();
}

void LinkWorker::Data::finishClosing() {
    if (!closeAfter || steadyNow() < *closeAfter) return;
    const bool waits = keeper->unsent() > 0 || (keeper->isOpen() && controller->state().detaching);
    if (waits && steadyNow() < *closeAfter + kCloseAtLast - kCloseAfter) return;
    closeAfter.reset();
    keeper->stop();
    everOpen = false;
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
    }
    if (connected) keeper->start(now());
}

void LinkWorker::Data::tellWaiting() {
    if (waitingTold) return;
    const std::vector<std::size_t> waiting = guard.waiting();
    if (waiting.empty()) return;
    waitingTold = true;
    tell(Kind::warning, "Nobody knows where " + placesOf(waiting) + " not started.",
         "Take hands away, and start again with jumps to the wanted positions allowed.");
}

LinkPhase LinkWorker::Data::phase() const {
    if (closeAfter || !connected) return connected ? LinkPhase::connecting : LinkPhase::off;
    if (!keeper->isOpen()) return everOpen ? LinkPhase::lost : LinkPhase::connecting;
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
        return LinkPhase::live;
    case ServoGuard::Phase::stopped:
        return LinkPhase::stopped;
    }
    return LinkPhase::off;
}

LinkStatus LinkWorker::Data::status() {
    LinkStatus status;
    status.phase = phase();
    status.controller = controller->state();
    status.product = keeper->product();
    status.identity = keeper->identity();
    status.trouble = keeper->isOpen() ? controller->state().trouble : keeper->trouble();
    status.waiting = guard.waiting();
    status.commandsPerSecond = traffic.perSecond(steadyNow());
    status.latencyMilliseconds = traffic.medianMilliseconds();
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
            servo.attached = pulses[i].attached && keeper->isOpen();
        }
        servo.known = guard.known(i).has_value();
        status.servos.push_back(servo);
    }
    return status;
}

LinkWorker::LinkWorker(const DeviceProfile& profile, const LinkOptions& options, Events events)
    : data_(std::make_unique<Data>(profile, options, std::move(events))) {}

LinkWorker::~LinkWorker() = default;

void LinkWorker::work(LinkOrders orders) {
    Data& data = *data_;
    if (orders.stop) data.stop();
    for (const LinkRequest& request : orders.requests)
        std::visit([&data](const auto& order) { data.order(order); }, request);
    if (orders.command) data.command(*orders.command, orders.commandedAt);
    if (orders.quit) data.quit();
    data.keeper->tick(data.now());
    if (data.keeper->isOpen()) data.drive();
    data.finishRest();
    data.finishClosing();
    data.tellWaiting();
    data.events.publish(data.status());
}

Microseconds LinkWorker::pause() const {
    const Data& data = *data_;
    const bool waits = data.closeAfter || data.restUntil || data.stalledSince;
    const ControllerState& state = data.controller->state();
    const bool asks = data.keeper->isOpen() && (state.phase == ControllerPhase::handshake || state.detaching);
    const bool moves = data.armed() && (!data.guard.settled() || steadyNow() < data.busyUntil);
    return waits || asks || moves ? kBusyPause : kIdlePause;
}

bool LinkWorker::done() const { return data_->done; }

} // namespace lumorph
