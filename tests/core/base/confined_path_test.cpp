#include "core/base/confined_path.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "core/base/name_key.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::confined_path_test {
namespace {

namespace fs = std::filesystem;

// "Prüfung" and "Åse" with composed letters, as Windows and Linux write them, and with marks of their own, as macOS
// does.
const std::string kComposed = "Pr\u00FCfung";
const std::string kDecomposed = "Pru\u0308fung";

TEST(NameKey, IsOneForFormsAndCases) {
    const std::pair<std::string, std::string> same[] = {
        {kComposed, kDecomposed},
        {kComposed, "PR\u00DCFUNG"},
        {"\u00C5se", "A\u030Ase"},
        {"\u1EC7", "e\u0323\u0302"},      // Vietnamese: two marks
        {"\u01D6", "u\u0308\u0304"},      // decomposed twice
        {"\uAC01", "\u1100\u1161\u11A8"}, // Hangul with a tail
        {"\uD55C", "\u1112\u1161\u11AB"},
        {"\u304C", "\u304B\u3099"}, // kana
        {"\u0439", "\u0418\u0306"}, // Cyrillic, small and large
        {"\u00E6\u00F8\u0142", "\u00C6\u00D8\u0141"},
        {"\u03C9", "\u03A9"},
        {"\u212B", "\u00E5"}, // the sign of an angstrom is the letter
    };
    for (const auto& [one, other] : same) EXPECT_EQ(nameKey(one), nameKey(other)) << one << " " << other;
    const std::pair<std::string, std::string> different[] = {
        {"holz.png", "holz.jpg"}, {"Hohe", "H\u00F6he"}, {"\u00F6", "\u00FC"}, {"a", "aa"}, {"", " "},
        {"\xFF", "\xFE"}};
    for (const auto& [one, other] : different) EXPECT_NE(nameKey(one), nameKey(other)) << one << " " << other;
    EXPECT_EQ(nameKey("aZ"), U"az");
}

struct ConfinedPath : ::testing::Test {
    ConfinedPath() {
        fs::create_directories(root / kDecomposed);
        fs::create_directories(root / "textures");
        write(root / "textures/Holz.PNG");
        write(root / kDecomposed / "a.bin");
        write(own / "secret.bin");
    }
    static void write(const fs::path& file) { std::ofstream(file) << "x"; }
    /// Relative to the folder; "none" where it leads out.
    [[nodiscard]] std::string found(const std::string& name) const {
        const auto path = confinedPath(root, name);
        if (!path) return "none";
        return fs::exists(*path) ? path->lexically_relative(fs::canonical(root)).string() : "missing";
    }

    TemporaryFolder own;
    fs::path root = own / "model";
};

TEST_F(ConfinedPath, FindsNamesThatAnotherSystemWrote) {
    EXPECT_EQ(found("textures/Holz.PNG"), "textures/Holz.PNG");
    EXPECT_EQ(found("Textures/holz.png"), "textures/Holz.PNG");
    EXPECT_EQ(found("textures\\Holz.PNG"), "textures/Holz.PNG");
    EXPECT_EQ(found(".\\TEXTURES\\holz.png"), "textures/Holz.PNG");
    EXPECT_EQ(found(kComposed + "/a.bin"), kDecomposed + "/a.bin");
    EXPECT_EQ(found("PR\u00DCFUNG\\A.BIN"), kDecomposed + "/a.bin");
    EXPECT_EQ(found("textures/../textures/Holz.PNG"), "textures/Holz.PNG");
    EXPECT_EQ(found("nowhere/../textures/Holz.PNG"), "textures/Holz.PNG");
    EXPECT_EQ(found("textures/holz.jpg"), "missing");
}

TEST_F(ConfinedPath, TakesWhatIsCalledSoBeforeWhatIsLikeIt) {
    write(root / "textures/holz.png");
    EXPECT_EQ(found("textures/holz.png"), "textures/holz.png");
    EXPECT_EQ(found("textures/Holz.PNG"), "textures/Holz.PNG");
    EXPECT_EQ(found("textures/HOLZ.png"), "missing") << "two are like it, and none is it";
    write(root / "back\\slash.bin");
    EXPECT_EQ(found("back\\slash.bin"), "back\\slash.bin") << "a name that has one here";
}

TEST_F(ConfinedPath, LeadsNowhereElse) {
    fs::create_directory_symlink(own.path(), root / "up");
    for (const char* name :
         {"../secret.bin", "..\\secret.bin", "textures/../../secret.bin", "textures\\..\\..\\secret.bin", "/etc/passwd",
          "", ".", "textures/..", "up/secret.bin", "UP/secret.bin", "UP\\SECRET.bin", "textures/../up/secret.bin"})
        EXPECT_EQ(found(name), "none") << name;
    EXPECT_EQ(found(std::string("a\0b", 3)), "none");
    EXPECT_FALSE(staysInside("a/../../b"));
    EXPECT_TRUE(staysInside("a/../b"));
}

TEST_F(ConfinedPath, KnowsWhatLiesBesideUnderTheLastName) {
    write(root / "holz.png");
    EXPECT_EQ(sameNameIn(root, "C:\\Users\\ada\\textures\\holz.png"), "holz.png");
    EXPECT_EQ(sameNameIn(root, "/home/ada/HOLZ.png"), "holz.png");
    EXPECT_FALSE(sameNameIn(root, "stein.png"));
    EXPECT_FALSE(sameNameIn(root, "a/.."));
}

} // namespace
} // namespace lumorph::confined_path_test
