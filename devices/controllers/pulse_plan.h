#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/device_profile.h"
#include "devices/controllers/guarded_pulses.h"

namespace lumorph {

/// What a controller can tell its servos.
struct PulseScale {
    double step = 1.0;   ///< microseconds between two values
    double zero = 0.0;   ///< microseconds that the value 0 stands for
    double least = 64.0; ///< microseconds; least and greatest that it can be told, whatever a profile says
    double greatest = 4000.0;
    double perSecond = 50.0;        ///< sets of values that may go out
    Microseconds detachGap{25'000}; ///< between two times that servos are told to let go, in the first second
};

/// Which servos must be told something new, and when the link has room for it. The latest wish wins and one only is
/// kept. A wish to detach waits for nothing, and since a line loses bytes and no board acknowledges it, it is repeated
/// until the board is known to have obeyed: quickly for a second, then, where the board is known for what it is, once a
/// second.
class PulsePlan {
public:
    static constexpr Microseconds kDetachQuickly{1'000'000};
    static constexpr Microseconds kDetachSlowly{1'000'000}; ///< between two times after that
    static constexpr int kConfirmations = 2;                ///< in a row: a line that loses bytes also makes some up
    static constexpr int kRepeats = 3;                      ///< of a value that a board does not take

    struct Change {
        std::size_t servo = 0;
        long value = 0;      ///< in steps
        bool attach = false; ///< it has been limp
    };

    /// Throws InvalidInput that names a servo between whose limits lies no value.
    PulsePlan(std::vector<ServoSetup> servos, const PulseScale& scale);

    /// Other limits of the same servos, and another rate; what was told stays told. A servo between whose limits lies
    /// no value stays as it is.
    void setServos(std::vector<ServoSetup> servos, double perSecond);

    /// Nobody knows any more what the board does (it was opened, it started anew). A servo that was attached stays as
    /// it is until it was let go: what stood in the way of a hand does not come back by itself.
    void restart();
    /// Pulses of channels that no servo has are ignored, and so are all but detachments unless `ready`.
    void want(std::span<const GuardedPulse> pulses, Microseconds now, bool ready);
    void tick(Microseconds now);
    /// From now on the board is known to take no shorter pulses, microseconds.
    void setLeast(double microseconds) { scale_.least = microseconds; }
    /// The board says of a servo that was told to be limp, that it is.
    void confirmLimp(std::size_t servo);
    /// It says the contrary.
    void detachAgain(std::size_t servo);
    /// All limp ones must be told again, now.
    void detachAgain();
    /// What follows from the value that a board has.
    enum class Verdict {
        nothing,
        mended, ///< the line had spoiled it, and it was put right
        refused ///< the board keeps to another value, however often it is told
    };
    /// The board says, when asked at this time, whether one that is attached has the value that it was told. If not it
    /// is told again, a few times.
    Verdict hears(std::size_t servo, bool same, Microseconds asked);
    /// The pulse of so many steps.
    [[nodiscard]] double microseconds(long steps) const {
        return scale_.zero + scale_.step * static_cast<double>(steps);
    }
    /// What one that is attached was told last, steps.
    [[nodiscard]] long told(std::size_t servo) const { return states_[servo].toldValue; }
    /// It was told to be limp, and nobody knows whether it is.
    [[nodiscard]] bool doubtful(std::size_t servo) const;
    /// Some servo is being told to let go again and again.
    [[nodiscard]] bool detaching() const;

    /// Pause between two times that servos are told to let go.
    [[nodiscard]] Microseconds detachGap() const noexcept { return scale_.detachGap; }
    /// Servos to detach now, before anything else.
    [[nodiscard]] std::vector<std::size_t> takeDetachments();
    /// Empty unless there is room for it.
    [[nodiscard]] std::vector<Change> takeChanges();

    [[nodiscard]] bool attached(std::size_t servo) const { return states_[servo].told == Told::attached; }
    /// When it was last attached or detached.
    [[nodiscard]] Microseconds since(std::size_t servo) const { return states_[servo].since; }
    [[nodiscard]] bool anyAttached() const;
    [[nodiscard]] const std::vector<ServoSetup>& servos() const noexcept { return servos_; }
    /// Some value lies within the servo's limits.
    [[nodiscard]] bool hasValue(std::size_t servo) const;
    /// The nearest value that does, steps. There must be one.
    [[nodiscard]] long valueOf(std::size_t servo, double microseconds) const;

private:
    enum class Told { nothing, limp, attached };
    struct State {
        bool attach = false; ///< what is wanted
        long value = 0;
        Told told = Told::nothing;
        long toldValue = 0;
        Microseconds toldAt{0};
        bool again = false; ///< the same value
        int repeats = 0;    ///< of it
        bool held = false;  ///< until it was let go
        bool detachFirst = false;
        Microseconds detachedAt{0}; ///< last told so
        Microseconds quickUntil{0};
        int confirmations = 0;
        Microseconds since{0};
    };
    [[nodiscard]] bool isQuick(const State& state) const;
    [[nodiscard]] bool detachmentDue(const State& state) const;
    void wantOne(std::size_t servo, const GuardedPulse& pulse, bool ready);

    void setRate(double perSecond);

    std::vector<ServoSetup> servos_;
    PulseScale scale_;
    Microseconds period_{20'000};
    std::vector<State> states_;
    Microseconds now_{0};
    Microseconds nextSlot_{0};
    bool ready_ = false;   ///< the board is known for what it is
    bool pending_ = false; ///< a wish waits for its slot
    bool due_ = false;     ///< and has it
};

} // namespace lumorph
