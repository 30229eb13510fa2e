#pragma once

#include <glm/vec2.hpp>

namespace lumorph {

/// Water in a device that is leant. It stays level in the room, so over the device it slopes towards the low side; it
/// comes there late, swings past, and settles.
class Slosh {
public:
    static constexpr double kSwings = 0.9;   ///< a second, about
    static constexpr double kDamping = 0.16; ///< ratio; 1 is critical

    /// `share` of the true slope is shown: all of it would run over a rim as soon as a hand shakes.
    explicit Slosh(double share) noexcept : share_(share) {}

    /// `lean` as Visitor::lean, radians. Numbers that are none are no lean and no time.
    void advance(double seconds, const glm::dvec2& lean) noexcept;

    /// How the water slopes now, along x and z of the device; at most `share` * kMostSlope each way.
    [[nodiscard]] const glm::dvec2& slope() const noexcept { return slope_; }
    [[nodiscard]] const glm::dvec2& slopeSpeed() const noexcept { return speed_; } ///< 1 over seconds
    /// Over rest at a place (x, z of the device), metres.
    [[nodiscard]] double heightAt(const glm::dvec2& place) const noexcept;
    /// Whether it lies flat, as far as an eye could tell.
    [[nodiscard]] bool rests() const noexcept;

    static constexpr double kMostSlope = 0.4;

private:
    void step(double seconds, const glm::dvec2& level) noexcept;

    double share_;
    glm::dvec2 slope_{0.0}, speed_{0.0};
};

} // namespace lumorph
