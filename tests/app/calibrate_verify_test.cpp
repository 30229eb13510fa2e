#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/support/cut_tablet.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

/// A project with the cut tablet, its projector of few pixels.
std::string verifyProject(const TemporaryFolder& folder) {
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    CalibratedCamera& lamp = project.installation.projectors.front().camera;
    const double smaller = 0.5;
    lamp.size = {960, 540};
    lamp.focal *= smaller;
    lamp.principal = smaller * (lamp.principal + 0.5) - 0.5;
    const std::string file = (folder.path() / "room.lumorph").string();
    writeProject(project, file);
    return file;
}

TEST(CalibrateVerify, SaysWhatMovedAndKeepsTheCorrectionInTheProject) {
    const TemporaryFolder folder;
    const std::string file = verifyProject(folder);
    const Installation before = readProject(file).installation;
    const std::string picture = (folder.path() / "map.png").string();
    const std::vector<std::string> moved{"calibrate", "verify",         file,     "--moved", "projector:3mm",
                                         "--pattern", "phase:16x3+1x3", "--json", "--seed",  "4"};
    std::vector<std::string> applied = moved;
    applied.insert(applied.end(), {"--apply", "--picture", picture});
    const Outcome outcome = lumorph(applied);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json found = outcome.json();
    std::printf("%s\n", found["sentence"].get<std::string>().c_str());
    EXPECT_EQ(found["verdict"], "moved");
    EXPECT_EQ(found["part"], "projector");
    EXPECT_NEAR(found["millimetres"], 3.0, 0.4);
    EXPECT_NEAR(found["map"]["median"], 3.0, 0.5);
    EXPECT_LT(found["corrected"]["median"], 0.2);
    EXPECT_LT(found["fresh"]["median"], 0.2);
    EXPECT_THAT(found["sentence"], HasSubstr("The projector has moved by"));
    EXPECT_TRUE(std::filesystem::exists(picture));

    const Installation after = readProject(file).installation;
    EXPECT_NE(after.projectors.front().camera.cameraFromWorld, before.projectors.front().camera.cameraFromWorld);
    EXPECT_EQ(after.projectors.front().pose.way, Origin::Way::simulated);
    EXPECT_FALSE(after.projectors.front().pose.date.empty());
    Installation rest = after;
    rest.projectors = before.projectors;
    EXPECT_TRUE(isSameRoom(rest, before)) << "nothing else is touched";
}

TEST(CalibrateVerify, SaysStillGoodWhereNothingMoved) {
    const TemporaryFolder folder;
    const std::string file = verifyProject(folder);
    const std::string text = textOfFile(file);
    const Outcome outcome = lumorph({"calibrate", "verify", file, "--pattern", "phase:16x3+1x3", "--apply", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["verdict"], "good");
    EXPECT_TRUE(outcome.json()["part"].is_null());
    EXPECT_EQ(textOfFile(file), text) << "what is right is not rewritten";
}

TEST(CalibrateVerify, RefusesWhatIsNoPartAndNoDistance) {
    const TemporaryFolder folder;
    const std::string file = verifyProject(folder);
    for (const char* moved : {"table:3mm", "projector", "projector:3", "projector:900mm", "camera:nanmm"}) {
        const Outcome outcome = lumorph({"calibrate", "verify", file, "--moved", moved});
        EXPECT_NE(outcome.exitCode, 0) << moved;
        EXPECT_THAT(outcome.err, HasSubstr(std::string("--moved ") + moved));
    }
    EXPECT_NE(lumorph({"calibrate", "verify", "resource:projects/water.lumorph", "--apply"}).exitCode, 0);
}

} // namespace
} // namespace lumorph::test
