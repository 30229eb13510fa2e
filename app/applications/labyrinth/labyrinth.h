#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/applications/demo.h"
#include "app/applications/labyrinth/board.h"
#include "app/applications/labyrinth/game.h"
#include "app/applications/labyrinth/relief.h"
#include "app/applications/labyrinth/route.h"
#include "app/applications/visitor.h"
#include "core/loop/show_program.h"

namespace lumorph::labyrinth {

/// The labyrinth as an application: levels one after another, shown by light, their relief and the ball felt through
/// the servos. Without a visitor it plays by itself. Sounds of a frame are
/// `labyrinth.roll`, `.bump`, `.pickup`, `.fall` and `.goal`.
class LabyrinthProgram final : public ShowProgram {
public:
    /// `best` are the best runs so far, by the names of their levels. Throws InvalidInput without a level.
    LabyrinthProgram(std::uint64_t seed, std::vector<Level> levels, std::vector<Ghost> best = {});

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    [[nodiscard]] const Game& game() const noexcept { return *game_; }
    [[nodiscard]] std::size_t level() const noexcept { return number_; } ///< from 0
    [[nodiscard]] bool playsItself() const noexcept { return !visitor_.there(); }
    /// By how much the board leans on the device, in picture and relief, radians as Game's: what of the game's lean the
    /// device has not done itself, a part of it.
    [[nodiscard]] glm::dvec2 boardLean() const noexcept;
    [[nodiscard]] const std::vector<Ghost>& bestRuns() const noexcept { return best_; }

private:
    void begin(std::size_t level);
    void turn();
    bool finish(double step);
    bool keepRun();
    [[nodiscard]] const Ghost* best() const;
    [[nodiscard]] std::vector<ShowSound> sounds() const;

    std::uint64_t seed_;
    std::vector<Level> levels_;
    std::vector<Ghost> best_;
    std::shared_ptr<const SceneAssets> pictures_;
    std::shared_ptr<const ShowCaption> caption_;
    std::pair<int, int> stands_; ///< seconds and points that it tells
    Visitor visitor_;
    std::size_t number_ = 0;
    double rests_ = 0.0; ///< seconds in the goal
    std::optional<Game> game_;
    std::optional<Pilot> pilot_;
    std::optional<Board> board_;
    std::optional<Relief> relief_;
};

[[nodiscard]] Demo labyrinthDemo();

} // namespace lumorph::labyrinth
