#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

/// Chance that is the same wherever it is asked for.
namespace lumorph::navigation {

/// A number in [0, 1) of a cell; another one for another seed.
[[nodiscard]] double chanceOf(glm::ivec2 cell, std::uint64_t seed) noexcept;

/// Smooth noise in [-1, 1] whose hills are about one unit wide.
[[nodiscard]] double noiseAt(const glm::dvec2& place, std::uint64_t seed) noexcept;

/// Octaves of it, each half as wide and half as high as the one before; about in [-1, 1].
[[nodiscard]] double fractalAt(const glm::dvec2& place, int octaves, std::uint64_t seed) noexcept;

} // namespace lumorph::navigation
