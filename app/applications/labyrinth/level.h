#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace lumorph::labyrinth {

enum class Tile : std::uint8_t { floor, wall, hole, ramp, stairs, bridge };

/// A direction on the map as it is written: right is +X of the device, down is +Z, towards the player.
enum class Way : std::uint8_t { right, down, left, up };
inline constexpr std::array kWays{Way::right, Way::down, Way::left, Way::up};
[[nodiscard]] glm::ivec2 stepOf(Way way) noexcept;
[[nodiscard]] Way opposite(Way way) noexcept;
[[nodiscard]] bool isAcross(Way way) noexcept; ///< right or left

enum class PickUp : std::uint8_t { none, red, green, blue, yellow, violet };

struct LevelCell {
    Tile tile = Tile::floor;
    Way way = Way::right; ///< of ramps and stairs: uphill; of bridges: along the deck (right or down)
    int height = 0; ///< of the floor, in steps; of ramps and stairs: their lower end; of bridges: what lies beneath
    PickUp pickUp = PickUp::none; ///< on plain floor alone
    bool operator==(const LevelCell&) const = default;
};

/// A labyrinth as a plain value. Its middle is the device's, its height 0 the device's sheet at rest.
struct Level {
    std::string name;
    std::string idea;                   ///< one sentence: what is new in it
    std::string nameGerman, ideaGerman; ///< the same in German; empty: there is none
    double cell = 0.010;                ///< side of a cell, metres
    double step = 0.0015;               ///< one unit of height, metres
    double wall = 0.005;                ///< of walls over the highest floor beside them, metres
    double seconds = 60.0;              ///< who is faster scores
    std::string floorMaterial = "Wood"; ///< names of ready materials
    std::string wallMaterial = "Brick";
    int columns = 0;
    int rows = 0;
    std::vector<LevelCell> cells; ///< rows one after another, the farthest from the player first
    glm::ivec2 start{0};
    glm::ivec2 goal{0};

    [[nodiscard]] bool holds(glm::ivec2 place) const noexcept;
    [[nodiscard]] const LevelCell& at(glm::ivec2 place) const noexcept;
    bool operator==(const Level&) const = default;
};

inline constexpr int kMinCells = 5; ///< a side
inline constexpr int kMaxCells = 48;
inline constexpr int kMaxHeight = 9;             ///< steps
inline constexpr double kBallRadius = 0.0035;    ///< metres
inline constexpr double kDeckThickness = 0.0012; ///< of bridges, metres

/// Middle of a cell, x and z in device metres; and the cell at a place, which may lie outside.
[[nodiscard]] glm::dvec2 centreOf(const Level& level, glm::ivec2 cell) noexcept;
[[nodiscard]] glm::ivec2 cellAt(const Level& level, const glm::dvec2& place) noexcept;

/// How high the ground of a cell lies at one of its sides, metres over the sheet: of ramps and stairs at their lower
/// and upper end, of bridges that of the passage. Nothing where one cannot go: walls, holes, and beside ramps and
/// stairs.
[[nodiscard]] std::optional<double> groundAt(const Level& level, glm::ivec2 cell, Way side) noexcept;
/// The deck of a bridge, metres over the sheet; nothing of other cells.
[[nodiscard]] std::optional<double> deckOf(const Level& level, glm::ivec2 cell) noexcept;
/// The upper edge of a wall, metres over the sheet.
[[nodiscard]] double wallTop(const Level& level, glm::ivec2 cell) noexcept;

/// Throws InvalidInput naming the cell and the remedy: sizes out of bounds, a rim that is open, start or goal not on
/// plain floor, ramps and stairs that lead nowhere, bridges without clearance.
void checkLevel(const Level& level);

/// Reads the text of a level (resources/guide/labyrinth-levels.md); `name` stands in errors. Throws DataError naming
/// line, column and remedy.
[[nodiscard]] Level readLevel(std::string_view text, const std::string& name);
[[nodiscard]] Level readLevelFile(const std::filesystem::path& file);
/// The text that is read as the same level. Throws as `checkLevel`.
[[nodiscard]] std::string levelText(const Level& level);

/// A level that somebody still makes, in the same text: what `checkLevel` refuses is taken, and goes back and forth.
/// Its sizes are those of a level all the same. Throws DataError and InvalidInput.
[[nodiscard]] Level readUnfinishedLevel(const std::filesystem::path& file);
[[nodiscard]] std::string unfinishedLevelText(const Level& level);

/// The levels that come with the program, in the order in which they are played. Throws DataError.
[[nodiscard]] std::vector<Level> bundledLevels();

} // namespace lumorph::labyrinth
