#include <algorithm>
#include <bit>
#include <cctype>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "devices/controllers/controller_base.h"
#include "devices/protocol/maestro.h"

namespace lumorph {

namespace {

constexpr double kQuarter = 0.25;
constexpr Microseconds kMaestroDrain{50'000};
constexpr Microseconds kErrorsEvery{200'000};
constexpr Microseconds kMaestroPositionsEvery{250'000};
constexpr Microseconds kAnswerWithin{250'000};
constexpr Microseconds kMaestroWordsLast{10'000'000};
constexpr long kNoPosition = -1;

/// With a number the board is addressed by it, so that others on the same line stay still; without one any board is.
maestro::Form formOf(const DeviceProfile& profile) {
    const bool addressed = profile.controllerNumber >= 0 && profile.controllerNumber <= 127;
    return {addressed, addressed ? profile.controllerNumber : 0, profile.maestroCrc};
}

std::size_t bytesOfTarget(const DeviceProfile& profile) { return maestro::setTarget(formOf(profile), 0, 0).size(); }

ControllerTraits maestroTraits(const DeviceProfile& profile, const DeviceAddress& address) {
    ControllerTraits traits;
    traits.name = "Pololu Maestro";
    traits.pulseStep = kQuarter;
    traits.commandsPerSecond = setsPerSecond(baudOf(address), bytesOfTarget(profile) * profile.servos.size());
    traits.failsafeWord = "only where a serial timeout is set in the board itself (Maestro Control Center, Serial "
                          "Settings): the studio can neither read nor set it. Without it servos stay under power where "
                          "they are when it hears nothing more";
    return traits;
}

PulseScale maestroScale(const DeviceProfile& profile, const DeviceAddress& address) {
    PulseScale scale;
    scale.detachGap = detachGap(baudOf(address), bytesOfTarget(profile) * profile.servos.size());
    return scale;
}

class MaestroController final : public ControllerBase {
public:
    MaestroController(const DeviceProfile& profile, const DeviceAddress& address)
        : MaestroController(profile, address, maestroTraits(profile, address)) {}

private:
    MaestroController(const DeviceProfile& profile, const DeviceAddress& address, const ControllerTraits& traits)
        : ControllerBase(profile, maestroScale(profile, address), traits), form_(formOf(profile)) {}

    void begin(Microseconds now) override;
    void take(std::span<const std::uint8_t> bytes, Microseconds now) override;
    void work(Microseconds now) override;
    [[nodiscard]] Messages detachments(std::span<const std::size_t> servos) override;
    [[nodiscard]] Messages releases() const override;
    [[nodiscard]] Messages changes(std::span<const PulsePlan::Change> changes) override;
    [[nodiscard]] LinkTrouble silence(bool never) const override;

    [[nodiscard]] bool draining(Microseconds now) const { return now >= drain_ && now - drain_ < kMaestroDrain; }
    [[nodiscard]] bool namesItself() const;
    void receive(const maestro::Errors& errors, Microseconds now);
    void receive(const maestro::Position& position, Microseconds now);
    void say(LinkTrouble trouble, Microseconds now);
    void letGo(LinkTrouble why, Microseconds now);
    [[nodiscard]] std::size_t servoToAskFor() const;
    void askPosition(Microseconds now);

    maestro::Form form_;
    maestro::Replies replies_;
    Microseconds drain_{0};
    Microseconds asked_{0};
    Repeater errors_{kErrorsEvery};
    Repeater positions_{kMaestroPositionsEvery};
    std::size_t next_ = 0;  ///< servo whose channel is asked for next
    int contrary_ = 0;      ///< answers in a row that tell of a servo that was let go
    bool oldErrors_ = true; ///< those told next are of before
    std::optional<Microseconds> words_;
    std::vector<long> positionsHeard_; ///< by servo, quarters, since it was told something; or kNoPosition
};

void MaestroController::begin(Microseconds now) {
    replies_.clear();
    drain_ = asked_ = now;
    errors_.reset();
    positions_.reset();
    contrary_ = 0;
    oldErrors_ = true;
    words_.reset();
    positionsHeard_.assign(plan_.servos().size(), kNoPosition);
}

bool MaestroController::namesItself() const {
    std::string text = product_;
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text.find("maestro") != std::string::npos;
}

void MaestroController::take(std::span<const std::uint8_t> bytes, Microseconds now) {
    if (draining(now)) return; // nobody knows what it answers
    const std::uint64_t broken = replies_.broken();
    for (const maestro::Message& message : replies_.feed(bytes)) {
        noteAnswer(now);
        std::visit([&](const auto& m) { receive(m, now); }, message);
    }
    if (replies_.broken() == broken) return;
    state_.errors += replies_.broken() - broken;
    replies_.clear();
    drain_ = now;
}

void MaestroController::receive(const maestro::Errors& errors, Microseconds now) {
    if (state_.phase == ControllerPhase::handshake) {
        if (namesItself())
            becomeReady();
        else
            state_.phase = ControllerPhase::unidentified;
    }
    if (std::exchange(oldErrors_, false) || errors.bits == 0) return;
    state_.errors += static_cast<std::uint64_t>(std::popcount(static_cast<unsigned>(errors.bits)));
    const LinkTrouble told{"the board reports: " + maestro::errorWords(errors.bits),
                           "see that device number and checksum are those of the board, and that cables are short"};
    if (errors.bits & maestro::kTimeoutError) {
        state_.traits.failsafe = true;
        state_.traits.failsafeWord =
            "the board has a serial timeout of its own: when the studio is silent, servos go to "
            "where the board's settings say, or off";
    }
    if (!(errors.bits & maestro::kTimeoutError) || !plan_.anyAttached()) {
        say(told, now);
        return;
    }
    letGo({told.why + "; servos went to where the board's settings say",
           "see that the link is not interrupted, then start the servos again"},
          now);
}

/// It tells what the board sends, not where the servo is: only that it sends nothing is news.
void MaestroController::receive(const maestro::Position& position, Microseconds now) {
    const std::optional<std::size_t> servo = servoOn(position.channel);
    if (!servo || asked_ <= plan_.since(*servo)) return;
    if (position.quarters != 0)
        plan_.detachAgain(*servo);
    else
        plan_.confirmLimp(*servo);
    if (!plan_.attached(*servo)) return;
    // On the way, where the board has a speed of its own for the channel, no two answers are alike.
    const auto quarters = static_cast<long>(position.quarters);
    const bool steady = std::exchange(positionsHeard_[*servo], quarters) == quarters;
    if (quarters != 0 && steady &&
        takeValue(*servo, quarters, quarters == plan_.told(*servo), asked_,
                  "widen Min and Max of its channel in the board's settings, or narrow the servo's pulses"))
        words_ = now;
    contrary_ = position.quarters != 0 ? 0 : contrary_ + 1;
    if (contrary_ >= 2)
        letGo({"the board has let go of its servos by itself: it started anew, or its own timeout has run out",
               "check the supply of its servos, then start them again"},
              now);
}

void MaestroController::say(LinkTrouble told, Microseconds now) {
    words_ = now;
    trouble(Concern::board, std::move(told));
}

void MaestroController::letGo(LinkTrouble why, Microseconds now) {
    rebooted();
    begin(now);
    say(std::move(why), now);
}

void MaestroController::work(Microseconds now) {
    if (words_ && (now < *words_ || now - *words_ >= kMaestroWordsLast)) {
        words_.reset();
        trouble(Concern::board, std::nullopt);
    }
    if (replies_.open() > 0 && (now < asked_ || now - asked_ >= kAnswerWithin)) {
        replies_.clear();
        drain_ = now;
    }
    if (draining(now) || replies_.open() > 0) return;
    if (errors_.take(now)) {
        ask(maestro::askErrors(form_));
        replies_.expectErrors();
        asked_ = now;
    } else if (state_.phase == ControllerPhase::ready && (plan_.detaching() || positions_.due(now))) {
        askPosition(now);
    }
}

/// In turn those that may not have let go yet, else those that hold, else all.
std::size_t MaestroController::servoToAskFor() const {
    const std::size_t count = plan_.servos().size();
    if (count == 0) return 0;
    for (std::size_t step = 1; step <= count; ++step)
        if (plan_.doubtful((next_ + step) % count)) return (next_ + step) % count;
    for (std::size_t step = 1; step <= count; ++step)
        if (plan_.attached((next_ + step) % count)) return (next_ + step) % count;
    return (next_ + 1) % count;
}

void MaestroController::askPosition(Microseconds now) {
    positions_.done(now);
    if (plan_.servos().empty()) return;
    next_ = servoToAskFor();
    const int channel = plan_.servos()[next_].channel;
    ask(maestro::askPosition(form_, channel));
    replies_.expectPosition(channel);
    asked_ = now;
}

ControllerBase::Messages MaestroController::detachments(std::span<const std::size_t> servos) {
    Messages messages;
    for (const std::size_t servo : servos)
        messages.push_back(maestro::setTarget(form_, plan_.servos()[servo].channel, 0));
    return messages;
}

ControllerBase::Messages MaestroController::releases() const {
    Messages messages;
    for (const ServoSetup& servo : plan_.servos()) messages.push_back(maestro::setTarget(form_, servo.channel, 0));
    return messages;
}

ControllerBase::Messages MaestroController::changes(std::span<const PulsePlan::Change> changes) {
    Messages messages;
    for (const PulsePlan::Change& change : changes) {
        messages.push_back(
            maestro::setTarget(form_, plan_.servos()[change.servo].channel, static_cast<int>(change.value)));
        positionsHeard_[change.servo] = kNoPosition;
    }
    return messages;
}

LinkTrouble MaestroController::silence(bool never) const {
    if (!never) return {"the board has fallen silent", "check its cable and its power"};
    const std::string which =
        form_.addressed ? "no Maestro with device number " + std::to_string(form_.device) + " answers" : "no answer";
    return {which, "use the first of its two ports (the command port), set its serial mode to USB Dual Port in the "
                   "Maestro Control Center, and give the profile the board's device number and checksum setting"};
}

} // namespace

std::unique_ptr<ServoController> makeMaestro(const DeviceProfile& profile, const DeviceAddress& address) {
    refuseHid(profile, address, "a Maestro is not reached over HID",
              "use the address of its command port, such as serial:///dev/ttyACM0");
    return std::make_unique<MaestroController>(profile, address);
}

} // namespace lumorph
