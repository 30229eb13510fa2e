#include "app/applications/program_start.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "app/applications/labyrinth/labyrinth.h"
#include "app/applications/registry/demos.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/program_visit.h"

// What applications want kept: best runs of the labyrinth come back at the next start, and nothing is lost.

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using labyrinth::Ghost;
using labyrinth::LabyrinthProgram;

std::string textOf(const fs::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// What the program wants kept once a hand has brought the ball to the first goal.
std::string keptOfARun(ShowProgram& program) {
    auto& game = dynamic_cast<LabyrinthProgram&>(program);
    test::ProgramVisit visit(program);
    labyrinth::Pilot hand(labyrinth::bundledLevels().front(), false);
    visit.frame({{"key.restart", 1.0}});
    int told = 0;
    std::string kept;
    for (int k = 0; k < 60 * 60 && !game.game().done(); ++k) {
        const glm::dvec2 lean = hand.lean(game.game().ball(), {}) / labyrinth::Game::kMostLean;
        visit.frame({{"pointer.x", lean.x}, {"pointer.y", lean.y}});
        if (!visit.content().keepsake) continue;
        ++told;
        kept = visit.content().keepsake();
    }
    EXPECT_TRUE(game.game().done());
    EXPECT_EQ(told, 1) << "in the frame in which it has changed";
    visit.frame();
    EXPECT_FALSE(visit.content().keepsake);
    return kept;
}

TEST(Keepsake, ABestRunIsThereAtTheNextStart) {
    const TemporaryFolder folder;
    const fs::path file = folder / "kept/labyrinth.json";
    const Demo& demo = demoNamed("labyrinth");
    const BegunProgram first = beginProgram(demo, {.seed = 1, .kept = file});
    EXPECT_TRUE(first.problem.empty()) << "there is nothing yet";
    writeKeepsake(file, keptOfARun(*first.program));
    const BegunProgram second = beginProgram(demo, {.seed = 2, .kept = file});
    EXPECT_TRUE(second.problem.empty()) << second.problem;
    const auto& before = dynamic_cast<LabyrinthProgram&>(*first.program);
    const auto& after = dynamic_cast<LabyrinthProgram&>(*second.program);
    ASSERT_EQ(after.bestRuns().size(), 1U);
    EXPECT_EQ(after.bestRuns(), before.bestRuns()) << "to the bit";
    test::ProgramVisit visit(*second.program);
    visit.frame({{"key.restart", 1.0}});
    visit.frames(1.0);
    EXPECT_TRUE(visit.item(labyrinth::kGhostItem).visible) << "and goes beside the visitor";
}

TEST(Keepsake, WithoutAFileNothingIsRemembered) {
    const BegunProgram begun = beginProgram(demoNamed("labyrinth"), {.seed = 1});
    EXPECT_TRUE(begun.problem.empty());
    EXPECT_TRUE(dynamic_cast<LabyrinthProgram&>(*begun.program).bestRuns().empty());
}

TEST(Keepsake, ADamagedFileIsNamedAndSetAsideAndNotLost) {
    const TemporaryFolder folder;
    const fs::path file = folder / "labyrinth.json";
    const std::string damaged[] = {"", "{\"labyrinthRuns\":[{\"lev", std::string("\0\xff\xfe", 3),
                                   R"({"labyrinthRuns":[{"level":"a","positions":[1e9,0,0]}]})"};
    for (const std::string& text : damaged) {
        std::ofstream(file) << text;
        const BegunProgram begun = beginProgram(demoNamed("labyrinth"), {.seed = 1, .kept = file});
        ASSERT_TRUE(begun.program) << "it begins anew";
        EXPECT_FALSE(begun.problem.empty());
        EXPECT_FALSE(fs::exists(file));
        EXPECT_EQ(begun.aside.parent_path(), file.parent_path());
        EXPECT_EQ(textOf(begun.aside), text);
        EXPECT_TRUE(dynamic_cast<LabyrinthProgram&>(*begun.program).bestRuns().empty());
    }
    for (int number = 1; number <= 4; ++number)
        EXPECT_TRUE(fs::exists(folder / ("labyrinth.damaged-" + std::to_string(number) + ".json"))) << number;
}

TEST(Keepsake, AFolderThatMayNotBeMadeIsNamed) {
    const TemporaryFolder folder;
    std::ofstream(folder / "taken") << "a file";
    EXPECT_THROW(writeKeepsake(folder / "taken/labyrinth.json", "{}"), DeviceError);
}

} // namespace
} // namespace lumorph
