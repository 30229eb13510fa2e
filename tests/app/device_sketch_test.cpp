#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

std::string projectWithPoses(const std::string& steps) {
    return R"({"schemaVersion": 4, "rig": "resource:models/tablet.glb", "poses": {"actuators": ["edge front", "gone"],
        "named": [{"name": "up", "strokes": [1.0, 0.5]}, {"name": "down", "strokes": [0.0, 0.5]}], "steps": )" +
           steps + "}}";
}

TEST(DeviceSketch, IsWrittenWithThePosesOfAProject) {
    const TemporaryFolder folder;
    const std::string project = (folder / "a.lumorph").string();
    writeFile(
        project,
        projectWithPoses(
            R"([{"pose": "up", "travelSeconds": 3}, {"pose": "down", "travelSeconds": 0.1, "easing": "linear"}])"));
    const nlohmann::json checked = lumorph({"project", "check", project, "--json"}).json()["poses"];
    EXPECT_EQ(checked["count"], 2);
    EXPECT_EQ(checked["steps"], 2);
    EXPECT_EQ(checked["kept"], nlohmann::json({"gone"}));
    EXPECT_EQ(checked["atRest"].size(), 5U);
    const Outcome outcome =
        lumorph({"device", "sketch", project, "--button", "12", "-o", (folder / ".").string(), "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["steps"], 2);
    EXPECT_EQ(outcome.json()["button"], 12);
    EXPECT_EQ(outcome.json()["loop"], false);
    EXPECT_EQ(outcome.json()["notes"].size(), 2U) << "one way is too fast, one begins with a jerk";
    const std::string text = textOfFile(folder / "tablet/poses.h");
    EXPECT_THAT(text, HasSubstr("kPoseSteps = 2;"));
    EXPECT_THAT(text, HasSubstr("{1, kNaturally, 150, 0},")) << "three seconds in frames of 20 ms";
}

TEST(DeviceSketch, SaysWhatIsMissing) {
    const TemporaryFolder folder;
    const std::string project = (folder / "a.lumorph").string();
    writeFile(project, projectWithPoses("[]"));
    const Outcome none = lumorph({"device", "sketch", project, "--at-power-on", "-o", (folder / ".").string()});
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.err, HasSubstr("it has no sequence of poses"));
    writeFile(project, projectWithPoses(R"([{"pose": "up"}])"));
    const Outcome lamp = lumorph({"device", "sketch", project, "--button", "13", "-o", (folder / ".").string()});
    EXPECT_EQ(lamp.exitCode, 2);
    EXPECT_THAT(lamp.err, HasSubstr("pin 13"));
    EXPECT_EQ(lumorph({"device", "sketch", project, "-o", (folder / ".").string()}).exitCode, 2);
    EXPECT_EQ(lumorph({"device", "sketch", project, "--button", "12", "--at-power-on", "-o", "."}).exitCode, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "tablet"));
}

} // namespace
} // namespace lumorph::test
