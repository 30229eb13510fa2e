#pragma once

#include <cmath>
#include <concepts>

#include <glm/vec3.hpp>

namespace lumorph {

/// Linear light of an sRGB value in [0, 1] (IEC 61966-2-1).
template <std::floating_point T> [[nodiscard]] T linearFromSrgb(T value) noexcept {
    return value <= T(0.04045) ? value / T(12.92) : std::pow((value + T(0.055)) / T(1.055), T(2.4));
}

[[nodiscard]] inline glm::vec3 linearFromSrgb(const glm::vec3& color) noexcept {
    return {linearFromSrgb(color.r), linearFromSrgb(color.g), linearFromSrgb(color.b)};
}

} // namespace lumorph
