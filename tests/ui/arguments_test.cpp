#include "app/studio/shell/arguments.h"

#include <vector>

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

ParsedArguments parse(std::vector<const char*> words) {
    words.insert(words.begin(), "lumorph-studio");
    return parseArguments(static_cast<int>(words.size()), words.data());
}

TEST(Arguments, AreWhatWasAskedFor) {
    const auto parsed = parse({"vase.lumorph", "--workspace", "rig", "--kiosk"});
    ASSERT_TRUE(parsed.arguments.has_value()) << parsed.message;
    EXPECT_EQ(parsed.arguments->project, "vase.lumorph");
    EXPECT_EQ(parsed.arguments->workspace, "rig");
    EXPECT_TRUE(parsed.arguments->kiosk);
    EXPECT_FALSE(parsed.arguments->forgetPin);
    EXPECT_TRUE(parse({"--forget-pin"}).arguments->forgetPin);
    EXPECT_TRUE(parse({}).arguments->project.empty());
    for (const char* demo : {"water", "techniques", "field"}) EXPECT_EQ(parse({"--demo", demo}).arguments->demo, demo);
}

TEST(Arguments, OptionsOfQtAreLeftToIt) {
    const auto parsed = parse({"-platform", "offscreen", "vase.lumorph"});
    ASSERT_TRUE(parsed.arguments.has_value()) << parsed.message;
    EXPECT_EQ(parsed.arguments->project, "vase.lumorph");
}

TEST(Arguments, WrongUsageSaysWhatAndEndsWithTwo) {
    struct Row {
        std::vector<const char*> words;
        const char* says;
    };
    const Row rows[] = {
        {{"--demo", "juggling"}, "juggling"},
        {{"--demo"}, "--demo"},
        {{"--sparkle"}, "--sparkle"},
        {{"a.lumorph", "b.lumorph"}, "b.lumorph"},
        {{"a.lumorph", "--demo", "field"}, "a.lumorph"},
        {{"--kiosk", "--forget-pin"}, "--forget-pin"},
    };
    for (const Row& row : rows) {
        const auto parsed = parse(row.words);
        EXPECT_FALSE(parsed.arguments.has_value()) << row.says;
        EXPECT_EQ(parsed.status, 2);
        EXPECT_NE(parsed.message.find(row.says), std::string::npos) << parsed.message;
    }
    EXPECT_NE(parse({"--demo", "juggling"}).message.find("field"), std::string::npos) << "it names those there are";
}

TEST(Arguments, HelpAndVersionEndWithZero) {
    EXPECT_EQ(parse({"--version"}).status, 0);
    EXPECT_NE(parse({"--version"}).message.find(LUMORPH_VERSION), std::string::npos);
    EXPECT_NE(parse({"--help"}).message.find("--kiosk"), std::string::npos);
}

} // namespace
} // namespace lumorph::studio
