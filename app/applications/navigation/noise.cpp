#include "app/applications/navigation/noise.h"

#include <cmath>

#include <glm/common.hpp>

namespace lumorph::navigation {

double chanceOf(glm::ivec2 cell, std::uint64_t seed) noexcept {
    std::uint64_t h = seed * 0x9E3779B97F4A7C15ULL +
                      (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.x)) << 32U) +
                      static_cast<std::uint32_t>(cell.y);
    h = (h ^ (h >> 30U)) * 0xBF58476D1CE4E5B9ULL; // splitmix64
    h = (h ^ (h >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<double>((h ^ (h >> 31U)) >> 11U) * 0x1p-53;
}

double noiseAt(const glm::dvec2& place, std::uint64_t seed) noexcept {
    const glm::dvec2 corner = glm::floor(place);
    const glm::ivec2 cell(corner);
    const glm::dvec2 t = place - corner;
    const glm::dvec2 s = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    const double a = chanceOf(cell, seed), b = chanceOf(cell + glm::ivec2(1, 0), seed);
    const double c = chanceOf(cell + glm::ivec2(0, 1), seed), d = chanceOf(cell + glm::ivec2(1, 1), seed);
    return 2.0 * std::lerp(std::lerp(a, b, s.x), std::lerp(c, d, s.x), s.y) - 1.0;
}

double fractalAt(const glm::dvec2& place, int octaves, std::uint64_t seed) noexcept {
    double sum = 0.0, share = 0.5;
    glm::dvec2 at = place;
    for (int k = 0; k < octaves; ++k, share *= 0.5) {
        sum += share * noiseAt(at, seed + static_cast<std::uint64_t>(k));
        at = 2.0 * at + glm::dvec2(17.3, -9.1); // so that no lattice lies on another
    }
    return sum;
}

} // namespace lumorph::navigation
