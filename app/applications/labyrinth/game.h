#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/labyrinth/ball_world.h"
#include "app/applications/labyrinth/ghost.h"
#include "app/applications/labyrinth/level.h"
#include "app/applications/visitor.h"

namespace lumorph::labyrinth {

/// Something that happened, for whoever makes it heard or seen.
struct GameEvent {
    enum class Kind : std::uint8_t { roll, bump, pickUp, fall, goal };
    Kind kind = Kind::roll;
    double strength = 0.0; ///< of roll and bump: metres a second; of a pick-up: how many there are now
    glm::dvec3 place{0.0}; ///< device frame, height 0 at the sheet
    bool operator==(const GameEvent&) const = default;
};

/// One ball in one level, from the start to the goal: physics in even steps, time, score, pick-ups, falls. A function
/// of level, seed and what is asked of it, bit for bit.
class Game {
public:
    static constexpr double kMostLean = Visitor::kMostLean; ///< steeper than any ramp
    /// As on a board two and a half times as large, so that a hand can follow. Metres a second squared.
    static constexpr double kGravity = 4.0;

    Game(Level level, std::uint64_t seed);

    /// Goes on for `seconds` (of more than a quarter the rest is left out, after a stop of the show) under a lean in
    /// radians: positive x lets the ball roll to +X, positive y to +Z. What happened meanwhile is in `events`.
    void advance(double seconds, const glm::dvec2& lean);
    /// The same for one step, without the time that is left over.
    void step(const glm::dvec2& lean);

    [[nodiscard]] const Level& level() const noexcept { return level_; }
    [[nodiscard]] const std::vector<Block>& blocks() const noexcept { return blocks_; }
    [[nodiscard]] const Ball& ball() const noexcept { return world_.ball(); }
    [[nodiscard]] const std::vector<GameEvent>& events() const noexcept { return events_; } ///< of the last `advance`
    [[nodiscard]] glm::dvec2 lean() const noexcept { return lean_; }                        ///< that works on the ball
    [[nodiscard]] double seconds() const noexcept; ///< since the start; stands still at the goal
    [[nodiscard]] bool fallen() const noexcept { return fallenSteps_ > 0; } ///< the ball is gone for a moment
    [[nodiscard]] bool done() const noexcept { return done_; }
    [[nodiscard]] int falls() const noexcept { return falls_; }
    [[nodiscard]] const std::vector<glm::ivec2>& pickUps() const noexcept { return pickUps_; } ///< not yet taken
    [[nodiscard]] const std::vector<PickUp>& taken() const noexcept { return taken_; }         ///< in order
    /// 100 a pick-up, 10 a second saved, 50 lost a fall; never below 0.
    [[nodiscard]] int score() const noexcept;
    [[nodiscard]] const Ghost& run() const noexcept { return run_; } ///< so far; whole once `done`

private:
    void follow();
    void fall();
    void happened(GameEvent::Kind kind, double strength);
    [[nodiscard]] glm::dvec3 restingOn(glm::ivec2 cell) const;
    [[nodiscard]] bool isSafe(glm::ivec2 cell) const;

    Level level_;
    std::vector<Block> blocks_;
    BallWorld world_;
    std::vector<glm::ivec2> pickUps_;
    std::vector<PickUp> taken_;
    std::vector<GameEvent> events_;
    glm::dvec2 lean_{0.0};
    glm::dvec3 safe_{0.0}; ///< where the ball goes on after a fall
    double left_ = 0.0;    ///< seconds that made no whole step yet
    std::int64_t steps_ = 0;
    int fallenSteps_ = 0; ///< until the ball comes back
    int quietSteps_ = 0;  ///< until a bump is told again
    int falls_ = 0;
    bool done_ = false;
    Ghost run_;
};

} // namespace lumorph::labyrinth
