#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/ice/melting.h"
#include "app/applications/ice/polygon.h"

namespace lumorph::ice {

struct Fish {
    glm::dvec2 place{0.0};
    double heading = 0.0; ///< radians, from x to z
    double speed = 0.02;  ///< metres a second
    double depth = 0.5;   ///< share of the water, 0 at the ground
    double stroke = 0.0;  ///< of its tail, radians
    double length = 0.03; ///< metres
    double mood = 0.0;    ///< of its own: where it likes to go
};

/// Fish that swim slowly on, keep off one another and the bank, and flee from what is warm. The same seed and calls
/// give the same fish.
class School {
public:
    School(const Polygon& shore, int count, std::uint64_t seed);

    /// `openings` are places of open water, which they like to look at; the water carries them along with `current`,
    /// metres a second.
    void advance(double seconds, std::span<const Warmth> warmths, std::span<const glm::dvec2> openings = {},
                 const glm::dvec2& current = {});
    [[nodiscard]] const std::vector<Fish>& fish() const noexcept { return fish_; }

private:
    struct Wish {
        glm::dvec2 way{0.0}; ///< a sum of what draws and drives it
        double hurry = 0.0;  ///< 0 to 1
    };
    void swim(std::size_t k, double seconds, const Wish& wish);
    [[nodiscard]] Wish wishOf(std::size_t k, std::span<const Warmth> warmths,
                              std::span<const glm::dvec2> openings) const;

    Polygon shore_;
    std::vector<Fish> fish_;
    double seconds_ = 0.0, left_ = 0.0;
};

} // namespace lumorph::ice
