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
using ::testing::Not;

constexpr auto kProcam = "cameraMatrix1: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\n"
                         "distCoeffs1: [-0.31, 0.12, 0.001, -0.0005, 0]\nimage_size: [1280, 960]\n"
                         "cameraMatrix2: [1700, 0, 960, 0, 1700, 900, 0, 0, 1]\nprojector_size: [1920, 1080]\n"
                         "R: [0, 0.1, 0]\nT: [-0.21, 0.012, 0.035]\nmetres_per_unit: 1\n";

TEST(CalibrateImport, PrintsMillimetresAndWhatIsUnknown) {
    const TemporaryFolder folder;
    const std::string file = (folder / "procam.yml").string();
    std::ofstream(file) << kProcam;
    const Outcome json = lumorph({"calibrate", "import", file, "--json", "--export", (folder / "out.json").string()});
    ASSERT_EQ(json.exitCode, 0) << json.err;
    const nlohmann::json result = json.json();
    EXPECT_NEAR(result["T"][0], -210.0, 1e-9);
    EXPECT_EQ(result["projector"]["K"][0][0], 1700.0);
    for (const char* key : {"rms", "sigma"}) EXPECT_TRUE(result["camera"][key].is_null()) << key;
    EXPECT_TRUE(result["lightWithinMillimetres"].is_null());
    EXPECT_TRUE(result["room"].is_null()) << "no pose of a board";
    const Outcome text = lumorph({"calibrate", "import", (folder / "out.json").string()});
    ASSERT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("RMS unknown"));
    EXPECT_THAT(text.out, HasSubstr("(-210.00, 12.00, 35.00) mm"));
    EXPECT_THAT(text.out, Not(HasSubstr("+-")));
}

TEST(CalibrateImport, RefusesAFisheyeByItsKey) {
    const TemporaryFolder folder;
    const std::string file = (folder / "ros.yaml").string();
    std::ofstream(file) << "width: 1280\nheight: 960\ndistortion_model: equidistant\nd: [-0.01, 0.004, 0.002, 0.001]\n"
                           "k: [1180.5, 0, 642.25, 0, 1181, 478.75, 0, 0, 1]\n";
    const Outcome outcome = lumorph({"calibrate", "import", file, "--json"});
    EXPECT_NE(outcome.exitCode, 0);
    EXPECT_EQ(outcome.json()["refused"]["cause"], "lens_model");
    EXPECT_THAT(outcome.err, HasSubstr("'equidistant'"));
}

TEST(CalibrateImport, AppliesLensesToAProject) {
    const TemporaryFolder folder;
    const std::string file = (folder / "procam.yml").string(), project = (folder / "room.lumorph").string();
    std::ofstream(file) << kProcam;
    const Outcome nowhere = lumorph({"calibrate", "import", file, "--apply"});
    EXPECT_NE(nowhere.exitCode, 0);
    EXPECT_THAT(nowhere.err, HasSubstr("--project"));
    Project begun;
    begun.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(begun, project);
    const Outcome applied = lumorph({"calibrate", "import", file, "--project", project, "--apply", "--json"});
    ASSERT_EQ(applied.exitCode, 0) << applied.err;
    EXPECT_EQ(applied.json()["applied"], true);
    const InstalledProjector projector = readProject(project).installation.projectors.front();
    EXPECT_EQ(projector.lens.method, "read from a file");
    EXPECT_EQ(projector.camera.focal.x, 1700.0);
    EXPECT_EQ(projector.camera.cameraFromWorld, Project().installation.projectors.front().camera.cameraFromWorld);
}

} // namespace
} // namespace lumorph::test
