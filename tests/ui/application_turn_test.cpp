#include "app/studio/shell/application_turn.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/temporary_folder.h"

// Whose turn it is before a kiosk: never the same failure again and again, and none forgotten.

namespace lumorph::test {
namespace {

using studio::ApplicationTurn;

std::unique_ptr<ShowProgram> noProgram(const ProgramStart&, const Progress&) { return nullptr; }

class Turn : public ::testing::Test {
protected:
    static Demo named(const std::string& name, bool answers = true) {
        Demo demo;
        demo.name = name;
        if (answers) demo.program = noProgram;
        demo.options = {{"map", "", {}, {}, true}, {"goto", "", {}, {}, false}};
        return demo;
    }
    /// Names of those whose turn it is, one after the other.
    std::string order(const std::string& from, int count) {
        std::string names, name = from;
        for (int k = 0; k < count; ++k) {
            const Demo* next = turn.after(name);
            name = next != nullptr ? next->name : "-";
            names += name;
        }
        return names;
    }

    TemporaryFolder folder;
    ManualClock clock;
    std::vector<Demo> all{named("a"), named("b"), named("x", false), named("c")};
    std::map<std::string, DemoTold> told;
    ApplicationTurn turn{all, [this](const Demo& demo) { return told[demo.name]; }, clock};
};

TEST_F(Turn, GoesRoundAmongThoseThatAnswer) {
    EXPECT_EQ(order("a", 4), "bcab");
    EXPECT_EQ(order("nothing", 1), "a");
    EXPECT_EQ(order("x", 1), "a");
}

TEST_F(Turn, LeavesOutWhatFailedForAWhile) {
    turn.failed(all[1]);
    EXPECT_EQ(order("a", 4), "caca");
    EXPECT_TRUE(turn.leavesOut(all[1]));
    clock.advance(ApplicationTurn::kLeftOut - Microseconds(1));
    EXPECT_EQ(order("a", 1), "c");
    clock.advance(Microseconds(1));
    EXPECT_EQ(order("a", 2), "bc");
    turn.failed(all[1]);
    EXPECT_EQ(order("a", 1), "c") << "each failure counts anew";
    turn.shown(all[1]);
    EXPECT_EQ(order("a", 1), "b");
}

TEST_F(Turn, IsNobodysWhereAllHaveFailed) {
    for (const int k : {0, 1, 3}) turn.failed(all[static_cast<std::size_t>(k)]);
    EXPECT_EQ(turn.after("a"), nullptr);
    EXPECT_EQ(turn.after(""), nullptr);
    clock.advance(ApplicationTurn::kLeftOut);
    EXPECT_EQ(order("", 1), "a");
}

TEST_F(Turn, IsThatOfTheOnlyOneThatIsLeft) {
    turn.failed(all[0]);
    turn.failed(all[1]);
    EXPECT_EQ(order("c", 2), "cc");
}

TEST_F(Turn, ComesBackWithItsFile) {
    const std::filesystem::path map = folder / "map.tif";
    told["b"] = {{"map", map.string()}, {"goto", "church"}};
    turn.failed(all[1]);
    EXPECT_TRUE(turn.leavesOut(all[1]));
    std::ofstream(map) << "half";
    EXPECT_FALSE(turn.leavesOut(all[1])) << "it is there";
    turn.failed(all[1]);
    EXPECT_TRUE(turn.leavesOut(all[1])) << "it cannot be read as it is";
    std::ofstream(map, std::ios::app) << " and whole";
    EXPECT_FALSE(turn.leavesOut(all[1])) << "it is another";
    turn.failed(all[1]);
    std::filesystem::remove(map);
    EXPECT_FALSE(turn.leavesOut(all[1]));
}

TEST_F(Turn, ComesBackWhenItIsToldSomethingElse) {
    told["b"] = {{"map", "gone.tif"}};
    turn.failed(all[1]);
    EXPECT_TRUE(turn.leavesOut(all[1]));
    told["b"].clear();
    EXPECT_FALSE(turn.leavesOut(all[1]));
}

} // namespace
} // namespace lumorph::test
