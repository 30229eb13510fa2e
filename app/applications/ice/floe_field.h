#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/ice/ice_cover.h"

namespace lumorph::ice {

/// A floe from above, in samples of home coordinates on one grid for the whole pond: sample (i, j) lies at
/// `kStep * (i, j)`. Cells are straight; what is seen of them is smoothed, so that corners are round.
struct FloeField {
    static constexpr double kStep = 0.001; ///< metres

    glm::ivec2 min{0};            ///< grid place of the first sample
    glm::ivec2 size{0};           ///< samples in x and z
    std::vector<float> shape;     ///< share of ice nearby; the rim is where it is 0.5
    std::vector<float> inland;    ///< likewise over some millimetres: 0.5 at a straight rim, 1 about 8 mm inside
    std::vector<float> thickness; ///< share of the sheet's
    std::vector<float> lower;     ///< metres by which young ice lies lower

    [[nodiscard]] std::size_t at(int i, int j) const noexcept {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(i);
    }
    [[nodiscard]] glm::dvec2 place(int i, int j) const noexcept { return kStep * glm::dvec2(min + glm::ivec2(i, j)); }
    /// One of its lists between samples; 0 outside.
    [[nodiscard]] float between(const std::vector<float>& values, const glm::dvec2& home) const noexcept;
    /// How a list grows along x and z, per metre.
    [[nodiscard]] glm::dvec2 slope(const std::vector<float>& values, const glm::dvec2& home) const noexcept;
    bool operator==(const FloeField&) const = default;
};

[[nodiscard]] FloeField fieldOf(const IceCover& ice, const Floe& floe);

} // namespace lumorph::ice
