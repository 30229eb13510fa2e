#pragma once

#include <memory>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "app/applications/labyrinth/level_blocks.h"

namespace lumorph::labyrinth {

/// Where the ball is and how it moves; device frame with height 0 at the sheet, metres and seconds.
struct Ball {
    glm::dvec3 position{0.0};
    glm::dvec3 velocity{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
};

/// A ball in a level as rigid bodies (Bullet): all blocks stand still, walls reach up to a lid, and the ball is swept
/// against what it could pass in one step. One thread, no chance: the same calls give the same numbers, bit for bit.
class BallWorld {
public:
    static constexpr double kStep = 1.0 / 240.0; ///< seconds

    BallWorld(const Level& level, const std::vector<Block>& blocks);
    ~BallWorld();
    BallWorld(BallWorld&&) noexcept;
    BallWorld& operator=(BallWorld&&) noexcept;

    /// Lets the ball lie still with its middle at `position`, as if nothing had been before.
    void place(const glm::dvec3& position);
    /// One step under this gravity, metres a second squared.
    void step(const glm::dvec3& gravity);

    [[nodiscard]] const Ball& ball() const noexcept;
    /// Whether something carried the ball in the last step.
    [[nodiscard]] bool onGround() const noexcept;
    /// By how much the hardest meeting with a side (of a wall, a step) turned the ball in the last step, metres a
    /// second.
    [[nodiscard]] double bump() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::labyrinth
