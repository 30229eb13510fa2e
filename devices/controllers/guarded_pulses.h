#pragma once

#include <span>
#include <utility>
#include <vector>

namespace lumorph {

/// What one servo shall do.
struct GuardedPulse {
    int channel = 0;           ///< of the controller
    double microseconds = 0.0; ///< width of its pulse
    bool attached = false;     ///< false: no pulse at all, the servo is limp
    bool operator==(const GuardedPulse&) const = default;
};

/// The right to make servos move: the engine makes its guard with one, and the guard its commands; nothing else of the
/// programs can make one. Test programs alone define `testGuardKey`.
class GuardKey {
    GuardKey() = default;
    friend class ServoEngine;
    friend class ServoGuard;
    friend GuardKey testGuardKey();
};

/// One command to all servos of a device. Only the ServoGuard makes one: whatever holds it may trust that it breaks no
/// limit.
class GuardedPulses {
public:
    GuardedPulses(GuardKey /*key*/, std::vector<GuardedPulse> servos) : servos_(std::move(servos)) {}
    [[nodiscard]] std::span<const GuardedPulse> servos() const noexcept { return servos_; }

private:
    std::vector<GuardedPulse> servos_;
};

} // namespace lumorph
