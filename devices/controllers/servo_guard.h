#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/clock.h"
#include "devices/controllers/device_profile.h"
#include "devices/controllers/guarded_pulses.h"

namespace lumorph {

/// The one choke point of all servo commands, whoever sends them (live loop, wiggle, rest, replay, command line).
/// Clamps range, velocity and acceleration, refuses what is not finite, starts servos softly one after the other, and
/// latches STOP. Pure: no I/O, no threads, and time only as it is told. Its promise, at every step, whatever is asked
/// and however the time jumps (backwards too): each pulse lies in [pulseMin, pulseMax]; between two steps it moves at
/// most maxVelocity x the time passed, of which no more than kLongestStep counts; its velocity changes by at most
/// maxAcceleration x that time, except that a servo may be detached at once.
class ServoGuard {
public:
    /// Time that a step may count, however long ago the last was.
    static constexpr Microseconds kLongestStep{50'000};

    enum class Phase {
        disarmed, ///< no pulses
        starting, ///< servos are attached one by one, each from where it is
        live,     ///< all follow
        stopped   ///< STOP: no pulses, until it is armed again
    };

    /// Throws as checkProfile.
    ServoGuard(GuardKey key, const DeviceProfile& profile);
    ~ServoGuard();
    ServoGuard(ServoGuard&&) noexcept;
    ServoGuard& operator=(ServoGuard&&) noexcept;

    /// Other limits or channels; servos whose channel or direction changed are detached and must be armed again, all of
    /// them where their number changed. A servo that moves brakes to a stop by the limits it had before it takes the
    /// new ones over. Where its limits were drawn in past it, it comes back within them as slowly as it moves
    /// otherwise, and goes no farther out meanwhile. To where other pulses put the wanted stroke an attached servo goes
    /// at a quarter of a stroke a second at most: a number that is edited shall not make it leap. Throws as
    /// checkProfile; then all stays as it was.
    void setProfile(const DeviceProfile& profile);

    /// A servo's position was read, or is remembered from before, strokes; nothing: it is not known any more (after a
    /// reboot, or when it was moved by hand). Not finite, or clearly outside its limits: as nothing. Of an attached
    /// servo only "not known" counts, and detaches it.
    void setKnown(std::size_t servo, std::optional<double> stroke);
    [[nodiscard]] std::optional<double> known(std::size_t servo) const;

    /// Begins the soft start, also out of `stopped`: each is attached where it is and goes from there to what is wanted
    /// of it at a quarter of a stroke a second at most. A servo whose position is unknown is attached at the stroke
    /// that is wanted of it only where the user was asked (`jumpAllowed`); else it stays detached and is told by
    /// `waiting`.
    void arm(bool jumpAllowed);
    /// Servos that stay detached because nobody knows where they are.
    [[nodiscard]] std::vector<std::size_t> waiting() const;
    /// Orderly end: no pulses, not latched.
    void disarm();
    /// Latched: all servos are detached with the next step.
    void stop();

    /// What is wanted of all servos, strokes; latest wins. Until the first, servos stay where they are (unknown ones
    /// start at rest). Values beyond [0, 1] are clamped. False, and nothing
    /// changes, where one is not finite or the count is wrong.
    bool want(std::span<const double> strokes);
    /// What is wanted of one servo, stroke; where it stays, while nothing is.
    [[nodiscard]] double wanted(std::size_t servo) const noexcept;
    /// Of one servo alone, around where it is: for "wiggle this one". Ends by itself; refused (false) unless live.
    bool wiggle(std::size_t servo);
    /// Everything slower by the profile's share, as long as it is on.
    void setSlow(bool slow);

    [[nodiscard]] GuardedPulses step(Microseconds now);
    [[nodiscard]] Phase phase() const noexcept;
    /// All attached servos are where they are wanted, and stand still.
    [[nodiscard]] bool settled() const noexcept;
    /// Every servo has taken its newest limits over and is within them.
    [[nodiscard]] bool withinLimits() const noexcept;
    /// Where the servos are, by what was sent, strokes.
    [[nodiscard]] std::span<const double> strokes() const noexcept;
    /// How often something was clamped or refused since it was made, for the live table.
    [[nodiscard]] std::uint64_t clamped() const noexcept;
    [[nodiscard]] std::uint64_t refused() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
