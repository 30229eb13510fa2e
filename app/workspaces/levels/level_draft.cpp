#include "app/workspaces/levels/level_draft.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/applications/labyrinth/route.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

using labyrinth::Level;
using labyrinth::LevelCell;
using labyrinth::PickUp;
using labyrinth::Tile;
using labyrinth::Way;
using Kind = LevelPiece::Kind;

constexpr std::size_t kMostSteps = 500; ///< of undo

bool isRim(const Level& level, glm::ivec2 cell) {
    return cell.x <= 0 || cell.y <= 0 || cell.x >= level.columns - 1 || cell.y >= level.rows - 1;
}

LevelCell& cellOf(Level& level, glm::ivec2 cell) {
    return level.cells[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(level.columns) +
                       static_cast<std::size_t>(cell.x)];
}

bool isPassable(const Level& level, glm::ivec2 cell) {
    return level.holds(cell) && level.at(cell).tile != Tile::wall && level.at(cell).tile != Tile::hole;
}

/// Of a slope's lower end: what lies before it, a further slope going on.
int lowerEnd(const Level& level, glm::ivec2 cell, Way way, int height) {
    const glm::ivec2 below = cell - labyrinth::stepOf(way);
    if (!isPassable(level, below)) return height;
    const LevelCell& before = level.at(below);
    const bool goesOn = (before.tile == Tile::ramp || before.tile == Tile::stairs) && before.way == way;
    return std::min(before.height + (goesOn ? 1 : 0), labyrinth::kMaxHeight - 1);
}

/// Of the passage below a bridge: what lies beside its deck.
int passage(const Level& level, glm::ivec2 cell, Way along) {
    int lowest = labyrinth::kMaxHeight;
    bool any = false;
    for (const Way way : labyrinth::kWays) {
        const glm::ivec2 beside = cell + labyrinth::stepOf(way);
        if (labyrinth::isAcross(way) == labyrinth::isAcross(along) || !isPassable(level, beside)) continue;
        lowest = std::min(lowest, level.at(beside).height);
        any = true;
    }
    return any ? lowest : 0;
}

LevelCell cellFor(const LevelPiece& piece, const Level& level, glm::ivec2 at, int height) {
    switch (piece.kind) {
    case Kind::wall:
        return {Tile::wall};
    case Kind::hole:
        return {Tile::hole, Way::right, height};
    case Kind::ramp:
        return {Tile::ramp, piece.way, lowerEnd(level, at, piece.way, height)};
    case Kind::stairs:
        return {Tile::stairs, piece.way, lowerEnd(level, at, piece.way, height)};
    case Kind::bridge: {
        const Way along = labyrinth::isAcross(piece.way) ? Way::right : Way::down;
        return {Tile::bridge, along, passage(level, at, along)};
    }
    case Kind::pickUp:
        return {Tile::floor, Way::right, height, piece.color};
    default:
        return {Tile::floor, Way::right, height};
    }
}

std::string placeText(glm::ivec2 cell) {
    return "column " + std::to_string(cell.x + 1) + ", row " + std::to_string(cell.y + 1);
}

std::string begun(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

/// What checkLevel refuses, with the cell that it names.
LevelFinding findingOf(const InvalidInput& wrong) {
    LevelFinding finding;
    int column = 0, row = 0;
    if (std::sscanf(wrong.subject().c_str(), "cell in column %d, row %d", &column, &row) == 2)
        finding.cell = glm::ivec2(column - 1, row - 1);
    finding.text = begun(wrong.subject()) + ": " + wrong.why() + ". " + begun(wrong.remedy()) + ".";
    return finding;
}

} // namespace

const std::vector<OfferedPiece>& offeredPieces() {
    static const std::vector<OfferedPiece> pieces{
        {{Kind::floor}, '.', "Floor"},
        {{Kind::wall}, '#', "Wall"},
        {{Kind::hole}, 'O', "Hole"},
        {{Kind::ramp, Way::right}, '>', "Ramp up to the right"},
        {{Kind::ramp, Way::down}, 'v', "Ramp up towards the player"},
        {{Kind::ramp, Way::left}, '<', "Ramp up to the left"},
        {{Kind::ramp, Way::up}, '^', "Ramp up away from the player"},
        {{Kind::stairs, Way::right}, 'R', "Stairs up to the right"},
        {{Kind::stairs, Way::down}, 'D', "Stairs up towards the player"},
        {{Kind::stairs, Way::left}, 'L', "Stairs up to the left"},
        {{Kind::stairs, Way::up}, 'U', "Stairs up away from the player"},
        {{Kind::bridge, Way::right}, '=', "Bridge across"},
        {{Kind::bridge, Way::down}, 'H', "Bridge up and down"},
        {{Kind::pickUp, Way::right, PickUp::red}, 'r', "Red pick-up"},
        {{Kind::pickUp, Way::right, PickUp::green}, 'g', "Green pick-up"},
        {{Kind::pickUp, Way::right, PickUp::blue}, 'b', "Blue pick-up"},
        {{Kind::pickUp, Way::right, PickUp::yellow}, 'y', "Yellow pick-up"},
        {{Kind::pickUp, Way::right, PickUp::violet}, 'p', "Violet pick-up"},
        {{Kind::start}, '@', "Start"},
        {{Kind::goal}, 'X', "Goal"},
    };
    return pieces;
}

Level emptyLevel() {
    Level level;
    level.name = "A level of mine";
    level.columns = 21;
    level.rows = 15;
    level.cells.assign(static_cast<std::size_t>(level.columns * level.rows), LevelCell{});
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
            if (isRim(level, {column, row})) cellOf(level, {column, row}) = {Tile::wall};
    level.start = {1, 1};
    level.goal = {level.columns - 2, level.rows - 2};
    return level;
}

LevelDraft::LevelDraft() : steps_{{emptyLevel(), {}}} { look(); }

const LevelFinding* LevelDraft::firstFinding() const noexcept {
    return findings_.empty() ? nullptr : &findings_.front();
}

void LevelDraft::beginStroke(std::string name) { stroke_ = std::move(name); }

void LevelDraft::put(const LevelPiece& piece, glm::ivec2 cell, int height) {
    Level next = level();
    if (!next.holds(cell) || isRim(next, cell)) return;
    const bool ends = cell == next.start || cell == next.goal;
    if (piece.kind == Kind::pickUp && ends) return; // it would lie below the ball
    const int clamped = std::clamp(height, 0, labyrinth::kMaxHeight);
    if (piece.kind == Kind::start && cell != next.goal) next.start = cell;
    if (piece.kind == Kind::goal && cell != next.start) next.goal = cell;
    cellOf(next, cell) = cellFor(piece, next, cell, clamped);
    if (next == level()) return;
    if (stroke_) {
        push(std::move(next), *std::exchange(stroke_, std::nullopt));
    } else {
        steps_[at_].level = std::move(next);
        look();
    }
}

void LevelDraft::change(Level next, std::string name) {
    const auto sound = [](int cells) { return cells >= labyrinth::kMinCells && cells <= labyrinth::kMaxCells; };
    if (!sound(next.columns) || !sound(next.rows) ||
        next.cells.size() != static_cast<std::size_t>(next.columns) * static_cast<std::size_t>(next.rows))
        return;
    if (next != level()) push(std::move(next), std::move(name));
}

void LevelDraft::resize(int columns, int rows) {
    const Level& before = level();
    Level next = before;
    next.columns = std::clamp(columns, labyrinth::kMinCells, labyrinth::kMaxCells);
    next.rows = std::clamp(rows, labyrinth::kMinCells, labyrinth::kMaxCells);
    next.cells.assign(static_cast<std::size_t>(next.columns) * static_cast<std::size_t>(next.rows), LevelCell{});
    for (int row = 0; row < next.rows; ++row)
        for (int column = 0; column < next.columns; ++column) {
            const glm::ivec2 cell(column, row);
            if (isRim(next, cell))
                cellOf(next, cell) = {Tile::wall};
            else if (before.holds(cell) && !isRim(before, cell))
                cellOf(next, cell) = before.at(cell);
        }
    for (glm::ivec2* end : {&next.start, &next.goal})
        *end = glm::clamp(*end, glm::ivec2(1), glm::ivec2(next.columns - 2, next.rows - 2));
    change(std::move(next), "Change the size");
}

void LevelDraft::push(Level next, std::string name) {
    steps_.resize(at_ + 1);
    steps_.push_back({std::move(next), std::move(name)});
    if (steps_.size() > kMostSteps) steps_.erase(steps_.begin());
    at_ = steps_.size() - 1;
    look();
}

void LevelDraft::undo() {
    if (!canUndo()) return;
    --at_;
    look();
}

void LevelDraft::redo() {
    if (!canRedo()) return;
    ++at_;
    look();
}

/// Whether it can be played, and whether everything in it can be reached.
void LevelDraft::look() {
    findings_.clear();
    way_.clear();
    const Level& now = level();
    try {
        labyrinth::checkLevel(now);
    } catch (const InvalidInput& wrong) {
        findings_.push_back(findingOf(wrong));
        return;
    }
    const labyrinth::Routes routes(now, now.goal);
    const labyrinth::Spot start{now.start, false};
    if (!std::isfinite(routes.cost(start))) {
        findings_.push_back({now.goal, "The goal cannot be reached: no way leads to it from the start.", false});
        return;
    }
    for (std::optional<labyrinth::Spot> spot = start; spot; spot = routes.next(*spot)) way_.push_back(spot->cell);
    for (int row = 0; row < now.rows; ++row)
        for (int column = 0; column < now.columns; ++column) {
            const glm::ivec2 cell(column, row);
            if (now.at(cell).pickUp == PickUp::none) continue;
            if (!std::isfinite(labyrinth::Routes(now, cell).cost(start)))
                findings_.push_back({cell, "The pick-up in " + placeText(cell) + " cannot be reached.", false});
        }
}

} // namespace lumorph::studio
