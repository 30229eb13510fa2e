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
    double perSecond = 50.0; ///< sets of values that may go out
};

/// Which servos must be told something new, and when the link has room for it. The latest wish wins and one only is
/// kept; a wish to detach waits for nothing and is told three times, since no board acknowledges it.
class PulsePlan {
public:
    static constexpr int kDetachments = 3;
    static constexpr Microseconds kDetachGap{100'000};

    struct Change {
        std::size_t servo = 0;
        long value = 0;      ///< in steps
        bool attach = false; ///< it has been limp
    };

    /// Throws InvalidInput that names a servo between whose limits lies no value.
    PulsePlan(std::vector<ServoSetup> servos, const PulseScale& scale);

    /// Other limits of the same servos, and another rate; what was told stays told. Throws as the constructor.
    void setServos(std::vector<ServoSetup> servos, double perSecond);

    /// Nobody knows any more what the board does (it was opened, it started anew). A servo that was attached stays as
    /// it is until it was let go: what stood in the way of a hand does not come back by itself.
    void restart();
    /// Pulses of channels that no servo has are ignored, and so are all but detachments unless `ready`.
    void want(std::span<const GuardedPulse> pulses, Microseconds now, bool ready);
    void tick(Microseconds now);
    /// A servo is limp for sure: it need not be told again.
    void knownLimp(std::size_t servo);
    /// It must be told again, once.
    void detachAgain(std::size_t servo);
    /// All limp ones must be told again, now.
    void detachAgain();

    /// Servos to detach now, before anything else.
    [[nodiscard]] std::vector<std::size_t> takeDetachments();
    /// Empty unless there is room for it.
    [[nodiscard]] std::vector<Change> takeChanges();

    [[nodiscard]] bool attached(std::size_t servo) const { return states_[servo].told == Told::attached; }
    /// It was told to be limp.
    [[nodiscard]] bool limp(std::size_t servo) const { return states_[servo].told == Told::limp; }
    /// When it was last attached or detached.
    [[nodiscard]] Microseconds since(std::size_t servo) const { return states_[servo].since; }
    [[nodiscard]] bool anyAttached() const;
    [[nodiscard]] const std::vector<ServoSetup>& servos() const noexcept { return servos_; }
    /// The nearest value that lies within the servo's limits, steps.
    [[nodiscard]] long valueOf(std::size_t servo, double microseconds) const;

private:
    enum class Told { nothing, limp, attached };
    struct State {
        bool attach = false; ///< what is wanted
        long value = 0;
        Told told = Told::nothing;
        long toldValue = 0;
        bool held = false; ///< until it was let go
        int detachments = 0;
        Microseconds nextDetachment{0};
        Microseconds since{0};
    };
    void wantOne(std::size_t servo, const GuardedPulse& pulse, bool ready);

    void setRate(double perSecond);

    std::vector<ServoSetup> servos_;
    PulseScale scale_;
    Microseconds period_{20'000};
    std::vector<State> states_;
    Microseconds now_{0};
    Microseconds nextSlot_{0};
    bool pending_ = false; ///< a wish waits for its slot
    bool due_ = false;     ///< and has it
};

} // namespace lumorph
