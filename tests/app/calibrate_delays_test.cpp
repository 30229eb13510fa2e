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

std::filesystem::path tabletProject(const TemporaryFolder& folder) {
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    return file;
}

TEST(CalibrateDelays, AppliesMeasuredDelaysToAProject) {
    const TemporaryFolder folder;
    const auto file = tabletProject(folder);
    const Outcome outcome = lumorph({"calibrate", "delays", file.string(), "--seed", "4", "--apply", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["applied"], true);
    EXPECT_TRUE(json["warnings"].empty());
    ASSERT_EQ(json["servos"].size(), 6U);
    EXPECT_LE(json["slip"]["with"]["rmsMm"].get<double>(), 0.5 * json["slip"]["without"]["rmsMm"].get<double>());
    // Two ways to the same: by flashes and a board, and by a mark that follows a hand.
    EXPECT_NEAR(json["movedMark"]["ms"].get<double>(),
                json["light"]["ms"].get<double>() + json["tracker"]["ms"].get<double>(), 3.0);
    const Installation room = readProject(file).installation;
    EXPECT_EQ(room.origins.delays.way, Origin::Way::simulated);
    EXPECT_NEAR(room.predictionSeconds, 1e-3 * json["light"]["ms"].get<double>(), 1e-9);
    EXPECT_NEAR(room.trackerSeconds, 1e-3 * json["tracker"]["ms"].get<double>(), 1e-9);
    ASSERT_EQ(room.servos.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_TRUE(room.servos[k].points.empty());
        EXPECT_NEAR(room.servos[k].lagSeconds, 1e-3 * json["servos"][k]["ms"].get<double>(), 1e-9);
    }
}

TEST(CalibrateDelays, NamesAFaultAndKeepsNothing) {
    const TemporaryFolder folder;
    const auto file = tabletProject(folder);
    const Outcome outcome = lumorph({"calibrate", "delays", file.string(), "--fault", "covered", "--apply", "--json"});
    EXPECT_NE(outcome.exitCode, 0);
    EXPECT_EQ(outcome.json()["refused"]["cause"], "flash_not_seen");
    EXPECT_EQ(readProject(file).installation.origins.delays.way, Origin::Way::assumed);
}

TEST(CalibrateDelays, RefusesWhatItCannotDo) {
    const Outcome unknown =
        lumorph({"calibrate", "delays", "resource:projects/water.lumorph", "--fault", "tired", "--json"});
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_THAT(unknown.err, HasSubstr("dead or jammed"));
    const Outcome bundled = lumorph({"calibrate", "delays", "resource:projects/water.lumorph", "--apply"});
    EXPECT_EQ(bundled.exitCode, 2);
    EXPECT_THAT(bundled.err, HasSubstr("copy it first"));
}

} // namespace
} // namespace lumorph::test
