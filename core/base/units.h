#pragma once

#include <compare>
#include <numbers>
#include <vector>

namespace lumorph {

/// An angle; radians inside, degrees only at the edges.
class Angle {
public:
    constexpr Angle() = default;
    [[nodiscard]] static constexpr Angle radians(double value) { return Angle(value); }
    [[nodiscard]] static constexpr Angle degrees(double value) { return Angle(value * std::numbers::pi / 180.0); }
    [[nodiscard]] constexpr double inRadians() const { return radians_; }
    [[nodiscard]] constexpr double inDegrees() const { return radians_ * 180.0 / std::numbers::pi; }
    constexpr auto operator<=>(const Angle&) const = default;

private:
    constexpr explicit Angle(double value) : radians_(value) {}
    double radians_ = 0.0;
};

/// An actuation level (paper: state s_i in Z_m): 0 is rest, `levels - 1` is the full stroke.
struct Level {
    int index = 0;
    constexpr auto operator<=>(const Level&) const = default;
};

/// A joint state of the device: one level for each actuator, in the rig's order.
using State = std::vector<Level>;

/// At most this many levels an actuator may have (a level fits a byte, and 255 means "never").
inline constexpr int kMaxLevels = 200;

/// The share of its stroke, in [0, 1], that an actuator has at a level of `levels`.
[[nodiscard]] constexpr double strokeOf(Level level, int levels) {
    return static_cast<double>(level.index) / (levels - 1);
}

} // namespace lumorph
