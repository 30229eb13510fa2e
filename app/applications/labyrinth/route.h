#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/applications/labyrinth/ball_world.h"
#include "app/applications/labyrinth/level.h"

namespace lumorph::labyrinth {

/// A place in a level where a ball can be: a cell, or the deck of its bridge.
struct Spot {
    glm::ivec2 cell{0};
    bool deck = false;
    bool operator==(const Spot&) const = default;
};

/// Ways over the cells of a level to one of them, from everywhere: level or uphill over ramps, down over ledges and
/// stairs, along and under bridges, never over holes and beside them only where there is no other way. A run ends at
/// the level's goal, so a way to another cell does not lead over it.
class Routes {
public:
    Routes(const Level& level, glm::ivec2 target);

    /// The next spot on the best way to the target; none: there is no way, or this is the target.
    [[nodiscard]] std::optional<Spot> next(const Spot& from) const;
    /// What the way costs, about its number of cells; infinite where there is none.
    [[nodiscard]] double cost(const Spot& from) const;

private:
    friend class RouteSearch;
    int columns_ = 0;
    std::vector<double> costs_; ///< two a cell, ground and deck
    std::vector<int> next_;     ///< index of the spot after, or -1
};

/// Where the ball is in a level; none: in a wall's or hole's cell.
[[nodiscard]] std::optional<Spot> spotOf(const Level& level, const glm::dvec3& ball);

/// Rolls the ball of one level to its goal, and to pick-ups on the way where that leaves a way to the goal: what shows
/// visitors how it goes, and proves that a level can be solved.
class Pilot {
public:
    /// With `collect` pick-ups are fetched, else the goal is all.
    Pilot(const Level& level, bool collect);

    /// The lean that rolls the ball on, radians; `pickUps` are those left.
    [[nodiscard]] glm::dvec2 lean(const Ball& ball, const std::vector<glm::ivec2>& pickUps);

private:
    const Routes& target(const Spot& spot, const std::vector<glm::ivec2>& pickUps);
    [[nodiscard]] bool isStraight(const Routes& routes, const Spot& from, const Spot& to) const;

    const Level level_;
    const bool collect_;
    Routes goal_;
    std::optional<glm::ivec2> fetched_;
    std::optional<Routes> toFetched_;
    Spot last_;
};

} // namespace lumorph::labyrinth
