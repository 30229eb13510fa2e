#include "core/base/resources.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

TEST(Resources, TheBestPlaceThatHoldsThemWins) {
    const TemporaryFolder folder;
    const fs::path chosen = folder.path() / "chosen";
    const fs::path installed = folder.path() / "usr/share/lumorph";
    const fs::path source = folder.path() / "source";
    for (const fs::path& place : {chosen, installed, source}) fs::create_directories(place / "shaders");
    const fs::path bin = folder.path() / "usr/bin";
    const fs::path elsewhere = folder.path() / "build/bin";

    EXPECT_EQ(resourcesFolder({chosen, bin, source}), chosen);
    EXPECT_EQ(resourcesFolder({{}, bin, source}), installed);
    EXPECT_EQ(resourcesFolder({{}, elsewhere, source}), source);
}

TEST(Resources, AMissingFolderIsNamed) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "source/shaders");
    try {
        (void)resourcesFolder({folder.path() / "empty", {}, folder.path() / "source"});
        FAIL() << "a wrong choice was replaced silently";
    } catch (const DataError& error) {
        EXPECT_EQ(error.subject(), (folder.path() / "empty").string());
    }
    EXPECT_THROW((void)resourcesFolder({{}, folder.path() / "bin", {}}), DataError);
}

TEST(Resources, FindsTheShadersOfThisTree) {
    EXPECT_TRUE(fs::is_regular_file(resourceFile("shaders/surface.vert")));
    EXPECT_THROW((void)resourceFile("shaders/absent.vert"), DataError);
}

} // namespace
} // namespace lumorph
