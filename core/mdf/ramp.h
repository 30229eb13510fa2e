#pragma once

#include <cstdint>
#include <span>

namespace lumorph {

/// V0 of a voxel that the actuator does not change.
inline constexpr std::uint8_t kUnchanged = 255;

/// What one voxel holds of one actuator (R11): its expected coverage rises from `base` to `top`, both
/// in 1/255, linearly between the levels v0 (first that differs from base) and v1 (first at top).
/// The paper's ramp from 0 to 1 is base 0, top 255.
struct Ramp {
    std::uint8_t v0 = kUnchanged;
    std::uint8_t v1 = kUnchanged;
    std::uint8_t base = 0;
    std::uint8_t top = 0;

    bool operator==(const Ramp&) const = default;
};

/// Share of the rise, in [0, 1], at a level: 0 below v0, 1 from v1 on, (j - v0 + 1) / (v1 - v0 + 1) between.
[[nodiscard]] constexpr double rampAt(const Ramp& ramp, int level) noexcept {
    if (level < ramp.v0) return 0.0;
    if (level >= ramp.v1) return 1.0;
    return static_cast<double>(level - ramp.v0 + 1) / (ramp.v1 - ramp.v0 + 1);
}

/// Expected coverage in [0, 1] at a level.
[[nodiscard]] constexpr double expectationAt(const Ramp& ramp, int level) noexcept {
    return (ramp.base + (ramp.top - ramp.base) * rampAt(ramp, level)) / 255.0;
}

/// The ramp closest to a sampled, non-decreasing expectation (one value a level, each in [0, 1]) in
/// the least-squares sense; base and top are the rounded ends. v0 is 255 when the rounded ends are equal.
/// Cost: linear for a single step, else levels squared.
[[nodiscard]] Ramp fitRamp(std::span<const double> expectation) noexcept;

} // namespace lumorph
