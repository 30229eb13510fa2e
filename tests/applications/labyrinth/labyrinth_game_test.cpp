#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/labyrinth/game.h"
#include "app/applications/labyrinth/route.h"
#include "core/base/error.h"
#include "tests/support/long_tests.h"

// R39: the ball in real physics: it stays inside, runs alike twice, falls and comes back, and reaches every goal.

namespace lumorph::labyrinth {
namespace {

/// Leans at random: anew about four times a second, often as far as it goes.
class RandomHand {
public:
    explicit RandomHand(unsigned seed) : random_(seed) {}
    glm::dvec2 lean() {
        if (left_-- <= 0) {
            std::uniform_real_distribution<double> lean(-0.4, 0.4);
            lean_ = {lean(random_), lean(random_)};
            left_ = std::uniform_int_distribution<int>(5, 120)(random_);
        }
        return lean_;
    }

private:
    std::mt19937 random_;
    glm::dvec2 lean_{0.0};
    int left_ = 0;
};

bool same(const Ball& a, const Ball& b) {
    return std::memcmp(&a.position, &b.position, sizeof a.position) == 0 &&
           std::memcmp(&a.velocity, &b.velocity, sizeof a.velocity) == 0 &&
           std::memcmp(&a.rotation, &b.rotation, sizeof a.rotation) == 0;
}

Level withoutGoal(const char* map) { return readLevel(std::string("lumorph labyrinth 1\nmap:\n") + map, "test"); }

TEST(LabyrinthGame, TheBallNeverLeavesThroughAWall) {
    const std::vector<Level> levels = bundledLevels();
    const int runs = test::longTests() ? 1000 : 104;
    const int steps = 240 * (test::longTests() ? 20 : 10);
    for (int run = 0; run < runs; ++run) {
        const Level& level = levels[static_cast<std::size_t>(run) % levels.size()];
        Game game(level, static_cast<std::uint64_t>(run));
        RandomHand hand(static_cast<unsigned>(run));
        for (int step = 0; step < steps && !game.done(); ++step) {
            game.step(hand.lean());
            const glm::dvec3& at = game.ball().position;
            ASSERT_GT(at.y, -0.012) << level.name << ", run " << run << ": it falls through the ground";
            if (game.fallen()) continue;
            const glm::ivec2 cell = cellAt(level, {at.x, at.z});
            ASSERT_TRUE(level.holds(cell)) << "run " << run << ", step " << step;
            ASSERT_NE(level.at(cell).tile, Tile::wall)
                << level.name << ", run " << run << ", step " << step << ", at " << at.x << " " << at.y << " " << at.z;
            ASSERT_LT(at.y, 0.05);
        }
    }
}

TEST(LabyrinthGame, DoesNotSinkIntoWhatItRollsOn) {
    for (const Level& level : bundledLevels()) {
        Game game(level, 1);
        RandomHand hand(7);
        double deepest = 0.0;
        for (int step = 0; step < 240 * 10 && !game.done(); ++step) {
            game.step(hand.lean());
            const glm::dvec3& at = game.ball().position;
            const glm::ivec2 cell = cellAt(level, {at.x, at.z});
            if (game.fallen() || level.at(cell).tile != Tile::floor) continue;
            deepest = std::max(deepest, level.at(cell).height * level.step + kBallRadius - at.y);
        }
        EXPECT_LT(deepest, 0.001) << level.name;
    }
}

TEST(LabyrinthGame, SameSeedAndInputsGiveTheSameRunToTheBit) {
    for (const Level& level : bundledLevels()) {
        Game first(level, 11), second(level, 11), other(level, 12);
        RandomHand hand(5);
        bool differs = false;
        for (int frame = 0; frame < 600; ++frame) {
            const glm::dvec2 lean = hand.lean();
            const double seconds = 1.0 / (30.0 + frame % 60);
            for (Game* game : {&first, &second, &other}) game->advance(seconds, lean);
            ASSERT_TRUE(same(first.ball(), second.ball())) << level.name << ", frame " << frame;
            ASSERT_EQ(first.events(), second.events());
            differs = differs || !same(first.ball(), other.ball());
        }
        EXPECT_EQ(first.run(), second.run());
        EXPECT_EQ(first.score(), second.score());
        EXPECT_TRUE(differs) << "another seed is another run";
    }
}

/// Runs a pilot until the goal or its time is up.
Game piloted(const Level& level, std::uint64_t seed, bool collect, double seconds) {
    Game game(level, seed);
    Pilot pilot(level, collect);
    while (!game.done() && game.seconds() < seconds) game.step(pilot.lean(game.ball(), game.pickUps()));
    return game;
}

TEST(LabyrinthGame, EveryLevelIsSolvedInRealPhysics) {
    for (const Level& level : bundledLevels())
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            const Game game = piloted(level, seed, false, 120.0);
            EXPECT_TRUE(game.done()) << level.name << ", ball at " << game.ball().position.x << " "
                                     << game.ball().position.y << " " << game.ball().position.z;
            EXPECT_EQ(game.falls(), 0) << level.name;
            EXPECT_LT(game.seconds(), level.seconds) << level.name << ": its time can be met";
        }
}

TEST(LabyrinthGame, EveryPickUpCanBeFetchedOnTheWayToTheGoal) {
    for (const Level& level : bundledLevels()) {
        const Game game = piloted(level, 1, true, 240.0);
        EXPECT_TRUE(game.done()) << level.name << ", ball at " << game.ball().position.x << " "
                                 << game.ball().position.y << " " << game.ball().position.z;
        for (const glm::ivec2 left : game.pickUps())
            ADD_FAILURE() << level.name << ": the pick-up at " << left.x << " " << left.y << " is left";
        EXPECT_GE(game.score(), 100 * static_cast<int>(game.taken().size())) << level.name;
    }
}

TEST(LabyrinthGame, AFallTakesTheBallBackToTheLastSafePlace) {
    const Level level = withoutGoal("############\n#@.....O..X#\n############\n############\n############\n");
    Game game(level, 1);
    glm::dvec3 before{0.0};
    bool told = false;
    for (int frame = 0; frame < 600 && game.falls() == 0; ++frame) {
        game.advance(1.0 / 60.0, {0.1, 0.0});
        before = game.ball().position;
        for (const GameEvent& event : game.events()) told = told || event.kind == GameEvent::Kind::fall;
    }
    EXPECT_EQ(game.falls(), 1);
    EXPECT_TRUE(told);
    EXPECT_TRUE(game.fallen());
    EXPECT_NEAR(before.x, centreOf(level, {7, 1}).x, 0.006);
    for (int frame = 0; frame < 60; ++frame) game.advance(1.0 / 60.0, {0.0, 0.0});
    EXPECT_FALSE(game.fallen());
    EXPECT_EQ(cellAt(level, {game.ball().position.x, game.ball().position.z}), glm::ivec2(5, 1));
    EXPECT_NEAR(game.ball().position.y, kBallRadius, 2e-4);
}

// The slide's acceleration is g sin(lean); a ball that rolls keeps five sevenths of it.
TEST(LabyrinthGame, TheBallRollsAsASphereDoes) {
    const Level level = withoutGoal("#####################\n#@.................X#\n#####################\n"
                                    "#####################\n#####################\n");
    Game game(level, 1);
    for (int step = 0; step < 240; ++step) game.step({0.04, 0.0}); // the lean has settled
    const double before = game.ball().velocity.x;
    for (int step = 0; step < 120; ++step) game.step({0.04, 0.0});
    const double expected = 5.0 / 7.0 * Game::kGravity * std::sin(0.04);
    EXPECT_NEAR((game.ball().velocity.x - before) / 0.5, expected, 0.15 * expected) << "damping takes a little";
}

TEST(LabyrinthGame, EventsTellWhatHappens) {
    const Level level = withoutGoal("#########\n#r..@..X#\n#########\n#########\n#########\n");
    Game game(level, 1);
    double roll = 0.0, bump = 0.0;
    int pickUps = 0, goals = 0;
    for (int frame = 0; frame < 600 && !game.done(); ++frame) {
        game.advance(1.0 / 60.0, {frame < 40 ? -0.2 : 0.15, 0.0});
        for (const GameEvent& event : game.events()) {
            if (event.kind == GameEvent::Kind::roll) roll = std::max(roll, event.strength);
            if (event.kind == GameEvent::Kind::bump) bump = std::max(bump, event.strength);
            if (event.kind == GameEvent::Kind::pickUp) ++pickUps;
            if (event.kind == GameEvent::Kind::goal) ++goals;
        }
    }
    EXPECT_EQ(pickUps, 1);
    EXPECT_EQ(goals, 1);
    EXPECT_GT(roll, 0.05);
    EXPECT_GT(bump, 0.03) << "the wall behind the start";
    EXPECT_EQ(game.score(), 100 + static_cast<int>(10.0 * (60.0 - game.seconds())));
    const Ghost& run = game.run();
    EXPECT_NEAR(run.seconds, game.seconds(), 1e-12);
    EXPECT_NEAR(static_cast<double>(run.positions.size()) * Ghost::kInterval, run.seconds, 2.0 * Ghost::kInterval);
}

TEST(LabyrinthGhost, IsSavedAndReadAndFoundBetweenItsTimes) {
    const Ghost run = piloted(bundledLevels().front(), 1, false, 60.0).run();
    ASSERT_GT(run.positions.size(), 30U);
    const std::vector<Ghost> read = readGhosts(ghostsText({run}), "runs.json");
    ASSERT_EQ(read.size(), 1U);
    EXPECT_EQ(read.front(), run);
    const glm::vec3 between = 0.5F * (run.positions[10] + run.positions[11]);
    EXPECT_LT(glm::distance(positionAt(run, 10.5 * Ghost::kInterval), between), 1e-6F);
    EXPECT_EQ(positionAt(run, 1e6), run.positions.back());
    EXPECT_THROW((void)readGhosts("{}", "runs.json"), DataError);
    EXPECT_THROW((void)readGhosts("[", "runs.json"), DataError);
    EXPECT_THROW((void)readGhosts(R"({"labyrinthRuns":[{"level":"a","positions":[1,2]}]})", "runs.json"), DataError);
}

} // namespace
} // namespace lumorph::labyrinth
