#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

TEST(CalibrateServos, AppliesMeasuredServosToAProject) {
    const TemporaryFolder folder;
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    const Outcome outcome = lumorph({"calibrate", "servos", file.string(), "--seed", "4", "--apply", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_TRUE(json["findings"].empty());
    EXPECT_LE(json["simulatedSeconds"], 180.0);
    EXPECT_GT(json["iou"]["after"], json["iou"]["before"]);
    ASSERT_EQ(json["servos"].size(), 6U);
    for (const auto& servo : json["servos"]) EXPECT_NEAR(servo["backlashDegrees"].get<double>(), 2.0, 0.3);
    const Installation room = readProject(file).installation;
    EXPECT_EQ(room.servos.size(), 6U);
    EXPECT_EQ(room.origins.servos.way, Origin::Way::simulated);
}

TEST(CalibrateServos, NamesAFaultAndKeepsNothing) {
    const TemporaryFolder folder;
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    const Outcome outcome = lumorph({"calibrate", "servos", file.string(), "--fault", "dead", "--apply", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    ASSERT_EQ(json["findings"].size(), 1U);
    EXPECT_EQ(json["findings"][0]["cause"], "servo_dead");
    EXPECT_EQ(json["applied"], false);
    EXPECT_TRUE(readProject(file).installation.servos.empty());
}

TEST(CalibrateServos, RefusesWhatItCannotDo) {
    const Outcome unknown =
        lumorph({"calibrate", "servos", "resource:projects/water.lumorph", "--fault", "tired", "--json"});
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_THAT(unknown.err, HasSubstr("swapped, reversed, dead or jammed"));
    const Outcome bundled = lumorph({"calibrate", "servos", "resource:projects/water.lumorph", "--apply"});
    EXPECT_EQ(bundled.exitCode, 2);
    EXPECT_THAT(bundled.err, HasSubstr("copy it first"));
}

} // namespace
} // namespace lumorph::test
