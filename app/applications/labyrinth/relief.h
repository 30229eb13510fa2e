#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/labyrinth/level_blocks.h"
#include "core/voxels/height_grid.h"

namespace lumorph::labyrinth {

/// What servos are to lift of a level: the tops of its blocks, holes as hollows, and the ball as a bump about as wide
/// as a part of the tablet that a servo lifts, so that it is felt through it. Samples stand 2 mm apart.
class Relief {
public:
    static constexpr double kBumpHeight = 0.014; ///< metres
    static constexpr double kBumpWidth = 0.026;  ///< standard deviation of its bell, metres

    Relief(const Level& level, const std::vector<Block>& blocks);

    /// Of the level alone, leant as by `boardTurn`; device metres.
    [[nodiscard]] HeightGrid level(const glm::dvec2& lean = glm::dvec2(0.0)) const;
    /// With the ball at this place.
    [[nodiscard]] HeightGrid withBall(const glm::dvec2& place, const glm::dvec2& lean = glm::dvec2(0.0)) const;

private:
    HeightGrid level_;
};

} // namespace lumorph::labyrinth
