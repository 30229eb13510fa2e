#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace lumorph::sea {

/// Rings that run out over the water from where it was touched, by the wave equation on a grid over the tablet. A touch
/// drives the water for a moment: a short wave, which light shows, and a long one, which servos can follow.
class Ripples {
public:
    static constexpr double kSpeed = 0.12;           ///< of a ring, metres a second
    static constexpr int kColumns = 85, kRows = 61;  ///< of the grid, 2.5 mm apart
    static constexpr glm::dvec2 kHalf{0.105, 0.075}; ///< of the water, metres
    static constexpr std::size_t kMostTouches = 12;  ///< that drive the water at one moment

    Ripples();

    /// At a place of the device, metres; 1 is a finger. The oldest of too many touches ends.
    void touch(const glm::dvec2& place, double strength);
    /// Numbers that are none are no time.
    void advance(double seconds);

    /// Over the still water, metres; of the nearest place on it.
    [[nodiscard]] double heightAt(const glm::dvec2& place) const noexcept;
    /// By how much rings that pass a place push what floats there, metres a second squared.
    [[nodiscard]] glm::dvec2 pushAt(const glm::dvec2& place) const noexcept;

private:
    struct Touch {
        glm::dvec2 place{0.0};
        double strength = 1.0, age = 0.0;
    };
    void step(double seconds);
    void drive(const Touch& touch, double seconds);
    void driveWave(const Touch& touch, double radius, double change);

    std::vector<float> heights_, speeds_; ///< metres, and metres a second
    std::vector<float> calm_;             ///< damping, 1 / s; strong at the rim, so that little comes back
    std::vector<Touch> touches_;
    double left_ = 0.0; ///< seconds that are not simulated yet
};

} // namespace lumorph::sea
