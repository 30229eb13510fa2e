#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

/// Servos that have mass: while a pulse is there the horn goes towards it at a finite speed; without one it stays.
class ServoBank {
public:
    /// `speed` of the horns, in microseconds of pulse a second.
    ServoBank(std::size_t count, double speed);

    void advance(Microseconds now);
    /// From now on the servo gets this pulse; 0: none. There is no such servo: nothing.
    void setPulse(std::size_t servo, double microseconds);
    void allLimp();
    /// Somebody holds the horn of this one, and of no other; nothing: of none.
    void hold(std::optional<std::size_t> servo) noexcept { held_ = servo; }

    [[nodiscard]] std::size_t size() const noexcept { return servos_.size(); }
    [[nodiscard]] std::size_t moving() const noexcept;
    [[nodiscard]] const std::vector<SimulatedServo>& servos() const noexcept { return servos_; }

private:
    /// The newest command, and the one before it that it is measured against.
    struct Commands {
        Microseconds newest{0};
        bool isFirst = true; ///< since the servo was attached: there is none before it
        Microseconds before{0};
        double pulseBefore = 0.0;
    };

    void measure(SimulatedServo& servo, Commands& commands, double pulse) const;

    double speed_;
    std::optional<std::size_t> held_;
    Microseconds now_{0};
    std::vector<SimulatedServo> servos_;
    std::vector<Commands> commands_;
};

} // namespace lumorph
