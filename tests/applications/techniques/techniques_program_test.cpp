#include "app/applications/techniques/techniques_program.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/program_visit.h"

// Techniques of painting with light, as visitors meet them: with and without, by keys, by pointing, by themselves.

namespace lumorph::test {
namespace {

class TechniquesProgramTest : public ::testing::Test {
protected:
    void press(const std::string& key) { visit.frame({{key, 1.0}, {key, 0.0}}); }
    void expectShown(int key, bool on) {
        EXPECT_EQ(program.key(), key);
        EXPECT_EQ(program.on(), on) << key;
        EXPECT_TRUE(*visit.content().scene == techniqueScene(key, on)) << key;
    }

    TechniquesProgram program;
    ProgramVisit visit{program};
};

TEST_F(TechniquesProgramTest, ShowsEachWithoutAndWithWhileNobodyIsThere) {
    visit.frame();
    for (int key = 1; key <= 6; ++key) {
        visit.frames(TechniquesProgram::kWithout - 0.5);
        expectShown(key, false);
        visit.frames(1.0);
        expectShown(key, true);
        visit.frames(TechniquesProgram::kWith - 0.4); // a tenth of a second into the next
    }
    EXPECT_EQ(program.key(), 1) << "from the last to the first, but for the plain device, as which each begins";
}

TEST_F(TechniquesProgramTest, NumberKeysChooseAndOTakesAway) {
    for (int key = 0; key <= 6; ++key) {
        press("key." + std::to_string(key));
        expectShown(key, true);
        press("key.off");
        expectShown(key, false);
        press("key.off");
        expectShown(key, true);
    }
    press("key.next");
    expectShown(0, true);
    press("key.left");
    expectShown(6, true);
    visit.frame({{"pad.x", -0.9}});
    visit.frame({{"pad.x", -1.0}});
    expectShown(5, true); // one push, one step
    visit.frame({{"pad.x", 0.0}, {"pad.y", 0.8}});
    expectShown(5, false);
    visit.frame({{"pad.y", 0.0}});
    press("key.restart");
    expectShown(1, true);
    visit.frames(40.0);
    expectShown(1, true);
    visit.frames(8.0);
    EXPECT_FALSE(program.on()) << "left to itself again after 45 s";
}

TEST_F(TechniquesProgramTest, PointingOrLeaningToASideShowsItWithoutOrWith) {
    visit.frame({{"pointer.x", -0.8}});
    expectShown(1, false);
    visit.frame({{"pointer.x", 0.1}});
    expectShown(1, false); // the middle decides nothing
    visit.frame({{"pointer.x", 0.8}});
    expectShown(1, true);
    press("key.off");
    visit.frames(1.0);
    expectShown(1, false); // who rests there does not take it back
    visit.frame({{"pointer.over", 0.0}});
    visit.lean(0.0F, -0.2F); // the right side down
    visit.frame();
    EXPECT_FALSE(program.on()) << "to the same side as before";
    visit.lean(0.0F, 0.2F);
    visit.frame();
    visit.lean(0.0F, -0.2F);
    visit.frame();
    expectShown(1, true);
}

TEST_F(TechniquesProgramTest, WithoutItThereIsTheSameShapeAndAnotherScene) {
    for (int key = 1; key <= 6; ++key) {
        const Scene with = techniqueScene(key), without = techniqueScene(key, false);
        EXPECT_FALSE(with == without) << key;
        ASSERT_EQ(with.items.size(), without.items.size()) << key;
        for (std::size_t i = 0; i < with.items.size(); ++i) EXPECT_EQ(with.items[i].id, without.items[i].id) << key;
        EXPECT_EQ(*drivingItem(with), *drivingItem(without)) << key;
    }
    EXPECT_TRUE(techniqueScene(0) == techniqueScene(0, false));
}

TEST_F(TechniquesProgramTest, ServosFollowTheWaveOfTheAnimatedTexture) {
    press("key.2");
    visit.frames(1.5);
    const double seconds = 90.0 * kFrame; // of the last frame
    const auto& grid = std::get<HeightGrid>(visit.content().target);
    for (const double x : {-0.09, -0.03, 0.0, 0.05, 0.1})
        EXPECT_NEAR(heightAt(grid, {x, 0.02}),
                    0.034 + 0.014 * std::sin(2.0 * std::numbers::pi * (x / 0.30 - seconds / 7.0)), 2e-5)
            << x;
}

TEST_F(TechniquesProgramTest, SaysWhatIsSeenInBothLanguages) {
    for (int key = 0; key <= 6; ++key) {
        press("key." + std::to_string(key));
        const ShowCaption& caption = *visit.content().caption;
        EXPECT_EQ(caption.title.english.substr(0, 1), std::to_string(key));
        for (const Words& words : {caption.title, caption.sentence}) {
            EXPECT_FALSE(words.english.empty()) << key;
            EXPECT_FALSE(words.german.empty()) << key;
            EXPECT_NE(words.english, words.german) << key;
        }
    }
}

} // namespace
} // namespace lumorph::test
