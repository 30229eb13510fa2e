#pragma once

#include <memory>
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
    kFirstTrail, ///< where the ball has been, the newest first
    kFirstPickUp = kFirstTrail + 16
};

/// A level as a visitor sees it: what stands still is made once, and `show` puts in what moves.
class Board {
public:
    /// `pictures` are of `boardPictures`.
    Board(const Game& game, const SceneAssets& pictures);

    [[nodiscard]] const std::shared_ptr<const SceneAssets>& assets() const noexcept { return assets_; }
    /// The game now, with the best run so far beside it (may be null); the ball has been in the goal for so many
    /// seconds.
    [[nodiscard]] std::shared_ptr<const Scene> show(const Game& game, const Ghost* best, double inGoal) const;

private:
    Scene still_;
    std::vector<glm::ivec2> pickUps_; ///< of the level, in the order of their items
    std::shared_ptr<const SceneAssets> assets_;
};

/// The pictures of all materials of some levels, read once: it takes its time.
[[nodiscard]] std::shared_ptr<const SceneAssets> boardPictures(const std::vector<Level>& levels);

} // namespace lumorph::labyrinth
