#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/controllers/pulse_plan.h"
#include "devices/controllers/servo_controller.h"

namespace lumorph {

/// Tells when something that repeats is due. A clock that was set back makes it due.
class Repeater {
public:
    explicit Repeater(Microseconds interval) : interval_(interval) {}
    [[nodiscard]] bool due(Microseconds now) const noexcept {
        return !last_ || now < *last_ || now - *last_ >= interval_;
    }
    void done(Microseconds now) noexcept { last_ = now; }
    /// Due at once.
    void reset() noexcept { last_.reset(); }
    bool take(Microseconds now) noexcept {
        if (!due(now)) return false;
        done(now);
        return true;
    }

private:
    Microseconds interval_;
    std::optional<Microseconds> last_;
};

/// What all controllers have in common: the plan of pulses, messages in the order of their urgency, silence, troubles
/// and the battery.
class ControllerBase : public ServoController {
public:
    /// A controller that has said nothing for so long is taken for silent. Time in which this program did not run does
    /// not count: what the board said then was not read.
    static constexpr Microseconds kSilence{1'000'000};
    static constexpr double kLowBattery = 6.0; ///< volts; a pack of two lithium cells is empty there

    void opened(const std::string& product, Microseconds now) final;
    void received(std::span<const std::uint8_t> bytes, Microseconds now) final;
    void tick(Microseconds now) final;
    void setLimits(const DeviceProfile& profile) final;
    void confirm() final;
    void send(const GuardedPulses& pulses, Microseconds now) final { command(pulses.servos(), now); }
    void detachAgain() final { plan_.detachAgain(); }
    [[nodiscard]] ServoRelease release() const final { return {releases(), plan_.detachGap()}; }
    [[nodiscard]] std::vector<std::vector<std::uint8_t>> takeOutput() final;
    [[nodiscard]] const ControllerState& state() const final { return state_; }

protected:
    using Messages = std::vector<std::vector<std::uint8_t>>;
    enum class Concern { refusal, silence, board, battery }; ///< the first that there is, is told

    /// Step and rate of the scale are those of profile and traits.
    ControllerBase(const DeviceProfile& profile, const PulseScale& scale, ControllerTraits traits);

    virtual void begin(Microseconds now) = 0;
    virtual void take(std::span<const std::uint8_t> bytes, Microseconds now) = 0;
    virtual void work(Microseconds now) = 0;
    [[nodiscard]] virtual Messages detachments(std::span<const std::size_t> servos) = 0;
    /// The same for all servos, without any knowledge of what was said.
    [[nodiscard]] virtual Messages releases() const = 0;
    [[nodiscard]] virtual Messages changes(std::span<const PulsePlan::Change> changes) = 0;
    /// The plan has taken other limits over.
    virtual void limitsChanged(const DeviceProfile&) {}
    /// Why it may be silent: it never answered since the link was opened, or has fallen silent.
    [[nodiscard]] virtual LinkTrouble silence(bool never) const = 0;

    /// Dropped where dozens wait already: nobody takes them.
    void ask(std::vector<std::uint8_t> message);
    /// A sound answer came.
    void noteAnswer(Microseconds now);
    [[nodiscard]] bool everHeard() const noexcept { return everHeard_; }
    /// This program has just been stuck for so long that a board with a watchdog let go of its servos.
    [[nodiscard]] bool wasStuckLately() const noexcept { return stuckAt_ && now_ - *stuckAt_ < kSilence; }
    void becomeReady();
    void refuse(LinkTrouble why);
    /// It started anew, or let go of its servos by itself.
    void rebooted();
    void trouble(Concern concern, std::optional<LinkTrouble> trouble);
    /// False where it is in doubt, and should be asked for again.
    bool takeVoltage(double volts);
    /// The board says, when asked at this time, that an attached servo has this value (steps), `same` as told or not:
    /// what noise has spoiled is put right, and what the board will not have becomes a trouble, true then.
    bool takeValue(std::size_t servo, long value, bool same, Microseconds asked, const char* remedy);
    /// What it was told last.
    [[nodiscard]] Microseconds now() const noexcept { return now_; }
    /// When something was last written.
    [[nodiscard]] Microseconds lastWritten() const noexcept { return lastWritten_; }
    [[nodiscard]] std::optional<std::size_t> servoOn(int channel) const;

    ControllerState state_;
    PulsePlan plan_;
    std::string product_;

private:
    void command(std::span<const GuardedPulse> pulses, Microseconds now);
    void passTo(Microseconds now);

    Messages questions_;
    std::array<std::optional<LinkTrouble>, 4> troubles_;
    Microseconds now_{0};
    Microseconds heard_{0};
    Microseconds lastWritten_{0};
    bool everHeard_ = false;
    std::optional<Microseconds> stuckAt_; ///< when it went on
    std::optional<double> heardVolts_;    ///< last, true or not
};

/// Baud rate of a link as far as its address tells it: 9600 over Bluetooth (HC-06), 57600 where nobody says.
[[nodiscard]] int baudOf(const DeviceAddress& address);
/// Sets of so many bytes that a serial link takes a second, half of it left for everything else.
[[nodiscard]] double setsPerSecond(int baud, std::size_t bytes);
/// Pause between two times that servos are told to let go in so many bytes: a line should be free to carry the answers.
[[nodiscard]] Microseconds detachGap(int baud, std::size_t bytes);
/// Sets a second that the profile wants and the link takes.
[[nodiscard]] double setsPerSecond(const DeviceProfile& profile, const ControllerTraits& traits);
/// Throws InvalidInput with these words for a HID address.
void refuseHid(const DeviceProfile& profile, const DeviceAddress& address, const char* why, const char* remedy);
/// Throws InvalidInput that names the first servo whose channel is not 0 to `last`.
void checkChannels(const DeviceProfile& profile, int last);

// What the table of controller_kinds.cpp makes controllers with; channels were checked before.
[[nodiscard]] std::unique_ptr<ServoController> makeFirmata(const DeviceProfile& profile, const DeviceAddress& address);
[[nodiscard]] std::unique_ptr<ServoController> makeLewansoul(const DeviceProfile& profile,
                                                             const DeviceAddress& address);
[[nodiscard]] std::unique_ptr<ServoController> makeMaestro(const DeviceProfile& profile, const DeviceAddress& address);

} // namespace lumorph
