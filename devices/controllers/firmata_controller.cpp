#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "devices/controllers/controller_base.h"
#include "devices/protocol/firmata.h"

namespace lumorph {

namespace {

constexpr std::string_view kOwnFirmware = "LumorphTablet";
constexpr std::array<std::string_view, 4> kKnown = {kOwnFirmware, "StandardFirmata", "ConfigurableFirmata",
                                                    "ServoFirmata"};
constexpr int kDoubts = 2;
constexpr Microseconds kFirmataAskAgain{500'000};
constexpr Microseconds kHeartbeat{200'000}; // our firmware's watchdog waits for 500 ms
constexpr Microseconds kStateAtLeast{400'000};
constexpr double kOwnLeastPulse = 500.0;  // microseconds, since 1.1; before, and in stock firmware, less is degrees
constexpr int kSoftSince = 2;             // minor version of ours that bounds the step from frame to frame
constexpr double kFrameSeconds = 0.020;   // of it
constexpr double kGreatestStep = 16383.0; // microseconds that can be told
constexpr long kSameValue = 4;            // microseconds: firmware keeps off its limits by one or two
constexpr std::size_t kBytesOfDetach = 4;
constexpr std::size_t kMostStatesAsked = 256; // far more than two seconds hold
constexpr int kLimpModes = 3;                 // input, output, analog: what a pin is that drives no servo
constexpr Microseconds kFirmataVoltageEvery{2'000'000};
constexpr Microseconds kFirmataWordsLast{10'000'000};
constexpr std::size_t kLongestWords = 80;

/// Sketches call themselves by their file.
std::string withoutSuffix(std::string name) {
    for (const char* suffix : {".ino", ".cpp"})
        if (name.ends_with(suffix)) name.resize(name.size() - 4);
    return name;
}

/// What a device says, fit for a user's eyes.
std::string readable(std::string text) {
    text.resize(std::min(text.size(), kLongestWords));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7E; }, '?');
    return text;
}

std::size_t bytesOfSet(const DeviceProfile& profile) {
    std::size_t bytes = 0;
    for (const ServoSetup& servo : profile.servos) bytes += servo.channel < 16 ? 3 : 6;
    return bytes;
}

ControllerTraits firmataTraits(const DeviceProfile& profile, const DeviceAddress& address) {
    ControllerTraits traits;
    traits.name = "Firmata";
    traits.commandsPerSecond = setsPerSecond(baudOf(address), bytesOfSet(profile));
    return traits;
}

PulseScale firmataScale(const DeviceProfile& profile, const DeviceAddress& address) {
    PulseScale scale;
    scale.least = kOwnLeastPulse; // which firmware it is will be known later
    scale.detachGap = detachGap(baudOf(address), kBytesOfDetach * profile.servos.size());
    return scale;
}

/// By how many microseconds a servo may move in a frame of the board, rounded up so that it never lags behind.
int stepOf(const ServoSetup& servo) {
    const double step = fastestPulse(servo) * kFrameSeconds;
    return static_cast<int>(std::clamp(std::ceil(step), 1.0, kGreatestStep));
}

/// What our firmware, and the stock one, have to say (devices/firmware/tablet/firmata.cpp).
std::string remedyFor(std::string_view text) {
    if (text.starts_with("Silence")) return "see that the link is not interrupted, then start the servos again";
    if (text.starts_with("Bytes were lost")) return "check plugs and ground, or bring the radio nearer";
    if (text.starts_with("Started anew"))
        return "start the servos again; where it comes again, upload the sketch again and see to the board's supply";
    return "see that the channels of the profile are those of the wiring";
}

/// A message that also gets the board out of one whose end was lost.
firmata::Bytes certain(firmata::Bytes message) {
    message.insert(message.begin(), firmata::kEndOfMessage);
    return message;
}

class FirmataController final : public ControllerBase {
public:
    FirmataController(const DeviceProfile& profile, const DeviceAddress& address)
        : FirmataController(profile, address, firmataTraits(profile, address)) {}

private:
    FirmataController(const DeviceProfile& profile, const DeviceAddress& address, const ControllerTraits& traits)
        : ControllerBase(profile, firmataScale(profile, address), traits), address_(address) {
        told_.resize(profile.servos.size());
        becomeKind(false);
    }

    void begin(Microseconds now) override;
    void take(std::span<const std::uint8_t> bytes, Microseconds now) override;
    void work(Microseconds now) override;
    [[nodiscard]] Messages detachments(std::span<const std::size_t> servos) override;
    [[nodiscard]] Messages releases() const override;
    [[nodiscard]] Messages changes(std::span<const PulsePlan::Change> changes) override;
    [[nodiscard]] LinkTrouble silence(bool never) const override;

    void startHandshake();
    void receive(const firmata::Version& version);
    void receive(const firmata::Firmware& firmware);
    void receive(const firmata::Capabilities& capabilities);
    void receive(const firmata::PinState& pin);
    void receive(const firmata::Text& text);
    void receive(const firmata::Voltage& voltage);
    void receive(const firmata::AnalogMapping&) {}
    void receive(const firmata::Reading&) {}
    void askCapabilitiesOnce();
    void askForDoubts(Microseconds now);
    void askState(Microseconds now);
    [[nodiscard]] std::size_t servoToAskFor();
    void becomeKind(bool own);
    [[nodiscard]] bool refusesPulses();
    void tellOfShortPulses();

    DeviceAddress address_;
    firmata::Parser parser_;
    Microseconds heardAt_{0}; ///< of the message that is being heard
    std::optional<firmata::Version> version_;
    std::optional<std::string> firmware_; ///< its name
    bool capabilitiesAsked_ = false;
    int doubts_ = 0;                           ///< times that an unknown name was asked for again
    std::optional<Microseconds> doubtAskedAt_; ///< the last of them
    bool own_ = false;
    Repeater question_{kFirmataAskAgain};
    Repeater heartbeat_{kHeartbeat};
    Repeater stateAtLeast_{kStateAtLeast};
    Repeater voltage_{kFirmataVoltageEvery};
    struct Question {
        int pin = 0;
        Microseconds at{0};
    };
    [[nodiscard]] std::optional<Microseconds> takeQuestion(int pin);
    std::deque<Question> statesAsked_;  ///< for a pin's state, that are open
    std::size_t asked_ = 0;             ///< servo whose state was asked for last
    int contrary_ = 0;                  ///< answers in a row that tell of a servo that was let go
    std::optional<Microseconds> words_; ///< when the board said something
    /// What our firmware knows of a servo, microseconds.
    struct Bounds {
        int least = 0, greatest = 0;
        int step = 0; ///< 0: it knows of none
        bool operator==(const Bounds&) const = default;
    };
    [[nodiscard]] Bounds boundsOf(std::size_t servo) const;
    bool soft_ = false; ///< our firmware bounds the step from frame to frame
    std::vector<Bounds> told_;
};

void FirmataController::begin(Microseconds now) {
    parser_.clear();
    words_.reset();
    becomeKind(false);
    startHandshake();
    work(now);
}

void FirmataController::startHandshake() {
    version_.reset();
    firmware_.reset();
    capabilitiesAsked_ = false;
    doubts_ = 0;
    doubtAskedAt_.reset();
    question_.reset();
    voltage_.reset();
    statesAsked_.clear();
    contrary_ = 0;
    state_.firmware.clear();
    state_.volts.reset();
}

void FirmataController::becomeKind(bool own) {
    own_ = own;
    soft_ = false;
    plan_.setLeast(firmata::kLeastMicroseconds);
    state_.traits.failsafe = own;
    state_.traits.readsVoltage = own;
    state_.traits.jumpsOnAttach = !own;
    state_.traits.failsafeWord =
        own ? "when the studio has been silent for half a second, the board holds its servos and then lets go of them"
            : "none of its own: when it hears nothing more, servos stay under power where they are";
}

void FirmataController::take(std::span<const std::uint8_t> bytes, Microseconds now) {
    const std::uint64_t broken = parser_.broken();
    for (const firmata::Message& message : parser_.feed(bytes)) {
        heardAt_ = now;
        noteAnswer(now);
        std::visit([this](const auto& m) { receive(m); }, message);
    }
    state_.errors += parser_.broken() - broken;
}

void FirmataController::receive(const firmata::Version& version) {
    if (version.major < 1 || version.major > 3) { // no such thing exists: noise
        ++state_.errors;
        return;
    }
    if (state_.phase != ControllerPhase::handshake) { // nobody asked
        rebooted();
        startHandshake();
    }
    version_ = version;
    if (version.major != 2) {
        refuse({"the board speaks Firmata " + std::to_string(version.major) + "." + std::to_string(version.minor),
                "upload StandardFirmata 2.x, or the firmware of the studio"});
        return;
    }
    askCapabilitiesOnce();
}

void FirmataController::receive(const firmata::Firmware& firmware) {
    // The answer to a doubt, which may come when the user has already settled it.
    const bool asked = doubtAskedAt_ && heardAt_ - *doubtAskedAt_ < kFirmataAskAgain;
    if (asked && firmware_ == withoutSuffix(firmware.name)) return;
    if (asked && state_.phase == ControllerPhase::unidentified) {
        state_.phase = ControllerPhase::handshake;
        capabilitiesAsked_ = false;
    } else if (state_.phase != ControllerPhase::handshake) {
        rebooted();
        startHandshake();
    }
    firmware_ = withoutSuffix(firmware.name);
    state_.firmware =
        readable(*firmware_) + " " + std::to_string(firmware.major) + "." + std::to_string(firmware.minor);
    becomeKind(*firmware_ == kOwnFirmware);
    if (own_ && (firmware.major > 1 || firmware.minor > 0)) plan_.setLeast(kOwnLeastPulse);
    soft_ = own_ && (firmware.major > 1 || firmware.minor >= kSoftSince);
    askCapabilitiesOnce();
}

/// Both names are known: what remains is asked at once, and again with the next question.
void FirmataController::askCapabilitiesOnce() {
    if (!version_ || !firmware_ || capabilitiesAsked_) return;
    capabilitiesAsked_ = true;
    ask(firmata::askCapabilities());
    question_.done(heardAt_);
}

void FirmataController::receive(const firmata::Capabilities& capabilities) {
    if (state_.phase != ControllerPhase::handshake || !version_ || !firmware_) return;
    for (const ServoSetup& servo : plan_.servos()) {
        const auto pin = static_cast<std::size_t>(servo.channel);
        const auto drivesServo = [](const firmata::PinMode& mode) { return mode.mode == firmata::kServoMode; };
        if (pin < capabilities.pins.size() &&
            std::any_of(capabilities.pins[pin].begin(), capabilities.pins[pin].end(), drivesServo))
            continue;
        refuse({"pin " + std::to_string(servo.channel) + " of the board cannot drive a servo",
                "put the servo on another pin and tell its channel, or upload a firmware that drives servos there"});
        return;
    }
    if (refusesPulses()) return;
    if (std::find(kKnown.begin(), kKnown.end(), *firmware_) != kKnown.end()) {
        becomeReady();
    } else {
        state_.phase = ControllerPhase::unidentified;
        question_.done(heardAt_);
    }
    tellOfShortPulses();
}

/// A name that nobody knows may be a known one that noise has hit: it is asked for again, a few times.
void FirmataController::askForDoubts(Microseconds now) {
    if (state_.phase != ControllerPhase::unidentified || doubts_ == kDoubts || !question_.take(now)) return;
    ++doubts_;
    doubtAskedAt_ = now;
    ask(firmata::askFirmware());
}

/// A servo all of whose pulses are shorter than the firmware can be told.
bool FirmataController::refusesPulses() {
    for (std::size_t i = 0; i < plan_.servos().size(); ++i) {
        if (plan_.hasValue(i)) continue;
        refuse(
            {"servo " + std::to_string(i + 1) + " takes pulses below 544 us only, and this firmware cannot make them",
             "widen its range, or upload the firmware of the studio"});
        return true;
    }
    return false;
}

void FirmataController::tellOfShortPulses() {
    std::string cut;
    for (std::size_t i = 0; i < plan_.servos().size(); ++i)
        if (std::ceil(plan_.servos()[i].pulseMin) < static_cast<double>(plan_.valueOf(i, 0.0)))
            cut += (cut.empty() ? "" : ", ") + std::to_string(i + 1);
    if (cut.empty()) return;
    words_ = heardAt_;
    trouble(Concern::board, LinkTrouble{"this firmware makes no pulse shorter than 544 us (servo " + cut + ")",
                                        "set the least pulse to 544 us, or upload the firmware of the studio"});
}

/// When the question was asked that a pin's state answers: the oldest for that pin, since a board answers in order;
/// what was asked before has lost its answer. Too old is safe, for then the answer counts less; too young would take
/// what a slow link still tells of before an attach for what came of it.
std::optional<Microseconds> FirmataController::takeQuestion(int pin) {
    const auto found = std::ranges::find(statesAsked_, pin, &Question::pin);
    if (found == statesAsked_.end()) return std::nullopt;
    const Microseconds at = found->at;
    statesAsked_.erase(statesAsked_.begin(), found + 1);
    return at;
}

/// Nothing else tells that a command has arrived, or that the watchdog has let go of the servos.
void FirmataController::receive(const firmata::PinState& pin) {
    const std::optional<Microseconds> asked = takeQuestion(pin.pin);
    const std::optional<std::size_t> servo = servoOn(pin.pin);
    if (!asked || !servo || *asked <= plan_.since(*servo)) return;
    const bool drives = pin.mode == firmata::kServoMode;
    if (drives) plan_.detachAgain(*servo);
    if (pin.mode >= 0 && pin.mode < kLimpModes) plan_.confirmLimp(*servo);
    if (!plan_.attached(*servo)) return;
    const auto value = static_cast<long>(pin.value);
    if (drives && takeValue(*servo, value, std::abs(value - plan_.told(*servo)) <= kSameValue, *asked,
                            own_ ? "write the board's sketch for this profile again and upload it, or narrow the "
                                   "servo's pulses to what the board was given"
                                 : "narrow the servo's pulses to what this firmware makes"))
        words_ = heardAt_;
    contrary_ = drives ? 0 : contrary_ + 1;
    if (contrary_ < 2) return;
    rebooted();
    startHandshake();
    words_ = heardAt_;
    trouble(Concern::board, LinkTrouble{"the board has let go of its servos by itself",
                                        "see that the link is not interrupted, then start the servos again"});
}

void FirmataController::receive(const firmata::Text& text) {
    if (text.text.empty()) return;
    if (text.text.starts_with("Silence") && wasStuckLately()) return; // it was ours, and is no trouble of the board
    if (state_.phase != ControllerPhase::handshake) ++state_.errors;
    words_ = heardAt_;
    trouble(Concern::board, LinkTrouble{"the board says '" + readable(text.text) + "'", remedyFor(text.text)});
}

void FirmataController::receive(const firmata::Voltage& voltage) {
    if (own_ && !takeVoltage(voltage.volts)) voltage_.reset();
}

void FirmataController::work(Microseconds now) {
    if (words_ && (now < *words_ || now - *words_ >= kFirmataWordsLast)) {
        words_.reset();
        trouble(Concern::board, std::nullopt);
    }
    if (state_.phase == ControllerPhase::handshake) {
        if (!question_.take(now)) return;
        if (!version_) ask(firmata::askVersion());
        if (!firmware_) ask(firmata::askFirmware());
        if (version_ && firmware_) ask(firmata::askCapabilities());
        return;
    }
    askForDoubts(now);
    if (own_ && voltage_.take(now)) ask(firmata::askVoltage());
    const bool quiet = now - lastWritten() >= kHeartbeat;
    if ((quiet && heartbeat_.due(now)) || stateAtLeast_.due(now)) askState(now);
}

void FirmataController::askState(Microseconds now) {
    if (plan_.servos().empty()) return;
    const int pin = plan_.servos()[servoToAskFor()].channel;
    ask(firmata::askPinState(pin));
    heartbeat_.done(now);
    stateAtLeast_.done(now);
    statesAsked_.push_back({pin, now});
    // No answer is older: after a second of silence the link is given up.
    while (statesAsked_.size() > kMostStatesAsked || now - statesAsked_.front().at > 2 * kSilence)
        statesAsked_.pop_front();
}

/// In turn those that may not have let go yet, else those that hold.
std::size_t FirmataController::servoToAskFor() {
    const std::size_t count = plan_.servos().size();
    for (std::size_t step = 1; step <= count; ++step)
        if (plan_.doubtful((asked_ + step) % count)) return asked_ = (asked_ + step) % count;
    for (std::size_t step = 1; step <= count; ++step)
        if (plan_.attached((asked_ + step) % count)) return asked_ = (asked_ + step) % count;
    return 0;
}

FirmataController::Bounds FirmataController::boundsOf(std::size_t servo) const {
    return {static_cast<int>(plan_.valueOf(servo, 0.0)), static_cast<int>(plan_.valueOf(servo, 1e5)),
            soft_ ? stepOf(plan_.servos()[servo]) : 0};
}

/// Where none shall hold, a reset says so again and again: it is one byte, so that nothing can be missing in it. Of
/// other messages a line that loses bytes makes new ones: the mode of one pin and the number of the next may attach a
/// servo.
ControllerBase::Messages FirmataController::detachments(std::span<const std::size_t> servos) {
    const bool ready = state_.phase == ControllerPhase::ready;
    const bool resets = ready && !plan_.anyAttached();
    Messages messages;
    for (const std::size_t servo : servos)
        if (!resets || plan_.since(servo) == now() || !plan_.detaching())
            messages.push_back(certain(firmata::detachServo(plan_.servos()[servo].channel)));
    if (resets) messages.push_back(certain(firmata::resetBoard()));
    if (ready) askState(now());
    return messages;
}

ControllerBase::Messages FirmataController::releases() const {
    Messages messages;
    for (const ServoSetup& servo : plan_.servos()) messages.push_back(certain(firmata::detachServo(servo.channel)));
    messages.push_back(certain(firmata::resetBoard()));
    return messages;
}

/// Our firmware takes the pulse first and starts from it; a stock one ignores it until the servo is attached, so it
/// comes right behind, to end the jump to the middle. Ours clamps to the limits that it was told and goes no faster, so
/// other ones go before the first pulse that they are for.
ControllerBase::Messages FirmataController::changes(std::span<const PulsePlan::Change> changes) {
    Messages messages;
    for (const PulsePlan::Change& change : changes) {
        const int pin = plan_.servos()[change.servo].channel;
        const int pulse = static_cast<int>(change.value);
        const Bounds bounds = boundsOf(change.servo);
        if (change.attach && own_) messages.push_back(firmata::writeValue(pin, pulse));
        if (own_ && (change.attach || told_[change.servo] != bounds)) {
            messages.push_back(firmata::configureServo(pin, bounds.least, bounds.greatest));
            if (soft_) messages.push_back(firmata::limitStep(pin, bounds.step));
            told_[change.servo] = bounds;
        }
        if (change.attach) messages.push_back(firmata::attachServo(pin));
        messages.push_back(firmata::writeValue(pin, pulse));
    }
    // Old stock firmware writes what it takes for an endless message over its memory: with each set it ends.
    if (!own_ && !messages.empty()) messages.front() = certain(std::move(messages.front()));
    return messages;
}

LinkTrouble FirmataController::silence(bool never) const {
    if (!never) return {"the board has fallen silent", "check its cable, its power and the battery of its servos"};
    const std::string where = std::holds_alternative<BluetoothAddress>(address_)
                                  ? "over Bluetooth"
                                  : "at " + std::to_string(baudOf(address_)) + " baud";
    return {"no answer " + where + (parser_.broken() > 0 ? ", only bytes that make no sense" : ""),
            "try 57600 baud (StandardFirmata), 115200 (ConfigurableFirmata) or 9600 (most HC-06), and see that the "
            "board has power and runs Firmata"};
}

} // namespace

std::unique_ptr<ServoController> makeFirmata(const DeviceProfile& profile, const DeviceAddress& address) {
    refuseHid(profile, address, "Firmata is not spoken over HID", "use a serial or a Bluetooth address");
    return std::make_unique<FirmataController>(profile, address);
}

} // namespace lumorph
