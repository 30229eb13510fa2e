#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/applications/labyrinth/level.h"

namespace lumorph::studio {

/// What a hand puts into the cells of a level.
struct LevelPiece {
    enum class Kind { floor, wall, hole, ramp, stairs, bridge, pickUp, start, goal };
    Kind kind = Kind::wall;
    labyrinth::Way way = labyrinth::Way::right; ///< of ramps and stairs uphill, of bridges along their deck
    labyrinth::PickUp color = labyrinth::PickUp::red;
    bool operator==(const LevelPiece&) const = default;
};

/// All pieces, in the order in which they are offered, and the sign by which the level's text says each.
struct OfferedPiece {
    LevelPiece piece;
    char sign;
    const char* name; ///< for users
};
[[nodiscard]] const std::vector<OfferedPiece>& offeredPieces();

/// What is wrong with a level, or to be known of it.
struct LevelFinding {
    std::optional<glm::ivec2> cell;
    std::string text;     ///< whole sentences
    bool prevents = true; ///< it cannot be played
};

/// A level that is being made, with all steps that led to it. The rim is always wall. No window.
class LevelDraft {
public:
    LevelDraft();

    [[nodiscard]] const labyrinth::Level& level() const noexcept { return steps_[at_].level; }
    [[nodiscard]] const LevelFinding* firstFinding() const noexcept; ///< null: it is sound
    /// From the start to the goal, where there is a way.
    [[nodiscard]] const std::vector<glm::ivec2>& way() const noexcept { return way_; }

    /// Puts a piece into a cell; what needs floor below it lies at `height` steps. All between `beginStroke` and the
    /// next one is one step of undo. Cells of the rim, and those where it is already, stay as they are.
    void beginStroke(std::string name);
    void put(const LevelPiece& piece, glm::ivec2 cell, int height);
    /// Another level as a further step: one that was opened, or with other numbers. What is not a level by its size is
    /// not taken.
    void change(labyrinth::Level level, std::string name);
    /// The same level with so many cells: cut off, or filled with floor, on the right and towards the player.
    void resize(int columns, int rows);

    [[nodiscard]] bool canUndo() const noexcept { return at_ > 0; }
    [[nodiscard]] bool canRedo() const noexcept { return at_ + 1 < steps_.size(); }
    [[nodiscard]] const std::string& undoName() const noexcept { return steps_[at_].name; }
    [[nodiscard]] const std::string& redoName() const noexcept { return steps_[at_ + 1].name; }
    void undo();
    void redo();

private:
    struct Step {
        labyrinth::Level level;
        std::string name;
    };
    void push(labyrinth::Level level, std::string name);
    void look();

    std::vector<Step> steps_;
    std::size_t at_ = 0;
    std::optional<std::string> stroke_; ///< its name, until its first cell
    std::vector<LevelFinding> findings_;
    std::vector<glm::ivec2> way_;
};

/// An empty room of the tablet's size.
[[nodiscard]] labyrinth::Level emptyLevel();

} // namespace lumorph::studio
