#include <filesystem>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/lab/board_lab.h"
#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

// The whole calibration on the command line: how it stands, all that is missing in turn, and again from what was
// recorded.

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

/// How a stage stands, and what comes next, as it was printed.
std::string howOf(const nlohmann::json& printed, const std::string& key) {
    for (const nlohmann::json& stage : printed["stages"])
        if (stage["stage"] == key) return stage["how"];
    return "no such stage";
}

std::string smallProject(const TemporaryFolder& folder, const char* name) {
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    CalibratedCamera& lamp = project.installation.projectors.front().camera;
    lamp = withSize(lamp, {480, 270});
    writeProject(project, folder / name);
    return (folder / name).string();
}

TEST(CalibrateAll, StatusSaysHowEachStageStandsAndWhatIsNext) {
    const Outcome outcome = lumorph({"calibrate", "status", "resource:projects/water.lumorph", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json printed = outcome.json();
    EXPECT_EQ(printed["stages"].size(), 12U);
    EXPECT_EQ(howOf(printed, "projector"), "open");
    EXPECT_EQ(howOf(printed, "light"), "waits");
    EXPECT_EQ(howOf(printed, "mirror"), "spare");
    EXPECT_EQ(printed["stages"][2]["other"], "projector");
    EXPECT_EQ(printed["next"]["stage"], "projector");
    EXPECT_EQ(printed["next"]["why"], "it was not measured yet");
    const Outcome text = lumorph({"calibrate", "status", "resource:projects/water.lumorph"});
    EXPECT_THAT(text.out, HasSubstr("after projector and camera"));
    EXPECT_THAT(text.out, HasSubstr("next: projector, it was not measured yet\n"));
    EXPECT_EQ(lumorph({"calibrate", "all", "resource:projects/water.lumorph", "--apply"}).exitCode, 2);
}

TEST(CalibrateAll, IsMeasuredInTheLabAndSolvedAgainToTheSameFigures) {
    const TemporaryFolder folder;
    const std::string file = smallProject(folder, "lab.lumorph"), kept = (folder / "kept").string();
    const Outcome lab =
        lumorph({"calibrate", "all", file, "--lab", "--seed", "7", "--record", kept, "--apply", "--json"});
    ASSERT_EQ(lab.exitCode, 0) << lab.err;
    const nlohmann::json printed = lab.json();
    EXPECT_TRUE(printed["ended"].is_null());
    EXPECT_TRUE(printed["next"].is_null());
    ASSERT_EQ(printed["measured"].size(), 9U);
    EXPECT_EQ(printed["measured"][0]["stage"], "room") << "in the place of the sequence";
    for (const nlohmann::json& stage : printed["stages"]) {
        const bool isOther = stage["stage"] == "room" || stage["stage"] == "mirror" || stage["stage"] == "device";
        EXPECT_EQ(stage["how"], isOther ? "spare" : "simulated") << stage["stage"];
    }
    const Installation room = readProject(file).installation;
    EXPECT_TRUE(realParts(room).empty());
    EXPECT_FALSE(room.servos.empty());
    EXPECT_GT(glm::length(room.pointerTip), 0.1F);
    const Outcome status = lumorph({"calibrate", "status", file, "--json"});
    EXPECT_EQ(status.json()["next"]["stage"], "verify") << "a room holds no check";
    // Again from what was recorded. Where that is missing it ends, says where, and keeps those before.
    const std::string again = smallProject(folder, "again.lumorph");
    std::filesystem::rename(folder / "kept" / "tracker", folder / "elsewhere");
    const Outcome ended = lumorph({"calibrate", "all", again, "--from", kept, "--apply", "--json"});
    EXPECT_EQ(ended.exitCode, 1);
    EXPECT_THAT(ended.err, HasSubstr("stage tracker: "));
    EXPECT_THAT(ended.err, HasSubstr("recording.json"));
    EXPECT_EQ(ended.json()["ended"]["stage"], "tracker");
    EXPECT_EQ(ended.json()["next"]["stage"], "tracker");
    EXPECT_EQ(howOf(ended.json(), "pointer"), "simulated");
    EXPECT_EQ(readProject(again).installation.pointerTip, room.pointerTip);
    std::filesystem::rename(folder / "elsewhere", folder / "kept" / "tracker");
    const Outcome rest = lumorph({"calibrate", "all", again, "--from", kept, "--apply", "--json"});
    ASSERT_EQ(rest.exitCode, 0) << rest.err;
    const nlohmann::json later = rest.json();
    nlohmann::json solved = ended.json()["measured"];
    for (const nlohmann::json& stage : later["measured"]) solved.push_back(stage);
    EXPECT_TRUE(solved == printed["measured"]) << "not the same figures"; // too long to be printed
    EXPECT_EQ(figuresOf(readProject(again).installation), figuresOf(room));
}

TEST(CalibrateAll, ARoomThatHoldsSomethingMeasuredIsLeftAlone) {
    const TemporaryFolder folder;
    const std::string file = smallProject(folder, "measured.lumorph");
    Project project = readProject(file);
    project.installation.projectors.front().lens = {Origin::Way::measured, "structured light", "2026-11-20T10:00:00Z"};
    writeProject(project, file);
    const Outcome refused = lumorph({"calibrate", "all", file, "--lab", "--apply"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.err, HasSubstr("add --simulated"));
    EXPECT_EQ(lumorph({"calibrate", "status", file, "--json"}).json()["next"]["stage"], "light");
    EXPECT_EQ(lumorph({"calibrate", "all", file, "--lab", "--from", "x"}).exitCode, 2);
}

} // namespace
} // namespace lumorph::test
