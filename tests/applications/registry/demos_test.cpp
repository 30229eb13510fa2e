#include "app/applications/registry/demos.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/base/resources.h"
#include "tests/support/program_visit.h"

// What every demonstration has for its visitors, whichever there are.

namespace lumorph::test {
namespace {

TEST(Demos, HaveTitleAndSentenceInBothLanguagesAndAPicture) {
    std::set<std::string> titles;
    for (const Demo& demo : demos()) {
        for (const Words& words : {demo.title, demo.sentence}) {
            EXPECT_FALSE(words.english.empty()) << demo.name;
            EXPECT_FALSE(words.german.empty()) << demo.name;
        }
        EXPECT_LE(demo.title.in(Language::german).size(), 40U) << demo.name << ": it stands on a card";
        EXPECT_LE(demo.sentence.in(Language::german).size(), 140U) << demo.name;
        EXPECT_TRUE(titles.insert(demo.title.english).second) << demo.name;
        EXPECT_TRUE(std::filesystem::exists(resourceFile(demo.thumbnail))) << demo.name;
    }
}

TEST(Demos, WordsWithoutGermanAreEnglish) {
    EXPECT_EQ(Words("Ice").in(Language::german), "Ice");
    EXPECT_EQ(Words("Ice", "Eis").in(Language::german), "Eis");
    EXPECT_EQ(Words("Ice", "Eis").in(Language::english), "Ice");
}

/// Whether two runs of one application show, or let feel, something else.
bool differ(const ShowContent& one, const ShowContent& other) {
    if (one.scene && other.scene && !(*one.scene == *other.scene)) return true;
    const auto* a = std::get_if<HeightGrid>(&one.target);
    const auto* b = std::get_if<HeightGrid>(&other.target);
    return a != nullptr && b != nullptr && a->heights != b->heights;
}

// From the attract loop to the first play in two actions at most, by a mouse or by a hand that leans the device.
TEST(Demos, ThatPlayAnswerTwoMovesOfAMouseAndOfAHand) {
    for (const Demo& demo : demos()) {
        if (!demo.program) continue;
        const auto begin = [&demo] { return demo.program({.seed = 3}, {}); };
        const auto alone = begin(), pointed = begin(), leant = begin();
        ProgramVisit nobody(*alone), mouse(*pointed), hand(*leant);
        for (ProgramVisit* visit : {&nobody, &mouse, &hand}) visit->frames(2.0);
        EXPECT_FALSE(differ(nobody.content(), mouse.content())) << demo.name << " is the same show by itself";
        for (const double side : {-1.0, 1.0}) {
            mouse.frame({{"pointer.x", 0.9 * side}, {"pointer.y", 0.4}});
            hand.lean(0.1F, static_cast<float>(-0.2 * side));
            nobody.frame();
            hand.frame();
            for (ProgramVisit* visit : {&nobody, &mouse, &hand}) visit->frames(0.3);
        }
        EXPECT_TRUE(differ(nobody.content(), mouse.content())) << demo.name << " and a mouse";
        EXPECT_TRUE(differ(nobody.content(), hand.content())) << demo.name << " and a hand";
    }
}

} // namespace
} // namespace lumorph::test
