#pragma once

#include <chrono>

namespace lumorph {

using Microseconds = std::chrono::microseconds;

/// A source of monotonic time. Everything that waits, limits or times takes one, so that tests can
/// turn it by hand.
class Clock {
public:
    virtual ~Clock() = default;
    [[nodiscard]] virtual Microseconds now() const = 0;
};

/// The machine's steady clock.
class SteadyClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override {
        return std::chrono::duration_cast<Microseconds>(std::chrono::steady_clock::now().time_since_epoch());
    }
};

/// A clock that moves only when told to.
class ManualClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override { return now_; }
    void advance(Microseconds step) { now_ += step; }

private:
    Microseconds now_{0};
};

} // namespace lumorph
