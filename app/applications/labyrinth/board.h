#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "app/applications/labyrinth/game.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::labyrinth {

/// Items of the scene of a level.
enum BoardItem : int {
    kSun = 1,
    kMaze,
    kBallItem,
    kGhostItem,
    kGoalItem,
    kBeamItem,   ///< the light over the goal
    kRingItem,   ///< the light that runs out from the goal when the ball is in it
    kBehindItem, ///< the ball where a wall hides it from the viewer
    kLeaning,    ///< the group of all that leans with the board
    kFirstTrail, ///< where the ball has been, the newest first
    kFirstPickUp = kFirstTrail + 16
};

/// A level as a visitor sees it: what stands still is made once, and `show` puts in what moves.
class Board {
public:
    /// `pictures` are of `boardPictures`.
    Board(const Game& game, const SceneAssets& pictures);

    [[nodiscard]] const std::shared_ptr<const SceneAssets>& assets() const noexcept { return assets_; }
    /// What a picture shows beside the game.
    struct Beside {
        const Ghost* best = nullptr;   ///< the best run so far, if there is one
        double inGoal = 0.0;           ///< seconds that the ball has been in the goal
        glm::dvec2 lean{0.0};          ///< of the board on the device, radians as Game's
        std::optional<glm::dvec3> eye; ///< of the viewer, device metres
    };
    [[nodiscard]] std::shared_ptr<const Scene> show(const Game& game, const Beside& beside) const;

private:
    Scene still_;
    std::vector<glm::ivec2> pickUps_; ///< of the level, in the order of their items
    std::shared_ptr<const SceneAssets> assets_;
};

/// How the board turns about the middle of the sheet for a lean: positive x lowers its right side, positive y the one
/// towards the player.
[[nodiscard]] glm::dquat boardTurn(const glm::dvec2& lean);

/// The last place on the way from the ball to an eye at which a block stands in it, metres from the ball; 0: none
/// does. All in the frame of the level, height 0 at the sheet.
[[nodiscard]] double hiddenUpTo(const std::vector<Block>& blocks, const glm::dvec3& ball, const glm::dvec3& eye);

/// The pictures of all materials of some levels, read once: it takes its time.
[[nodiscard]] std::shared_ptr<const SceneAssets> boardPictures(const std::vector<Level>& levels);

} // namespace lumorph::labyrinth
