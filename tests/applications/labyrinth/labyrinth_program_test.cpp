#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/labyrinth/labyrinth.h"
#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "core/motion/causal_split.h"
#include "core/motion/surface_heights.h"
#include "tests/support/program_visit.h"

// R39: the labyrinth as visitors meet it: who plays, what is seen and heard, what is felt, and what a frame costs.

namespace lumorph::labyrinth {
namespace {

using test::tabletRig;
using Visit = test::ProgramVisit;
using test::kFrame;

TEST(LabyrinthProgram, PlaysByItselfFromLevelToLevel) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    std::set<std::size_t> seen;
    for (int k = 0; k < 60 * 60; ++k) {
        visit.frame();
        ASSERT_NO_THROW(checkScene(*visit.content().scene)) << k;
        seen.insert(program.level());
    }
    EXPECT_GE(seen.size(), 3U) << "in a minute";
    EXPECT_TRUE(program.playsItself());
    EXPECT_TRUE(program.bestRuns().empty()) << "its own runs are nobody's best";
    EXPECT_GE(visit.heard("labyrinth.goal"), 2);
    EXPECT_GE(visit.heard("labyrinth.pickup"), 5);
    EXPECT_GT(visit.heard("labyrinth.roll"), 1000);
}

TEST(LabyrinthProgram, WhoLeansItPlaysAtOnceAndWhoGoesLeavesItToItself) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    visit.frames(20.0);
    visit.frame({{"key.right", 1.0}});
    EXPECT_FALSE(program.playsItself()) << "one key";
    EXPECT_EQ(program.level(), 0U) << "from the first level on";
    const float from = visit.item(kBallItem).position.x;
    visit.frames(0.5);
    EXPECT_GT(visit.item(kBallItem).position.x, from + 0.01F) << "to the right";
    visit.frame({{"key.right", 0.0}});
    visit.frame({{"key.next", 1.0}});
    EXPECT_EQ(program.level(), 1U);
    visit.frames(2.0);
    visit.frame({{"key.restart", 1.0}});
    EXPECT_EQ(program.level(), 1U);
    EXPECT_LT(program.game().seconds(), 0.1);
    visit.frames(Visitor::kSilence - 1.0);
    EXPECT_FALSE(program.playsItself());
    visit.frames(2.0);
    EXPECT_TRUE(program.playsItself());
}

TEST(LabyrinthProgram, SaysHowTheRunStandsAndFirstHasSomethingThatRises) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    for (int k = 0; k < 200; ++k) {
        const auto before = visit.content().caption;
        const int points = program.game().score(), seconds = static_cast<int>(program.game().seconds());
        visit.frame();
        const auto said = visit.content().caption;
        const std::string stands = "\n" + std::to_string(static_cast<int>(program.game().seconds())) + " s, " +
                                   std::to_string(program.game().score());
        ASSERT_NE(said->sentence.english.find(stands + " points"), std::string::npos) << said->sentence.english;
        ASSERT_NE(said->sentence.german.find(stands + " Punkte"), std::string::npos) << said->sentence.german;
        const bool same = points == program.game().score() && seconds == static_cast<int>(program.game().seconds());
        if (k > 0) {
            ASSERT_EQ(said == before, same) << "another one only where it says something else";
        }
    }
    const std::vector<LevelCell>& cells = program.game().level().cells;
    const auto floor = [](const LevelCell& cell) { return cell.tile == Tile::floor ? cell.height : 0; };
    EXPECT_GE(floor(*std::ranges::max_element(cells, {}, floor)), 3) << "of the first level, steps";
}

TEST(LabyrinthProgram, PointerStickAndDeviceLeanAlike) {
    const struct {
        std::vector<ShowInput> inputs;
        float aboutX, aboutZ;
        glm::dvec2 way; ///< in which the ball rolls
    } rows[] = {
        {{{"pointer.x", 1.0}}, 0.0F, 0.0F, {1.0, 0.0}},
        {{{"pad.y", 1.0}}, 0.0F, 0.0F, {0.0, 1.0}},
        {{{"key.right", 1.0}, {"key.down", 1.0}}, 0.0F, 0.0F, {1.0, 1.0}},
        {{}, 0.0F, -0.2F, {1.0, 0.0}}, // its right side down
        {{}, 0.2F, 0.0F, {0.0, 1.0}},  // its near side down
    };
    for (const auto& row : rows) {
        LabyrinthProgram program(1, bundledLevels());
        Visit visit(program);
        if (row.inputs.empty()) visit.lean(row.aboutX, row.aboutZ);
        visit.frame(row.inputs);
        EXPECT_FALSE(program.playsItself());
        const glm::dvec3 from = program.game().ball().position;
        visit.frames(0.35);
        const glm::dvec3 moved = program.game().ball().position - from;
        const std::string name = row.inputs.empty() ? "device" : row.inputs.front().name;
        EXPECT_GT(moved.x, row.way.x > 0.0 ? 0.008 : -0.001) << name;
        EXPECT_LT(moved.x, row.way.x > 0.0 ? 0.1 : 0.001) << name;
        EXPECT_GT(moved.z, row.way.y > 0.0 ? 0.008 : -0.001) << name;
        EXPECT_LT(moved.z, row.way.y > 0.0 ? 0.1 : 0.001) << name;
    }
}

TEST(LabyrinthProgram, ABestRunGoesBesideTheNextOneAsAGhost) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    Pilot hand(bundledLevels().front(), false);
    visit.frame({{"key.restart", 1.0}});
    for (int k = 0; k < 60 * 60 && !program.game().done(); ++k) {
        const glm::dvec2 lean = hand.lean(program.game().ball(), {}) / Game::kMostLean;
        visit.frame({{"pointer.x", lean.x}, {"pointer.y", lean.y}});
        EXPECT_FALSE(visit.item(kGhostItem).visible) << "there is none yet";
    }
    ASSERT_TRUE(program.game().done());
    visit.frame();
    EXPECT_TRUE(visit.item(kRingItem).visible) << "the goal shines";
    ASSERT_EQ(program.bestRuns().size(), 1U);
    const Ghost best = program.bestRuns().front();
    EXPECT_EQ(best, program.game().run());
    visit.frame({{"key.restart", 1.0}});
    visit.frames(1.5);
    const SceneItem& ghost = visit.item(kGhostItem);
    ASSERT_TRUE(ghost.visible);
    const glm::vec3 expected = positionAt(best, program.game().seconds()) + glm::vec3(0.0F, 0.02F, 0.0F);
    EXPECT_LT(glm::distance(ghost.position, expected), 1e-5F);
}

// Over all levels, with a hand that leans, goes on and begins again by chance.
TEST(LabyrinthProgram, SameSeedAndInputsGiveTheSameShowToTheBit) {
    LabyrinthProgram first(7, bundledLevels()), second(7, bundledLevels());
    Visit one(first), two(second);
    std::mt19937 random(3);
    const auto chance = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    std::set<std::size_t> seen;
    for (int k = 0; k < 60 * 40; ++k) {
        std::vector<ShowInput> inputs;
        if (k % 15 == 0) inputs = {{"pointer.x", 2.0 * chance() - 1.0}, {"pad.y", 2.0 * chance() - 1.0}};
        if (k % 240 == 239) inputs.push_back({chance() < 0.8 ? "key.next" : "key.restart", 1.0});
        const ShowContent &a = one.frame(inputs), &b = two.frame(inputs);
        ASSERT_EQ(a.sounds, b.sounds) << k;
        ASSERT_EQ(std::get<HeightGrid>(a.target).heights, std::get<HeightGrid>(b.target).heights) << k;
        ASSERT_EQ(a.scene->items.size(), b.scene->items.size()) << k;
        for (std::size_t i = 0; i < a.scene->items.size(); ++i) {
            ASSERT_EQ(a.scene->items[i].position, b.scene->items[i].position) << k;
            ASSERT_EQ(a.scene->items[i].visible, b.scene->items[i].visible) << k;
        }
        seen.insert(first.level());
    }
    EXPECT_GE(seen.size(), 4U);
    EXPECT_EQ(first.game().score(), second.game().score());
}

TEST(LabyrinthProgram, NeedsALevel) { EXPECT_THROW(LabyrinthProgram(1, {}), InvalidInput); }

/// Where a bump over a relief is highest.
glm::dvec2 peakOf(const HeightGrid& with, const HeightGrid& without) {
    std::size_t highest = 0;
    const auto bump = [&](std::size_t k) {
        return static_cast<double>(with.heights[k]) - static_cast<double>(without.heights[k]);
    };
    for (std::size_t k = 1; k < with.heights.size(); ++k)
        if (bump(k) > bump(highest)) highest = k;
    const auto columns = static_cast<std::size_t>(with.columns);
    const glm::dvec2 share(static_cast<double>(highest % columns) / (with.columns - 1),
                           static_cast<double>(highest / columns) / (with.rows - 1));
    return with.min + (with.max - with.min) * share;
}

TEST(LabyrinthProgram, TheBumpIsWithinAVoxelOfTheBall) {
    const auto voxel = static_cast<double>(frameOf(tabletRig()->reach(), BuildOptions{}.resolution).voxelSize);
    LabyrinthProgram program(3, bundledLevels());
    Visit visit(program);
    visit.frame();
    std::size_t level = 0;
    Relief relief(program.game().level(), program.game().blocks());
    int looked = 0;
    for (int k = 0; k < 60 * 60; ++k) {
        visit.frame();
        if (program.level() != level) relief = Relief(program.game().level(), program.game().blocks());
        level = program.level();
        const auto& grid = std::get<HeightGrid>(visit.content().target);
        ASSERT_NO_THROW(checkHeightGrid(grid));
        const glm::dvec3& ball = program.game().ball().position;
        const glm::dvec2 at(ball.x, ball.z);
        if (program.game().fallen()) continue;
        ++looked;
        ASSERT_LT(glm::distance(peakOf(grid, relief.level(program.boardLean())), at), voxel) << k;
    }
    EXPECT_GT(looked, 3000);
}

TEST(LabyrinthProgram, TheBoardLeansAsItIsAskedToAndNotTwiceWithTheDevice) {
    LabyrinthProgram program(3, bundledLevels());
    Visit visit(program);
    const auto placed = [&](double x, double z) { // of a place on the sheet
        const SceneItem& board = visit.item(kLeaning);
        return board.position + board.rotation * glm::vec3(x, 0.02, z);
    };
    const auto relief = [&](double x, double z) {
        return heightAt(std::get<HeightGrid>(visit.content().target), {x, z}) -
               heightAt(Relief(program.game().level(), program.game().blocks()).level(), {x, z});
    };
    visit.frame({{"key.right", 1.0}});
    visit.frames(0.5);
    EXPECT_NEAR(program.boardLean().x, 0.35 * 0.26, 0.002);
    EXPECT_NEAR(placed(0.1, 0.0).y, 0.02F - 0.0091F, 3e-4F) << "the right side is down";
    EXPECT_NEAR(placed(-0.1, 0.0).y, 0.02F + 0.0091F, 3e-4F);
    EXPECT_NEAR(placed(0.0, 0.0).y, 0.02F, 1e-5F);
    EXPECT_NEAR(relief(0.09, -0.05), -0.0082, 4e-4) << "and servos follow";
    visit.frame({{"key.right", 0.0}, {"key.down", 1.0}});
    visit.frames(0.5);
    EXPECT_NEAR(placed(0.0, 0.07).y, 0.02F - 0.0064F, 3e-4F) << "the side towards the player";
    visit.frame({{"key.down", 0.0}});
    visit.lean(0.2F, 0.0F);
    visit.frames(0.5);
    EXPECT_GT(program.game().lean().y, 0.15) << "the tracked device leans";
    EXPECT_NEAR(placed(0.0, 0.07).y, 0.02F, 3e-4F) << "and its picture with it, in its own frame";
}

/// Whether a point is in a block: on the inner side of its four sides, between underside and top.
bool isInside(const Block& block, const glm::dvec3& at) {
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 from = block.outline[k], side = block.outline[(k + 1) % 4] - from;
        const glm::dvec2 way = glm::dvec2(at.x, at.z) - from;
        if (side.x * way.y - side.y * way.x < 0.0) return false;
    }
    const glm::dvec2 origin = block.outline[0], u = block.outline[1] - origin, v = block.outline[3] - origin;
    const glm::dvec2 way = glm::dvec2(at.x, at.z) - origin;
    const double det = u.x * v.y - u.y * v.x;
    const double top = block.tops[0] + (way.x * v.y - way.y * v.x) / det * (block.tops[1] - block.tops[0]) +
                       (u.x * way.y - u.y * way.x) / det * (block.tops[3] - block.tops[0]);
    return at.y > block.bottom && at.y < top;
}

TEST(LabyrinthProgram, ABallBehindAWallIsSeenInFrontOfIt) {
    const glm::dvec3 eye(0.05, 0.30, 0.45); // over the sheet
    int hidden = 0, seen = 0;
    for (const Level& level : bundledLevels()) {
        const std::vector<Block> blocks = blocksOf(level);
        for (int row = 0; row < level.rows; ++row)
            for (int column = 0; column < level.columns; ++column) {
                const glm::dvec2 centre = centreOf(level, {column, row});
                const glm::dvec3 ball(centre.x, level.at({column, row}).height * level.step + kBallRadius, centre.y);
                if (std::ranges::any_of(blocks, [&](const Block& block) { return isInside(block, ball); })) continue;
                const glm::dvec3 way = glm::normalize(eye - ball);
                double last = 0.0, within = 0.0; // metres
                for (double gone = kBallRadius; gone < 0.1; gone += 1e-4)
                    if (std::ranges::any_of(blocks,
                                            [&](const Block& block) { return isInside(block, ball + gone * way); }))
                        last = gone, within += 1e-4;
                const double found = hiddenUpTo(blocks, ball, eye);
                const bool grazes = within > 0.0 && within < 3e-4; // a rim
                if (grazes || (last > 0.0 && last < kBallRadius + 2e-4)) continue;
                EXPECT_NEAR(found, last, 2e-4) << level.name << " " << column << " " << row;
                ++(last > 0.0 ? hidden : seen);
            }
    }
    EXPECT_GT(hidden, 20);
    EXPECT_GT(seen, 100);
}

TEST(LabyrinthProgram, WhatStandsForAHiddenBallIsAsLargeForTheEye) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    const glm::dvec3 eye(0.0, 0.13, 0.5); // of a child: walls are low
    visit.look(glm::vec3(eye));
    int shown = 0;
    for (int k = 0; k < 60 * 40; ++k) {
        visit.frame();
        const SceneItem& light = visit.item(kBehindItem);
        if (!light.visible) continue;
        ++shown;
        const SceneItem& board = visit.item(kLeaning);
        const auto seen = [&](const glm::vec3& place) {
            return glm::dvec3(board.position + board.rotation * place) - eye;
        };
        const glm::dvec3 ball = seen(visit.item(kBallItem).position), there = seen(light.position);
        EXPECT_LT(glm::length(there), glm::length(ball));
        EXPECT_GT(glm::dot(glm::normalize(ball), glm::normalize(there)), std::cos(1e-3)) << "one behind the other";
        EXPECT_NEAR(0.5 * static_cast<double>(light.scale.x) / glm::length(there), kBallRadius / glm::length(ball),
                    1e-4);
    }
    EXPECT_GT(shown, 30) << "in 40 s of its own play";
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How alike two series are, -1 to 1.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const double meanA = mean(a), meanB = mean(b);
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ab += (a[k] - meanA) * (b[k] - meanB);
        aa += (a[k] - meanA) * (a[k] - meanA);
        bb += (b[k] - meanB) * (b[k] - meanB);
    }
    return ab / std::sqrt(aa * bb);
}

/// The heights that the tablet takes for a relief that has always been so, over rest.
std::vector<double> carried(CausalSplit& split, const HeightGrid& relief) {
    std::vector<float> heights;
    for (const glm::vec2& point : split.points())
        heights.push_back(static_cast<float>(heightAt(relief, glm::dvec2(point))));
    split.restart();
    const std::vector<double> strokes = split.strokes(heights, 0.0);
    std::vector<float> top(split.restHeights().begin(), split.restHeights().end());
    TriangleMesh shape = tabletRig()->restMesh();
    shape.positions = deformed(*tabletRig(), strokes).positions;
    heightsOfMesh(shape, split.points(), top);
    std::vector<double> over;
    for (std::size_t k = 0; k < top.size(); ++k)
        over.push_back(static_cast<double>(top[k]) - static_cast<double>(split.restHeights()[k]));
    return over;
}

/// The mean of what lies within 25 mm of a place.
double around(const glm::dvec2& place, const CausalSplit& split, const std::vector<double>& values) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (glm::distance(glm::dvec2(split.points()[k]), place) > 0.025) continue;
        sum += values[k];
        ++count;
    }
    return sum / count;
}

// What hands feel without light. Six servos lift four corners and two halves: walls are too narrow for them, so that a
// third of a level's relief and more is what there is to carry.
TEST(LabyrinthProgram, TheTabletCarriesTheReliefOfALevel) {
    CausalSplit split(*tabletRig());
    for (const Level& level : bundledLevels()) {
        const Relief relief(level, blocksOf(level));
        std::vector<double> wanted;
        for (const glm::vec2& point : split.points())
            wanted.push_back(heightAt(relief.level(), glm::dvec2(point)) - 0.02);
        EXPECT_GT(correlation(wanted, carried(split, relief.level())), 0.3) << level.name;
    }
}

// By 5 to 8 mm; a millimetre is felt.
TEST(LabyrinthProgram, TheTabletRisesWhereTheBallIs) {
    CausalSplit split(*tabletRig());
    for (const Level& level : bundledLevels()) {
        const Relief relief(level, blocksOf(level));
        for (const glm::dvec2& ball : {glm::dvec2(0.0, 0.045), {0.0, -0.045}, {0.085, 0.055}, {-0.085, -0.055}}) {
            const std::vector<double> there = carried(split, relief.withBall(ball));
            const std::vector<double> opposite = carried(split, relief.withBall(-ball));
            const double more = around(ball, split, there) - around(ball, split, opposite);
            EXPECT_GT(more, 0.004) << level.name << ", ball at " << ball.x << " " << ball.y;
        }
    }
}

double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TEST(LabyrinthProgram, AFrameTakesASmallPartOfItsTime) {
    LabyrinthProgram program(1, bundledLevels());
    Visit visit(program);
    std::vector<double> milliseconds;
    for (int k = 0; k < 60 * 90; ++k) {
        const double begun = threadSeconds();
        visit.frame();
        milliseconds.push_back(1e3 * (threadSeconds() - begun));
    }
    std::ranges::sort(milliseconds);
    const double middle = milliseconds[milliseconds.size() / 2], late = milliseconds[milliseconds.size() * 99 / 100];
    RecordProperty("medianMilliseconds", std::to_string(middle));
    RecordProperty("percentile99Milliseconds", std::to_string(late));
    EXPECT_LE(middle, 2.0);
    EXPECT_LE(late, 8.0);
}

} // namespace
} // namespace lumorph::labyrinth
