#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

std::filesystem::path tabletProject(const TemporaryFolder& folder) {
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    return file;
}

TEST(CalibrateLight, AppliesMeasuredLightToAProject) {
    const TemporaryFolder folder;
    const auto file = tabletProject(folder);
    const Outcome outcome = lumorph({"calibrate", "light", file.string(), "--seed", "4", "--apply", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_TRUE(json["findings"].empty());
    EXPECT_EQ(json["usable"], true);
    EXPECT_EQ(json["whiteSheet"], true);
    EXPECT_LT(json["fresh"]["median"], 0.01);
    EXPECT_GT(json["before"]["median"], json["fresh"]["median"]);
    ASSERT_EQ(json["projectors"].size(), 1U);
    EXPECT_EQ(json["projectors"][0]["curve"].size(), 65U);
    const Installation room = readProject(file).installation;
    EXPECT_EQ(room.projectors.front().responseCurve.size(), 65U);
    EXPECT_GT(room.projectors.front().black.g, 0.0F);
    EXPECT_EQ(room.projectors.front().response.way, Origin::Way::simulated);
    EXPECT_EQ(room.origins.colors.way, Origin::Way::simulated);
    EXPECT_NE(room.deviceColor, glm::vec3(1.0F));
    const Outcome again = lumorph({"calibrate", "light", file.string(), "--seed", "4", "--without-sheet"});
    ASSERT_EQ(again.exitCode, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("is taken to be white"));
    EXPECT_EQ(readProject(file).installation, room) << "without --apply";
}

TEST(CalibrateLight, NamesAFaultAndKeepsNothing) {
    const TemporaryFolder folder;
    const auto file = tabletProject(folder);
    const Installation before = readProject(file).installation;
    const Outcome outcome = lumorph({"calibrate", "light", file.string(), "--fault", "ambient", "--apply", "--json"});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(outcome.json()["refused"]["cause"], "ambient_changes");
    EXPECT_EQ(outcome.json()["applied"], false);
    EXPECT_THAT(outcome.err, HasSubstr("leave lamps and curtains"));
    EXPECT_EQ(readProject(file).installation, before);
}

TEST(CalibrateLight, RefusesWhatItCannotDo) {
    const Outcome unknown = lumorph({"calibrate", "light", "resource:projects/water.lumorph", "--fault", "tired"});
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_THAT(unknown.err, HasSubstr("saturated, dark, automatic, ambient, falling or unseen"));
    const Outcome bundled = lumorph({"calibrate", "light", "resource:projects/water.lumorph", "--apply"});
    EXPECT_EQ(bundled.exitCode, 2);
    EXPECT_THAT(bundled.err, HasSubstr("copy it first"));
}

} // namespace
} // namespace lumorph::test
