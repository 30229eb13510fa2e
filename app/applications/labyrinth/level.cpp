#include "app/applications/labyrinth/level.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/material_library.h"

namespace lumorph::labyrinth {
namespace {

/// Of ramps: what a ball can roll up while the labyrinth leans as far as it may.
constexpr int kMaxRampRise = 2;
constexpr int kMaxStairsRise = 6;

std::string placeOf(glm::ivec2 cell) {
    return "cell in column " + std::to_string(cell.x + 1) + ", row " + std::to_string(cell.y + 1);
}

[[noreturn]] void refuse(glm::ivec2 cell, const std::string& why, const std::string& remedy) {
    throw InvalidInput(placeOf(cell), why, remedy);
}

bool isSlope(const LevelCell& cell) { return cell.tile == Tile::ramp || cell.tile == Tile::stairs; }
bool isSolid(const Level& level, glm::ivec2 cell) {
    return !level.holds(cell) || level.at(cell).tile == Tile::wall || level.at(cell).tile == Tile::hole;
}

/// The height at which one enters a cell when one comes the way `way`; steps.
std::optional<int> entry(const Level& level, glm::ivec2 cell, Way way);

/// Steps at the upper end of a slope: what it leads to.
std::optional<int> upperEnd(const Level& level, glm::ivec2 cell) {
    const Way way = level.at(cell).way;
    return entry(level, cell + stepOf(way), way);
}

/// Of the floor or slope at the end of a bridge, `way` along it from `cell`; steps.
std::optional<int> bank(const Level& level, glm::ivec2 cell, Way way) {
    while (level.holds(cell) && level.at(cell).tile == Tile::bridge && isAcross(level.at(cell).way) == isAcross(way))
        cell += stepOf(way);
    if (isSolid(level, cell)) return std::nullopt;
    const LevelCell& end = level.at(cell);
    // A ramp up to the bridge ends where the deck begins; its upper end would ask for the deck again.
    if (isSlope(end)) return end.way == way ? std::optional(end.height) : std::nullopt;
    return end.tile == Tile::floor ? std::optional(end.height) : std::nullopt;
}

std::optional<int> entry(const Level& level, glm::ivec2 cell, Way way) {
    if (isSolid(level, cell)) return std::nullopt;
    const LevelCell& entered = level.at(cell);
    if (isSlope(entered) && entered.way != way) return std::nullopt;
    if (entered.tile == Tile::bridge && isAcross(entered.way) == isAcross(way)) return bank(level, cell, way);
    return entered.height;
}

void checkRange(const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most))
        throw InvalidInput(what,
                           "is " + std::to_string(value) + ", not between " + std::to_string(least) + " and " +
                               std::to_string(most),
                           "choose a number between them");
}

void checkNumbers(const Level& level) {
    const auto sound = [](int cells) { return cells >= kMinCells && cells <= kMaxCells; };
    if (!sound(level.columns) || !sound(level.rows) ||
        level.cells.size() != static_cast<std::size_t>(level.columns) * static_cast<std::size_t>(level.rows))
        throw InvalidInput("map",
                           "has " + std::to_string(level.columns) + " x " + std::to_string(level.rows) + " cells",
                           "give it " + std::to_string(kMinCells) + " to " + std::to_string(kMaxCells) + " a side");
    checkRange("cell", level.cell, 0.009, 0.04);
    checkRange("step", level.step, 0.0005, 0.005);
    checkRange("wall", level.wall, 0.004, 0.02);
    checkRange("time", level.seconds, 1.0, 3600.0);
    for (const std::string* text : {&level.name, &level.idea, &level.nameGerman, &level.ideaGerman})
        if (text->size() > 200 || text->find_first_of("\r\n") != std::string::npos)
            throw InvalidInput("name or idea", "is no line of at most 200 characters", "make it shorter");
    (void)readyMaterial(level.floorMaterial);
    (void)readyMaterial(level.wallMaterial);
}

void checkPlain(const Level& level, glm::ivec2 cell, const char* what) {
    if (!level.holds(cell) || level.at(cell).tile != Tile::floor)
        refuse(cell, std::string(what) + " does not lie on plain floor", "put it on floor");
}

void checkSlope(const Level& level, glm::ivec2 cell) {
    const LevelCell& slope = level.at(cell);
    const char* what = slope.tile == Tile::ramp ? "ramp" : "stairs";
    const std::optional<int> upper = upperEnd(level, cell);
    if (!upper)
        refuse(cell, std::string(what) + " leads up to nothing that can be walked on", "turn it, or put floor there");
    const int rise = *upper - slope.height;
    const int most = slope.tile == Tile::ramp ? kMaxRampRise : kMaxStairsRise;
    if (rise < 1 || rise > most)
        refuse(cell, std::string(what) + " rises by " + std::to_string(rise) + " steps",
               "let it rise by 1 to " + std::to_string(most) + "; its height is that of its lower end");
    const glm::ivec2 below = cell - stepOf(slope.way);
    const std::optional<double> foot = groundAt(level, below, slope.way);
    const bool fromDeck = level.holds(below) && level.at(below).tile == Tile::bridge &&
                          isAcross(level.at(below).way) == isAcross(slope.way);
    if (!fromDeck && (!foot || std::abs(*foot - slope.height * level.step) > 1e-9))
        refuse(cell, std::string(what) + " does not begin where the floor before it lies",
               "give it the height of the floor before it");
}

void checkBridge(const Level& level, glm::ivec2 cell) {
    const LevelCell& bridge = level.at(cell);
    const std::optional<double> deck = deckOf(level, cell);
    if (!deck)
        refuse(cell, "bridge whose ends do not lie equally high", "put floor or ramps of one height at both ends");
    const double least = bridge.height * level.step + 2.0 * kBallRadius + kDeckThickness + 0.0005;
    if (*deck < least)
        refuse(cell, "the ball does not fit below the bridge",
               "raise its ends to " + std::to_string(static_cast<int>(std::ceil(least / level.step - 1e-9))) +
                   " steps or more");
}

} // namespace

glm::ivec2 stepOf(Way way) noexcept {
    constexpr std::array kSteps{glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(-1, 0), glm::ivec2(0, -1)};
    return kSteps[static_cast<std::size_t>(way)];
}

Way opposite(Way way) noexcept { return static_cast<Way>((static_cast<int>(way) + 2) % 4); }

bool isAcross(Way way) noexcept { return way == Way::right || way == Way::left; }

bool Level::holds(glm::ivec2 place) const noexcept {
    return place.x >= 0 && place.y >= 0 && place.x < columns && place.y < rows;
}

const LevelCell& Level::at(glm::ivec2 place) const noexcept {
    return cells[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(place.x)];
}

glm::dvec2 centreOf(const Level& level, glm::ivec2 cell) noexcept {
    return level.cell * (glm::dvec2(cell) + 0.5 - 0.5 * glm::dvec2(level.columns, level.rows));
}

glm::ivec2 cellAt(const Level& level, const glm::dvec2& place) noexcept {
    const glm::dvec2 cell = place / level.cell + 0.5 * glm::dvec2(level.columns, level.rows);
    return {static_cast<int>(std::floor(std::clamp(cell.x, -1.0, 1e4))),
            static_cast<int>(std::floor(std::clamp(cell.y, -1.0, 1e4)))};
}

std::optional<double> groundAt(const Level& level, glm::ivec2 cell, Way side) noexcept {
    if (isSolid(level, cell)) return std::nullopt;
    const LevelCell& ground = level.at(cell);
    if (!isSlope(ground) || side == opposite(ground.way)) return ground.height * level.step;
    if (side != ground.way) return std::nullopt;
    const std::optional<int> upper = upperEnd(level, cell);
    return upper ? std::optional(*upper * level.step) : std::nullopt;
}

std::optional<double> deckOf(const Level& level, glm::ivec2 cell) noexcept {
    if (!level.holds(cell) || level.at(cell).tile != Tile::bridge) return std::nullopt;
    // At least one end says how high the deck lies; ramps up to it, seen from the deck, say nothing.
    const Way way = level.at(cell).way;
    const std::optional<int> one = bank(level, cell, way);
    const std::optional<int> other = bank(level, cell, opposite(way));
    if (one && other && *one != *other) return std::nullopt;
    const std::optional<int> deck = one ? one : other;
    return deck ? std::optional(*deck * level.step) : std::nullopt;
}

double wallTop(const Level& level, glm::ivec2 cell) noexcept {
    double highest = 0.0;
    for (int dz = -1; dz <= 1; ++dz)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 beside = cell + glm::ivec2(dx, dz);
            if (!level.holds(beside) || level.at(beside).tile == Tile::wall) continue;
            highest = std::max(highest, level.at(beside).height * level.step);
            if (const std::optional<double> deck = deckOf(level, beside)) highest = std::max(highest, *deck);
            for (const Way side : kWays)
                if (const std::optional<double> ground = groundAt(level, beside, side))
                    highest = std::max(highest, *ground);
        }
    return highest + level.wall;
}

void checkLevel(const Level& level) {
    checkNumbers(level);
    checkPlain(level, level.start, "the start");
    checkPlain(level, level.goal, "the goal");
    if (level.start == level.goal) refuse(level.goal, "start and goal are one", "put the goal elsewhere");
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column) {
            const glm::ivec2 cell(column, row);
            const LevelCell& here = level.at(cell);
            const bool rim = column == 0 || row == 0 || column == level.columns - 1 || row == level.rows - 1;
            if (rim && here.tile != Tile::wall) refuse(cell, "the rim is open", "put a wall there");
            if (here.height < 0 || here.height > kMaxHeight)
                refuse(cell, "its height is " + std::to_string(here.height), "choose 0 to 9 steps");
            if (here.pickUp != PickUp::none) checkPlain(level, cell, "the pick-up");
            if (isSlope(here)) checkSlope(level, cell);
            if (here.tile == Tile::bridge) checkBridge(level, cell);
        }
}

} // namespace lumorph::labyrinth
