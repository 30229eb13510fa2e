#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

// Stages on the command line: recorded, and solved from the recording; what a way lacks is said, and nothing falls back
// to the lab.

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::filesystem::path recordedProject(const TemporaryFolder& folder) {
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    return file;
}

TEST(CalibrateRecording, IsSolvedToWhatWasPrintedAndStaysSimulated) {
    const TemporaryFolder folder;
    const std::string file = recordedProject(folder).string(), kept = (folder / "delays-1").string();
    const Outcome lab = lumorph({"calibrate", "delays", file, "--lab", "--seed", "7", "--record", kept, "--json"});
    ASSERT_EQ(lab.exitCode, 0) << lab.err;
    const Outcome again = lumorph({"calibrate", "delays", file, "--from", kept, "--json"});
    ASSERT_EQ(again.exitCode, 0) << again.err;
    EXPECT_EQ(again.json(), lab.json());
    EXPECT_EQ(again.json()["way"], "simulated");
    const Outcome applied = lumorph({"calibrate", "delays", file, "--from", kept, "--apply"});
    ASSERT_EQ(applied.exitCode, 0) << applied.err;
    EXPECT_EQ(readProject(file).installation.origins.delays.way, Origin::Way::simulated);
    // A place that holds something is not written over.
    EXPECT_EQ(lumorph({"calibrate", "delays", file, "--record", kept}).exitCode, 2);
}

TEST(CalibrateRecording, OfTheLabDoesNotJoinWhatWasMeasuredUnlessThatIsSaid) {
    const TemporaryFolder folder;
    const auto file = recordedProject(folder);
    const std::string kept = (folder / "pointer-1").string();
    ASSERT_EQ(lumorph({"calibrate", "pointer", file.string(), "--seed", "3", "--record", kept}).exitCode, 0);
    Project project = readProject(file);
    project.installation.projectors.front().lens = {Origin::Way::measured, "structured light", "2026-11-20T10:00:00Z"};
    writeProject(project, file);
    const Outcome refused = lumorph({"calibrate", "pointer", file.string(), "--from", kept, "--apply"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.err, HasSubstr("add --simulated"));
    const Outcome applied = lumorph({"calibrate", "pointer", file.string(), "--from", kept, "--apply", "--simulated"});
    ASSERT_EQ(applied.exitCode, 0) << applied.err;
    EXPECT_EQ(readProject(file).installation.origins.pointer.way, Origin::Way::simulated);
    EXPECT_EQ(readProject(file).installation.projectors.front().lens.way, Origin::Way::measured);
}

TEST(CalibrateRecording, ATableWithoutACameraOrATrackerNamesIt) {
    const TemporaryFolder folder;
    const std::string file = recordedProject(folder).string();
    for (const char* stage : {"light", "delays", "servos", "verify"}) {
        const Outcome outcome = lumorph({"calibrate", stage, file, "--table", "--apply", "--json"});
        EXPECT_EQ(outcome.exitCode, 1) << stage;
        EXPECT_THAT(outcome.err, StartsWith("lumorph: camera: ")) << stage;
    }
    for (const char* stage : {"pointer", "tracker", "body", "eye"}) {
        const Outcome outcome = lumorph({"calibrate", stage, file, "--table"});
        EXPECT_EQ(outcome.exitCode, 1) << stage;
        EXPECT_THAT(outcome.err, StartsWith("lumorph: tracker: ")) << stage;
    }
    EXPECT_EQ(lumorph({"calibrate", "light", file, "--table", "--seed", "3"}).exitCode, 2);
    EXPECT_EQ(lumorph({"calibrate", "light", file, "--lab", "--from", "x"}).exitCode, 2);
}

TEST(CalibrateRecording, ThatIsNoneIsRefusedByItsName) {
    const TemporaryFolder folder;
    const std::string file = recordedProject(folder).string(), kept = (folder / "pointer-1").string();
    ASSERT_EQ(lumorph({"calibrate", "pointer", file, "--record", kept}).exitCode, 0);
    const Outcome foreign = lumorph({"calibrate", "eye", file, "--from", kept});
    EXPECT_EQ(foreign.exitCode, 1);
    EXPECT_THAT(foreign.err, HasSubstr("it is none of the stage eye"));
    EXPECT_THAT(lumorph({"calibrate", "pointer", file, "--from", folder.path().string()}).err,
                HasSubstr("recording.json"));
    std::filesystem::resize_file(std::filesystem::path(kept) / "poses.csv", 1000);
    const Outcome cut = lumorph({"calibrate", "pointer", file, "--from", kept});
    EXPECT_EQ(cut.exitCode, 1);
    EXPECT_THAT(cut.err, HasSubstr("poses.csv: it is cut short: 1000 of "));
}

} // namespace
} // namespace lumorph::test
