#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph::navigation {

/// The way that water takes over a grid of heights to its outlets.
struct Drainage {
    std::vector<std::uint32_t> order;    ///< all samples, each after the one that it drains into
    std::vector<std::uint32_t> receiver; ///< into which each drains; an outlet into itself
};

/// Raises hollows until every sample that is no outlet has a lower neighbour (of eight), and so every way down ends in
/// an outlet. `outlets` has one entry a sample; some must be set. `least` is the smallest step down, metres.
[[nodiscard]] Drainage drain(glm::ivec2 samples, std::span<float> heights, std::span<const std::uint8_t> outlets,
                             float least);

/// Rivers wear the land down while it is lifted: after some rounds slopes are those with which each stream just carries
/// off what comes up (stream power law, implicit in Braun and Willett's way). `uplift` is one a sample, metres a
/// round; outlets stay as they are.
void erode(glm::ivec2 samples, std::span<float> heights, std::span<const std::uint8_t> outlets,
           std::span<const float> uplift, int rounds);

} // namespace lumorph::navigation
