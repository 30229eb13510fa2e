#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/labyrinth/level.h"

namespace lumorph::labyrinth {

/// A convex piece of a level: a quadrilateral seen from above, from a level underside up to a flat top that may slope.
/// Physics, picture and relief are all made of these, so that what one sees is what the ball rolls on.
struct Block {
    enum class Kind : std::uint8_t { floor, wall, slope, deck, rail };
    Kind kind = Kind::floor;
    std::array<glm::dvec2, 4> outline{}; ///< x and z, device metres, in one sense; from +X towards +Z
    double bottom = 0.0;                 ///< metres over the sheet
    std::array<double, 4> tops{};        ///< at the corners, in one plane
};

/// Underside of all that stands on the ground, metres over the sheet.
inline constexpr double kGround = -0.008;
inline constexpr double kHoleRadius = 0.4; ///< of the side of a cell

/// All pieces of a level that `checkLevel` accepts; cells of one height are put together.
[[nodiscard]] std::vector<Block> blocksOf(const Level& level);

/// Height of a block's top at a place over it, metres over the sheet; NaN beside it.
[[nodiscard]] double topAt(const Block& block, const glm::dvec2& place) noexcept;

} // namespace lumorph::labyrinth
