#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "devices/controllers/controller_base.h"
#include "devices/protocol/lewansoul.h"

namespace lumorph {

namespace {

using lewansoul::kServosPerReport;

constexpr double kAttachSeconds = 0.1; // no longer than the guard leaves a new servo in peace
constexpr double kHidPerSecond = 30.0; // what real boards follow
constexpr Microseconds kHidDetachGap{34'000};
constexpr double kHidStep = 2.0; // 500 to 2500 us are 0 to 1000
constexpr double kHidZero = 500.0;
constexpr Microseconds kLewansoulDrain{50'000};
constexpr Microseconds kLewansoulAskAgain{400'000};
constexpr Microseconds kLewansoulPositionsEvery{250'000};
constexpr Microseconds kStoppedEvery{100'000}; // positions while servos are let go: a start soon after begins there
constexpr Microseconds kLewansoulVoltageEvery{800'000}; // a sign of life where positions are not told
constexpr Microseconds kStale{1'000'000};
constexpr Microseconds kFrameGap{100'000};
constexpr int kLeastPosition = -100; // servos turned by hand go a little beyond 0 to 1000
constexpr int kMostPosition = 1100;
constexpr double kLeastMoveTime = 20.0; // ms

/// xArm boards speak HID; LSC boards serial. Simulated ones are xArms.
bool isHid(const DeviceAddress& address) {
    return std::holds_alternative<HidAddress>(address) || std::holds_alternative<SimulatedAddress>(address);
}

ControllerTraits lewansoulTraits(const DeviceProfile& profile, const DeviceAddress& address) {
    const std::size_t servos = std::max<std::size_t>(profile.servos.size(), 1);
    ControllerTraits traits;
    const bool hid = isHid(address);
    traits.name = hid ? "LewanSoul xArm" : "LewanSoul LSC";
    traits.pulseStep = hid ? kHidStep : 1.0;
    traits.readsPosition = hid;
    traits.readsVoltage = true;
    const std::size_t reports = (servos + kServosPerReport - 1) / kServosPerReport;
    traits.commandsPerSecond = hid ? kHidPerSecond / static_cast<double>(reports)
                                   : std::min(kHidPerSecond, setsPerSecond(baudOf(address), 7 + 3 * servos));
    traits.failsafeWord = "none of its own: when it hears nothing more or the cable is pulled, servos stay under power "
                          "where they are; switch the board off to free them";
    return traits;
}

PulseScale lewansoulScale(const DeviceProfile& profile, const DeviceAddress& address) {
    PulseScale scale;
    scale.zero = isHid(address) ? kHidZero : 0.0;
    scale.least = 500.0;
    scale.greatest = 2500.0;
    scale.detachGap = isHid(address) ? kHidDetachGap : detachGap(baudOf(address), 5 + profile.servos.size());
    return scale;
}

class LewansoulController final : public ControllerBase {
public:
    LewansoulController(const DeviceProfile& profile, const DeviceAddress& address)
        : LewansoulController(profile, address, lewansoulTraits(profile, address)) {}

private:
    LewansoulController(const DeviceProfile& profile, const DeviceAddress& address, const ControllerTraits& traits)
        : ControllerBase(profile, lewansoulScale(profile, address), traits), hid_(isHid(address)),
          baud_(baudOf(address)), readAt_(profile.servos.size()) {
        limitsChanged(profile);
        moves_.resize(profile.servos.size());
    }

    /// What a servo does since it was told, in the controller's steps.
    struct Move {
        double from = 0.0;
        double to = 0.0;
        Microseconds begins{0};
        Microseconds takes{0};

        [[nodiscard]] double at(Microseconds now) const noexcept {
            if (now < begins || now - begins >= takes) return to;
            return from +
                   (to - from) * static_cast<double>((now - begins).count()) / static_cast<double>(takes.count());
        }
    };

    void begin(Microseconds now) override;
    void take(std::span<const std::uint8_t> bytes, Microseconds now) override;
    void work(Microseconds now) override;
    [[nodiscard]] Messages detachments(std::span<const std::size_t> servos) override;
    [[nodiscard]] Messages releases() const override;
    [[nodiscard]] Messages changes(std::span<const PulsePlan::Change> changes) override;
    void limitsChanged(const DeviceProfile& profile) override {
        const double period = 1000.0 / setsPerSecond(profile, state_.traits);
        moveTime_ = static_cast<int>(std::clamp(period, kLeastMoveTime, 1000.0));
    }
    [[nodiscard]] LinkTrouble silence(bool never) const override;

    [[nodiscard]] Messages unloads(std::span<const std::size_t> servos) const;
    [[nodiscard]] int durationOf(std::span<const PulsePlan::Change> changes) const;
    [[nodiscard]] bool draining(Microseconds now) const;
    [[nodiscard]] bool namesItself() const { return product_.find("LOBOT") != std::string::npos; }
    void receive(const lewansoul::Voltage& voltage, Microseconds now);
    void receive(const lewansoul::Positions& positions, Microseconds now);
    void receive(const lewansoul::Other&, Microseconds) {}
    void receivePlace(const lewansoul::Place& place, Microseconds now);
    void askAll();
    void forgetStale(Microseconds now);

    bool hid_;
    int baud_;
    int moveTime_ = 20; ///< ms, at least
    Microseconds workedAt_{0};
    std::vector<Move> moves_; ///< by servo
    lewansoul::Parser parser_;
    std::vector<Microseconds> readAt_; ///< when each servo's position was
    Microseconds opened_{0};
    Microseconds lastBytes_{0};
    bool voltageAsked_ = false;
    std::size_t positionsAsked_ = 0; ///< questions that are open
    Repeater voltage_{kLewansoulVoltageEvery};
    Repeater question_{kLewansoulAskAgain};
    Repeater positions_{kLewansoulPositionsEvery};
    Repeater stopped_{kStoppedEvery};
};

void LewansoulController::begin(Microseconds now) {
    parser_.clear();
    opened_ = lastBytes_ = now;
    voltageAsked_ = false;
    positionsAsked_ = 0;
    voltage_.reset();
    question_.reset();
    positions_.reset();
    stopped_.reset();
    std::fill(readAt_.begin(), readAt_.end(), Microseconds{0});
}

/// Reports that were waiting in the system when the link was opened are of another time.
bool LewansoulController::draining(Microseconds now) const { return now >= opened_ && now - opened_ < kLewansoulDrain; }

void LewansoulController::take(std::span<const std::uint8_t> bytes, Microseconds now) {
    if (draining(now)) return;
    if (!hid_ && parser_.waiting() && now - lastBytes_ >= kFrameGap) { // the rest of a frame is not coming any more
        parser_.clear();
        ++state_.errors;
    }
    lastBytes_ = now;
    const std::uint64_t broken = parser_.broken();
    for (const lewansoul::Message& message : hid_ ? parser_.report(bytes) : parser_.feed(bytes))
        std::visit([&](const auto& m) { receive(m, now); }, message);
    state_.errors += parser_.broken() - broken;
}

/// That it knows its voltage tells a servo controller from all else under the same USB numbers.
void LewansoulController::receive(const lewansoul::Voltage& voltage, Microseconds now) {
    if (!voltageAsked_) return;
    voltageAsked_ = false;
    noteAnswer(now);
    if (!takeVoltage(voltage.volts)) voltage_.reset();
    if (state_.phase != ControllerPhase::handshake && state_.phase != ControllerPhase::refused) return;
    trouble(Concern::refusal, std::nullopt);
    voltage_.done(now);
    if (namesItself())
        becomeReady();
    else
        state_.phase = ControllerPhase::unidentified;
}

void LewansoulController::receive(const lewansoul::Positions& positions, Microseconds now) {
    if (positionsAsked_ == 0) return;
    --positionsAsked_;
    noteAnswer(now);
    for (const lewansoul::Place& place : positions.places) receivePlace(place, now);
}

void LewansoulController::receivePlace(const lewansoul::Place& place, Microseconds now) {
    const std::optional<std::size_t> servo = servoOn(place.servo);
    if (!servo || place.position < kLeastPosition || place.position > kMostPosition) {
        ++state_.errors;
        return;
    }
    state_.readPulses[*servo] = kHidZero + kHidStep * place.position;
    readAt_[*servo] = now;
}

void LewansoulController::work(Microseconds now) {
    workedAt_ = now;
    if (draining(now)) return;
    forgetStale(now);
    if (state_.phase == ControllerPhase::handshake && hid_ && !namesItself() && !everHeard() &&
        now - opened_ >= kSilence) {
        refuse({"this is no LewanSoul controller, though it has the same USB numbers: it calls itself '" + product_ +
                    "' and does not tell a battery voltage",
                "choose another device"});
    }
    const bool ready = state_.phase == ControllerPhase::ready;
    if (ready && hid_ ? voltage_.take(now) : question_.take(now)) {
        ask(lewansoul::askVoltage());
        voltageAsked_ = true;
    }
    if (ready && hid_ && positions_.take(now)) askAll();
}

void LewansoulController::askAll() {
    std::vector<int> channels;
    for (const ServoSetup& servo : plan_.servos()) channels.push_back(servo.channel);
    positionsAsked_ = 0;
    for (std::size_t first = 0; first < channels.size(); first += kServosPerReport) {
        const std::size_t count = std::min(kServosPerReport, channels.size() - first);
        ask(lewansoul::askPositions(std::span(channels).subspan(first, count)));
        ++positionsAsked_;
    }
}

void LewansoulController::forgetStale(Microseconds now) {
    for (std::size_t i = 0; i < readAt_.size(); ++i)
        if (now < readAt_[i] || now - readAt_[i] >= kStale) state_.readPulses[i].reset();
}

ControllerBase::Messages LewansoulController::unloads(std::span<const std::size_t> servos) const {
    Messages messages;
    for (std::size_t first = 0; first < servos.size(); first += kServosPerReport) {
        std::vector<int> channels;
        for (const std::size_t servo : servos.subspan(first, std::min(kServosPerReport, servos.size() - first)))
            channels.push_back(plan_.servos()[servo].channel);
        messages.push_back(lewansoul::unload(channels));
    }
    return messages;
}

/// A frame that was cut takes its rest from these: the second time they are whole.
ControllerBase::Messages LewansoulController::releases() const {
    std::vector<std::size_t> all(plan_.servos().size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return unloads(all);
}

/// Nothing tells whether a servo is under power: they are told again as long as they shall be limp.
ControllerBase::Messages LewansoulController::detachments(std::span<const std::size_t> servos) {
    Messages messages = unloads(servos);
    if (stopped_.take(now())) positions_.reset(); // where did they come to rest?
    return messages;
}

/// A servo goes its way in the time that it is told, so a way that has become longer than usual (a late tick, a move
/// that was not at its end) must get more of it: as much as the servo needs at the velocity of its profile.
int LewansoulController::durationOf(std::span<const PulsePlan::Change> changes) const {
    double seconds = 1e-3 * moveTime_;
    for (const PulsePlan::Change& change : changes) {
        const ServoSetup& setup = plan_.servos()[change.servo];
        const double velocity = fastestPulse(setup) / state_.traits.pulseStep;
        const double way = static_cast<double>(change.value) - moves_[change.servo].at(workedAt_);
        // It may have come to rest a little beside where it was told to be last.
        if (change.attach)
            seconds = std::max(seconds, kAttachSeconds);
        else if (velocity > 0.0)
            seconds = std::max(seconds, std::abs(way) / velocity);
    }
    return static_cast<int>(std::min(std::ceil(1e3 * seconds - 1e-6), 30'000.0));
}

ControllerBase::Messages LewansoulController::changes(std::span<const PulsePlan::Change> changes) {
    const int duration = durationOf(changes);
    Messages messages;
    for (std::size_t first = 0; first < changes.size(); first += kServosPerReport) {
        std::vector<lewansoul::Place> places;
        for (const PulsePlan::Change& change :
             changes.subspan(first, std::min(kServosPerReport, changes.size() - first))) {
            const int value = static_cast<int>(change.value);
            places.push_back({plan_.servos()[change.servo].channel, value});
            Move& move = moves_[change.servo];
            const double from = change.attach ? value : move.at(workedAt_);
            move = {from, static_cast<double>(value), workedAt_, std::chrono::milliseconds(duration)};
        }
        messages.push_back(lewansoul::move(places, duration));
    }
    return messages;
}

LinkTrouble LewansoulController::silence(bool never) const {
    if (!never) return {"the board has fallen silent", "check its cable, its power and its switch"};
    if (hid_) return {"the board does not answer", "switch its power on: USB alone does not feed it"};
    return {"no answer at " + std::to_string(baud_) + " baud",
            "LSC boards speak at 9600 baud; switch the power of its servos on, and cross RX and TX"};
}

} // namespace

std::unique_ptr<ServoController> makeLewansoul(const DeviceProfile& profile, const DeviceAddress& address) {
    return std::make_unique<LewansoulController>(profile, address);
}

} // namespace lumorph
