#include <fstream>
#include <random>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/applications/labyrinth/level.h"
#include "app/applications/labyrinth/level_blocks.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "tests/core/temporary_folder.h"

// R39: levels as text, read with the place of every mistake, and as the solid pieces that the ball rolls on.

namespace lumorph::labyrinth {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSmall = "lumorph labyrinth 1\n"
                               "name: Small\n"
                               "\n"
                               "map:\n"
                               "#########\n"
                               "#@.>>.r.#\n"
                               "#.O##.X.#\n"
                               "#########\n"
                               "#########\n"
                               "\n"
                               "heights:\n"
                               ".........\n"
                               ".0001222.\n"
                               ".00..222.\n"
                               ".........\n"
                               ".........\n";

TEST(LabyrinthLevel, IsReadAsItIsWritten) {
    const Level level = readLevel(kSmall, "small");
    EXPECT_EQ(level.name, "Small");
    EXPECT_EQ(level.columns, 9);
    EXPECT_EQ(level.rows, 5);
    EXPECT_EQ(level.start, glm::ivec2(1, 1));
    EXPECT_EQ(level.goal, glm::ivec2(6, 2));
    EXPECT_EQ(level.at({2, 2}).tile, Tile::hole);
    EXPECT_EQ(level.at({4, 1}).tile, Tile::ramp);
    EXPECT_EQ(level.at({4, 1}).height, 1);
    EXPECT_EQ(level.at({6, 1}).pickUp, PickUp::red);
    EXPECT_EQ(readLevel(levelText(level), "again"), level);
}

TEST(LabyrinthLevel, BundledOnesFitTheTabletAndAreWrittenAndReadAlike) {
    const std::vector<Level> levels = bundledLevels();
    ASSERT_EQ(levels.size(), 8U);
    const Box device = boundingBox(readRig(resourceFile("models/tablet.glb")).restMesh().positions);
    std::set<std::string> names;
    for (const Level& level : levels) {
        EXPECT_EQ(readLevel(levelText(level), level.name), level) << level.name;
        EXPECT_NEAR(level.columns * level.cell, device.max.x - device.min.x, 1e-6) << level.name;
        EXPECT_NEAR(level.rows * level.cell, device.max.z - device.min.z, 1e-6) << level.name;
        EXPECT_FALSE(level.idea.empty()) << level.name;
        names.insert(level.name);
    }
    EXPECT_EQ(names.size(), levels.size());
}

TEST(LabyrinthLevel, MistakesAreNamedWithLineColumnAndRemedy) {
    const struct {
        std::string from, to;
        std::string place, why, remedy;
    } rows[] = {
        {"lumorph labyrinth 1", "lumorph maze", "line 1, column 1", "does not begin", "write 'lumorph labyrinth 1'"},
        {"name: Small", "nam: Small", "line 2, column 1", "'nam'", "choose among name"},
        {"name: Small", "cell: 10 cm", "line 2, column 6", "no number in mm", "10 mm"},
        {"name: Small", "cell: 400 mm", "cell", "not between", "choose"},
        {"name: Small", "floor: Gold", "Gold", "none of this name", "Paper"},
        {"#@.>>.r.#", "#@.>>?r.#", "line 6, column 6", "no sign", "r g b y p"},
        {"#@.>>.r.#", "#@.>>.r@#", "line 6, column 8", "second '@'", "leave one"},
        {"#@.>>.r.#", "#@.>>.r.", "line 6, column 9", "has 8 cells", "make it 9"},
        {"#@.>>.r.#", "#..>>.r.#", "line", "no start", "put an @"},
        {"#@.>>.r.#", "#@.>>.r..", "line 6, column 9", "rim is open", "wall"},
        {"#@.>>.r.#", "#@.>v.r.#", "line 6, column 4", "ramp leads up to nothing", "turn it"},
        {"#@.>>.r.#", "#@.>>#r.#", "line 6, column 5", "leads up to nothing", "floor"},
        {".0001222.", ".0021222.", "line 6, column 4", "rises by -1", "1 to 2"},
        {".0001222.", ".1101222.", "line 6, column 4", "does not begin where the floor", "height"},
        {".0001222.", ".000x222.", "line 13, column 5", "no height", "0 to 9"},
        {"#.O##.X.#", "#.O##.==#", "line", "no goal", "put an X"},
        {"#.O##.X.#", "#..==.X.#", "line 7, column 4", "ends do not lie equally high", "one height"},
    };
    for (const auto& row : rows) {
        std::string text = kSmall;
        text.replace(text.find(row.from), row.from.size(), row.to);
        try {
            (void)readLevel(text, "small");
            ADD_FAILURE() << row.to << " was read";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(row.place)) << row.to;
            EXPECT_THAT(error.what(), HasSubstr(row.why)) << row.to;
            EXPECT_THAT(error.what(), HasSubstr(row.remedy)) << row.to;
        }
    }
    EXPECT_THROW((void)readLevel(std::string(100'000, '#'), "huge"), DataError);
    EXPECT_THROW((void)readLevel("", "empty"), DataError);
}

TEST(LabyrinthLevel, DamagedTextsAreReadOrRefusedAndNothingElse) {
    std::mt19937 random(3);
    int read = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        std::string text = kSmall;
        for (int edits = 1 + static_cast<int>(random() % 3); edits > 0; --edits) {
            const std::size_t at = random() % text.size();
            if (random() % 3 == 0)
                text.erase(at, 1);
            else
                text[at] = "#.OX@><v^RDLU=Hr0129\n: "[random() % 23];
        }
        try {
            const Level level = readLevel(text, "damaged");
            EXPECT_EQ(readLevel(levelText(level), "again"), level);
            ++read;
        } catch (const Error&) {
        }
    }
    EXPECT_GT(read, 100) << "some damage does no harm";
}

/// The height of the uppermost piece at a place, by the signs of the map alone.
double literalHeight(const Level& level, const glm::dvec2& place) {
    const glm::ivec2 cell = cellAt(level, place);
    const LevelCell& here = level.at(cell);
    const glm::dvec2 from = place - centreOf(level, cell);
    switch (here.tile) {
    case Tile::hole:
        return glm::length(from) < 0.39 * level.cell ? std::nan("") : here.height * level.step;
    case Tile::ramp: {
        const glm::ivec2 up = stepOf(here.way);
        const double low = *groundAt(level, cell, opposite(here.way)), high = *groundAt(level, cell, here.way);
        return low + (high - low) * (0.5 + (from.x * up.x + from.y * up.y) / level.cell);
    }
    default:
        return here.height * level.step;
    }
}

TEST(LabyrinthLevel, IsReadAsEditorsOfOtherSystemsWriteIt) {
    const Level level = readLevel(kSmall, "small");
    std::string lines, wide = "\xFF\xFE";
    for (const char c : std::string(kSmall)) {
        if (c == '\n') lines += '\r';
        lines += c;
    }
    for (const char c : lines) (wide += c) += '\0';
    for (const std::string& text : {"\xEF\xBB\xBF" + std::string(kSmall), "\xEF\xBB\xBF" + lines, lines, wide})
        EXPECT_EQ(readLevel(text, "small"), level);
    const TemporaryFolder folder;
    std::ofstream(folder / "wide.txt", std::ios::binary) << wide;
    EXPECT_EQ(readLevelFile(folder / "wide.txt"), level);
    EXPECT_EQ(readUnfinishedLevel(folder / "wide.txt"), level);
}

TEST(LabyrinthLevel, BlocksLieWhereTheMapSays) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(-0.5, 0.5);
    for (const Level& level : bundledLevels()) {
        const std::vector<Block> blocks = blocksOf(level);
        EXPECT_LT(blocks.size(), 400U) << level.name;
        for (int trial = 0; trial < 3000; ++trial) {
            const glm::dvec2 place = level.cell * glm::dvec2(share(random) * level.columns, share(random) * level.rows);
            const glm::ivec2 cell = cellAt(level, place);
            const Tile tile = level.at(cell).tile;
            const double fromMiddle = glm::length(place - centreOf(level, cell)) / level.cell;
            if (tile == Tile::stairs || tile == Tile::bridge ||
                (tile == Tile::hole && fromMiddle > 0.38 && fromMiddle < 0.41))
                continue;
            double top = std::nan("");
            for (const Block& block : blocks)
                if (const double height = topAt(block, place); !std::isnan(height)) top = std::fmax(top, height);
            const double expected = tile == Tile::wall ? wallTop(level, cell) : literalHeight(level, place);
            if (std::isnan(expected))
                EXPECT_TRUE(std::isnan(top)) << level.name;
            else
                EXPECT_NEAR(top, expected, 1e-9) << level.name << " " << cell.x << " " << cell.y;
        }
    }
}

} // namespace
} // namespace lumorph::labyrinth
