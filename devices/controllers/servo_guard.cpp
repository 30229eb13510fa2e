#include "devices/controllers/servo_guard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "devices/controllers/servo_motion.h"

namespace lumorph {
namespace {

constexpr double kHoldSeconds = 0.1;     // a slow link may be so late with a servo's first pulse
constexpr double kJumpSeconds = 0.5;     // a servo that jumped to its place gets this long to come there
constexpr double kReadingError = 0.02;   // strokes beyond its limits that a servo read back may seem to stand
constexpr double kRounding = 1e-9;       // strokes
constexpr double kWiggleStroke = 0.05;   // to each side
constexpr double kWiggleVelocity = 0.25; // share of the velocity
constexpr double kLegDone = 1e-3;        // strokes from the end of a wiggle's way
constexpr double kSettledStroke = 1e-5;
constexpr double kCarefulVelocity = 0.25; // strokes a second on ways that nobody expects
constexpr double kSettledVelocity = 1e-3;

/// The way of a wiggle, and how far it has come.
struct Wiggle {
    std::array<double, 5> ends;
    std::size_t leg = 0;
};

/// One servo. Its position may lie a little outside [0, 1]: where a new trim or new limits found it.
struct Servo {
    ServoSetup setup;
    std::optional<ServoSetup> nextSetup; ///< once it stands still
    ServoMotion motion;
    std::optional<double> wanted;
    std::optional<Wiggle> wiggle;
    bool attached = false;
    bool released = true; ///< a step has told that it is limp: attached again without it, it would stop dead
    bool known = false;   ///< somebody knows where it is
    bool pending = false; ///< to be attached by the soft start
    bool easing = false;  ///< on its way from where it was attached, or to where new pulse limits put it
    double behind = 0.0;  ///< strokes that it was short of its target before the last step
    double hold = 0.0;    ///< seconds before it may move, once attached
    double sent = 0.0;    ///< microseconds, while attached

    /// Without clamping: what moves steadily in strokes does so in microseconds.
    [[nodiscard]] double pulse() const noexcept { return freePulseOf(setup, motion.position); }
    /// Strokes whose pulses lie within the limits; the trim moves them out of [0, 1].
    [[nodiscard]] std::pair<double, double> range() const noexcept {
        const double ends[] = {strokeOf(setup, setup.pulseMin), strokeOf(setup, setup.pulseMax)};
        return std::minmax(ends[0], ends[1]);
    }
    /// The nearest stroke that may be asked for. Were it left to the pulse to be clamped, it would stop dead there.
    [[nodiscard]] double allowed(double stroke) const noexcept {
        const auto [low, high] = range();
        return std::clamp(stroke, std::max(0.0, low), std::min(1.0, high));
    }
    [[nodiscard]] bool stands() const noexcept { return motion.velocity == 0.0; }
    [[nodiscard]] double target() const noexcept {
        if (wiggle) return wiggle->ends[wiggle->leg];
        return wanted ? allowed(*wanted) : motion.position;
    }

    void locate(std::optional<double> stroke, double error = kRounding) noexcept {
        const auto [low, high] = range();
        known = stroke && *stroke >= low - error && *stroke <= high + error;
        if (known) motion.position = std::clamp(*stroke, low, high);
    }
    void detach() noexcept {
        released = released && !attached;
        attached = pending = easing = false;
        hold = 0.0;
        motion.velocity = 0.0;
        wiggle.reset();
        if (nextSetup) adopt(*std::exchange(nextSetup, std::nullopt));
        locate(known ? std::optional(motion.position) : std::nullopt);
    }
    /// The pulse stays where it is, and what it means in strokes changes.
    void adopt(const ServoSetup& next) noexcept {
        const double at = strokeOf(next, pulse());
        behind = 0.0;
        easing = attached && (easing || next.pulseMin != setup.pulseMin || next.pulseMax != setup.pulseMax ||
                              next.trim != setup.trim);
        setup = next;
        motion = {at, 0.0};
        if (!attached) locate(known ? std::optional(at) : std::nullopt);
    }
    void attach() noexcept {
        attached = true;
        pending = false;
        if (!known) motion.position = allowed(wanted.value_or(0.0));
        motion.velocity = behind = 0.0;
        easing = true;
        sent = std::clamp(pulse(), setup.pulseMin, setup.pulseMax);
    }
    /// Where limits were drawn in past it, it may stay and come nearer, but not go farther. Else this only rounds.
    void send() noexcept { sent = std::clamp(pulse(), std::min(setup.pulseMin, sent), std::max(setup.pulseMax, sent)); }
};

std::vector<Servo> servosOf(const DeviceProfile& profile) {
    std::vector<Servo> servos(profile.servos.size());
    for (std::size_t i = 0; i < servos.size(); ++i) servos[i].setup = profile.servos[i];
    return servos;
}

} // namespace

// What a limp servo is known to do: after an orderly end and after STOP it is taken to be where it was sent last, if it
// had come there. It may have been moved by hand since; but the start is then the same jump that asking would end in,
// and asking each time would teach people to agree unread. A board that reads positions corrects it, and after a reboot
// the link says that nothing is known. A servo stopped before it can have come out of its first jump stays unknown.
struct ServoGuard::Data {
    DeviceProfile profile;
    std::vector<Servo> servos;
    std::vector<double> positions;
    Phase phase = Phase::disarmed;
    bool slow = false;
    bool jumpAllowed = false;
    double pause = 0.0; ///< seconds before the next servo may be attached, kept through disarming too
    std::optional<Microseconds> last;
    std::uint64_t clamped = 0;
    std::uint64_t refused = 0;

    [[nodiscard]] bool armed() const noexcept { return phase == Phase::starting || phase == Phase::live; }
    [[nodiscard]] bool mayStart(const Servo& servo) const noexcept {
        return servo.pending && (servo.known || jumpAllowed);
    }

    /// Seconds since the last step that count. The difference is that of unsigned numbers: times may be anything.
    double elapsed(Microseconds now) noexcept {
        const Microseconds before = std::exchange(last, now).value_or(now);
        if (now <= before) return 0.0;
        const auto gap = static_cast<std::uint64_t>(now.count()) - static_cast<std::uint64_t>(before.count());
        return 1e-6 * static_cast<double>(std::min(gap, static_cast<std::uint64_t>(kLongestStep.count())));
    }

    [[nodiscard]] ServoMotionLimits limitsOf(const Servo& servo) const noexcept {
        const double share = slow ? profile.slowShare : 1.0;
        const double velocity = servo.setup.maxVelocity * share * (servo.wiggle ? kWiggleVelocity : 1.0);
        return {servo.easing ? std::min(velocity, kCarefulVelocity) : velocity, servo.setup.maxAcceleration * share,
                servo.setup.maxAcceleration};
    }

    void move(Servo& servo, double seconds) noexcept {
        if (seconds <= 0.0) return;
        if (servo.hold > 0.0) {
            servo.hold -= seconds;
            if (servo.hold <= 0.0) servo.known = true;
            return;
        }
        servo.known = true;
        if (servo.nextSetup) {
            // Towards where it is: braking alone.
            servo.motion = movedServo(servo.motion, servo.motion.position, seconds, limitsOf(servo));
            if (servo.stands()) servo.adopt(*std::exchange(servo.nextSetup, std::nullopt));
            return;
        }
        const double left = servo.target() - servo.motion.position;
        // A show that goes on is caught up with where it comes by.
        if (std::abs(left) < kSettledStroke || left * servo.behind < 0.0) servo.easing = false;
        servo.behind = left;
        servo.motion = movedServo(servo.motion, servo.target(), seconds, limitsOf(servo));
        if (servo.wiggle && std::abs(servo.target() - servo.motion.position) < kLegDone &&
            ++servo.wiggle->leg == servo.wiggle->ends.size())
            servo.wiggle.reset();
    }

    /// One servo in a step at most, in order. It is attached where it is, and moves in a later step.
    void attachNext() noexcept {
        const auto next =
            std::ranges::find_if(servos, [this](const Servo& servo) { return mayStart(servo) && servo.released; });
        if (pause > 0.0 || next == servos.end()) return;
        next->hold = std::max(profile.staggerSeconds, next->known ? kHoldSeconds : kJumpSeconds);
        next->attach();
        pause = profile.staggerSeconds;
    }

    void endStart() noexcept {
        const auto busy = [this](const Servo& servo) { return mayStart(servo) || servo.hold > 0.0; };
        if (phase != Phase::starting || std::ranges::any_of(servos, busy)) return;
        phase = Phase::live;
        // Who is read only later does not stiffen unasked, maybe under somebody's hand.
        for (Servo& servo : servos) servo.pending = false;
    }

    void change(Servo& servo, const ServoSetup& setup) {
        if (setup == servo.setup) {
            servo.nextSetup.reset();
            return;
        }
        servo.wiggle.reset();
        servo.nextSetup.reset();
        if (setup.channel != servo.setup.channel) {
            // Another servo hangs there.
            servo.detach();
            servo.known = false;
        } else if (setup.reversed != servo.setup.reversed) {
            servo.detach();
        } else if (servo.attached && !servo.stands()) {
            servo.nextSetup = setup;
            return;
        }
        servo.adopt(setup);
    }

    [[nodiscard]] GuardedPulse pulseOf(const Servo& servo) const noexcept {
        return {servo.setup.channel, servo.attached ? servo.sent : 0.0, servo.attached};
    }
};

ServoGuard::ServoGuard(GuardKey /*key*/, const DeviceProfile& profile) : data_(std::make_unique<Data>()) {
    checkProfile(profile);
    data_->profile = profile;
    data_->servos = servosOf(profile);
}

ServoGuard::~ServoGuard() = default;
ServoGuard::ServoGuard(ServoGuard&&) noexcept = default;
ServoGuard& ServoGuard::operator=(ServoGuard&&) noexcept = default;

void ServoGuard::setProfile(const DeviceProfile& profile) {
    checkProfile(profile);
    Data& data = *data_;
    data.profile = profile;
    if (profile.servos.size() != data.servos.size()) {
        disarm();
        data.servos = servosOf(profile);
        return;
    }
    for (std::size_t i = 0; i < data.servos.size(); ++i) data.change(data.servos[i], profile.servos[i]);
}

void ServoGuard::setKnown(std::size_t servo, std::optional<double> stroke) {
    if (servo >= data_->servos.size()) return;
    Servo& one = data_->servos[servo];
    if (stroke && !std::isfinite(*stroke)) stroke.reset();
    // Where an attached servo is, is what it was sent; without that it cannot be led on.
    if (one.attached && stroke) return;
    const bool pending = one.pending;
    one.detach();
    one.pending = pending;
    one.locate(stroke, kReadingError);
}

std::optional<double> ServoGuard::known(std::size_t servo) const {
    if (servo >= data_->servos.size() || !data_->servos[servo].known) return std::nullopt;
    return data_->servos[servo].motion.position;
}

void ServoGuard::arm(bool jumpAllowed) {
    data_->phase = Phase::starting;
    data_->jumpAllowed = jumpAllowed;
    for (Servo& servo : data_->servos) servo.pending = !servo.attached;
}

std::vector<std::size_t> ServoGuard::waiting() const {
    std::vector<std::size_t> servos;
    if (!data_->armed()) return servos;
    for (std::size_t i = 0; i < data_->servos.size(); ++i) {
        const Servo& servo = data_->servos[i];
        if (!servo.attached && !servo.known && !data_->mayStart(servo)) servos.push_back(i);
    }
    return servos;
}

void ServoGuard::disarm() {
    for (Servo& servo : data_->servos) servo.detach();
    if (data_->phase != Phase::stopped) data_->phase = Phase::disarmed;
}

void ServoGuard::stop() {
    disarm();
    data_->phase = Phase::stopped;
}

bool ServoGuard::want(std::span<const double> strokes) {
    const auto finite = [](double stroke) { return std::isfinite(stroke); };
    if (strokes.size() != data_->servos.size() || !std::ranges::all_of(strokes, finite)) {
        ++data_->refused;
        return false;
    }
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        const double stroke = std::clamp(strokes[i], 0.0, 1.0);
        if (stroke != strokes[i]) ++data_->clamped;
        data_->servos[i].wanted = stroke;
    }
    return true;
}

double ServoGuard::wanted(std::size_t servo) const noexcept {
    if (servo >= data_->servos.size()) return 0.0;
    const Servo& one = data_->servos[servo];
    return one.wanted.value_or(one.known ? one.motion.position : 0.0);
}

bool ServoGuard::wiggle(std::size_t servo) {
    Data& data = *data_;
    if (data.phase != Phase::live || servo >= data.servos.size() || !data.servos[servo].attached ||
        data.servos[servo].wiggle || data.servos[servo].nextSetup) {
        ++data.refused;
        return false;
    }
    Servo& one = data.servos[servo];
    const double here = one.allowed(one.motion.position);
    const double above = one.allowed(here + kWiggleStroke);
    const double below = one.allowed(here - kWiggleStroke);
    if (!one.wanted) one.wanted = std::clamp(one.motion.position, 0.0, 1.0);
    one.wiggle = Wiggle{{above, below, above, below, here}};
    return true;
}

void ServoGuard::setSlow(bool slow) { data_->slow = slow; }

GuardedPulses ServoGuard::step(Microseconds now) {
    Data& data = *data_;
    const double seconds = data.elapsed(now);
    data.pause = std::max(data.pause - seconds, 0.0);
    for (Servo& servo : data.servos) {
        if (servo.attached) {
            data.move(servo, seconds);
            servo.send();
        }
    }
    if (data.phase == Phase::starting) data.attachNext();
    data.endStart();
    std::vector<GuardedPulse> pulses;
    pulses.reserve(data.servos.size());
    for (Servo& servo : data.servos) {
        servo.released = !servo.attached;
        pulses.push_back(data.pulseOf(servo));
    }
    return {GuardKey(), std::move(pulses)};
}

ServoGuard::Phase ServoGuard::phase() const noexcept { return data_->phase; }

bool ServoGuard::settled() const noexcept {
    if (data_->phase == Phase::starting) return false;
    return std::ranges::none_of(data_->servos, [](const Servo& servo) {
        return servo.attached && (servo.wiggle || servo.nextSetup || servo.hold > 0.0 ||
                                  std::abs(servo.target() - servo.motion.position) > kSettledStroke ||
                                  std::abs(servo.motion.velocity) > kSettledVelocity);
    });
}

bool ServoGuard::withinLimits() const noexcept {
    return std::ranges::all_of(data_->servos, [](const Servo& servo) {
        const bool outside = servo.sent < servo.setup.pulseMin || servo.sent > servo.setup.pulseMax;
        return !servo.nextSetup && !(servo.attached && outside);
    });
}

std::span<const double> ServoGuard::strokes() const noexcept {
    data_->positions.resize(data_->servos.size());
    std::ranges::transform(data_->servos, data_->positions.begin(),
                           [](const Servo& servo) { return servo.motion.position; });
    return data_->positions;
}

std::uint64_t ServoGuard::clamped() const noexcept { return data_->clamped; }
std::uint64_t ServoGuard::refused() const noexcept { return data_->refused; }

} // namespace lumorph
