#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/mesh_writers.h"
#include "core/geometry/model.h"
#include "core/voxels/nrrd.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

std::vector<std::string> keysOf(const nlohmann::json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

/// The outcome of a command that must succeed and say nothing on stderr.
Outcome succeed(const std::vector<std::string>& arguments, const std::string& input = {}) {
    Outcome outcome = lumorph(arguments, input);
    EXPECT_EQ(outcome.exitCode, 0) << ::testing::PrintToString(arguments);
    EXPECT_EQ(outcome.err, "") << ::testing::PrintToString(arguments);
    return outcome;
}

class CommandLine : public ::testing::Test {
protected:
    SmallWorkspace w;
};

TEST_F(CommandLine, HelpAndVersionAreNoErrors) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"match", "--help"}})
        EXPECT_THAT(succeed(arguments).out, HasSubstr("Usage"));
    EXPECT_THAT(succeed({"--version"}).out, ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CommandLine, RigInfoTellsActuatorsRangesAndMesh) {
    const nlohmann::json info = succeed({"rig", "info", w["rig.glb"], "--states", "5", "--json"}).json();
    EXPECT_THAT(keysOf(info), ElementsAre("actuators", "check", "mesh", "name", "reach", "shape", "warnings"));
    ASSERT_EQ(info["actuators"].size(), 3U);
    const nlohmann::json& lift = info["actuators"][1];
    EXPECT_EQ(lift["name"], "lift 1");
    EXPECT_EQ(lift["deformer"], "slide");
    EXPECT_EQ(lift["unit"], "m");
    EXPECT_NEAR(lift["range"][1].get<double>(), 0.0262, 1e-6);
    EXPECT_TRUE(info["mesh"]["closed"].get<bool>());
    EXPECT_EQ(info["shape"]["sampledStates"], 5);
    EXPECT_THAT(succeed({"rig", "info", w["rig.glb"], "--states", "5"}).out, HasSubstr("lift 1"));
}

TEST_F(CommandLine, RigDeformWritesTheMovedMesh) {
    const std::string text =
        succeed({"rig", "deform", w["rig.glb"], "--state", "0,4,0", "--levels", "5", "-o", "-"}).out;
    for (const char* name : {"moved.obj", "moved.stl", "moved.glb"})
        succeed({"rig", "deform", w["rig.glb"], "--state", "0,4,0", "--levels", "5", "-o", w[name]});
    EXPECT_EQ(textOfFile(w["moved.obj"]), text);
    const Box rest = boundingBox(flatten(readModel(w["rig.glb"])).positions);
    for (const char* name : {"moved.obj", "moved.stl", "moved.glb"}) {
        const Box moved = boundingBox(readMesh(w[name]).positions);
        EXPECT_EQ(moved.min, rest.min) << name;
        EXPECT_NEAR(moved.max.y - rest.max.y, 0.0262F, 0.001F) << name;
    }
}

TEST_F(CommandLine, MdfBuildIsTheSameForEverySeedOutputAndThreadCount) {
    const std::vector<std::string> build{"mdf",      "build", w["rig.glb"], "--resolution", "17",
                                         "--levels", "5",     "--samples",  "32",           "-o"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), build.begin(), build.end());
        return more;
    };
    succeed(with({w["a.mdf"], "--seed", "7", "--threads", "1"}));
    succeed(with({w["b.mdf"], "--seed", "7", "--threads", "3"}));
    succeed(with({w["c.mdf"], "--seed", "8"}));
    const std::string piped = succeed(with({"-", "--seed", "7"})).out;
    EXPECT_TRUE(textOfFile(w["a.mdf"]) == textOfFile(w["b.mdf"]));
    EXPECT_TRUE(textOfFile(w["a.mdf"]) == piped);
    EXPECT_FALSE(textOfFile(w["a.mdf"]) == textOfFile(w["c.mdf"]));
}

TEST_F(CommandLine, MdfInfoTellsWhatTheFieldHolds) {
    const nlohmann::json built =
        succeed({"mdf", "build", w["rig.glb"], "-o", w["x.mdf"], "--resolution", "17", "--levels", "5", "--json"})
            .json();
    nlohmann::json info = succeed({"mdf", "info", w["x.mdf"], "--json"}).json();
    EXPECT_THAT(keysOf(info),
                IsSupersetOf({"dims", "origin", "voxelSize", "levels", "actuators", "reachable", "bytes"}));
    EXPECT_EQ(info["levels"], 5);
    EXPECT_THAT(info["actuators"], ElementsAre("lift 0", "lift 1", "lift 2"));
    EXPECT_EQ(*std::ranges::min_element(info["dims"]), 17);
    EXPECT_EQ(info["bytes"], std::filesystem::file_size(w["x.mdf"]));
    EXPECT_GT(info["reachable"].get<int>(), 0);
    EXPECT_EQ(info, succeed({"mdf", "info", "-", "--json"}, textOfFile(w["x.mdf"])).json());
    EXPECT_GT(built["seconds"].get<double>(), 0.0);
    info["seconds"] = built["seconds"];
    EXPECT_EQ(info, built);
    EXPECT_THAT(succeed({"mdf", "info", w["x.mdf"]}).out, HasSubstr("3 actuators with 5 levels"));
}

TEST_F(CommandLine, MdfReachTellsWhatOnlyTwoActuatorsReachTogether) {
    const nlohmann::json reach = succeed({"mdf", "reach", w["field.mdf"], "--json", "-o", w["together.nrrd"]}).json();
    // All three lift the same top, and two together lift it higher than one.
    EXPECT_GT(reach["alone"].get<int>(), 0);
    EXPECT_GT(reach["together"].get<int>(), 0);
    const ByteGrid grid = parseNrrd(readFile(w["together.nrrd"], std::size_t{1} << 30), "together.nrrd");
    EXPECT_EQ(reach["together"].get<std::ptrdiff_t>(), std::ranges::count(grid.values, 1));
    ASSERT_GT(reach["pairs"].size(), 0U);
    EXPECT_LE(reach["pairs"].size(), 3U);
    EXPECT_LE(reach["pairs"][0]["voxels"], reach["together"]);
    EXPECT_THAT(succeed({"mdf", "reach", w["field.mdf"]}).out,
                HasSubstr("reach " + reach["together"].dump() + " more"));
}

TEST_F(CommandLine, MdfExportWritesOneGridForEachPart) {
    succeed({"mdf", "export", w["field.mdf"], "-o", w["grids"]});
    std::vector<std::string> expected{"background.nrrd", "body.nrrd"};
    for (const char* actuator : {"0", "1", "2"})
        for (const char* part : {"base", "top", "v0", "v1"})
            expected.push_back(std::string("actuator-") + actuator + "-" + part + ".nrrd");
    std::ranges::sort(expected);
    EXPECT_EQ(filesIn(w["grids"]), expected);
}

TEST_F(CommandLine, VoxelizeTakesAndGivesStandardStreams) {
    succeed({"voxelize", w["target.obj"], "--like", w["field.mdf"], "-o", w["t.nrrd"]});
    const std::string grid = textOfFile(w["t.nrrd"]);
    EXPECT_EQ(grid.substr(0, 4), "NRRD");
    const std::string obj = textOfFile(w["target.obj"]);
    const std::vector<std::byte> glb = writeGlb(modelOf(readMesh(w["target.obj"]), "target"));
    const std::string glbText(reinterpret_cast<const char*>(glb.data()), glb.size());
    for (const std::string& input : {obj, glbText})
        EXPECT_TRUE(succeed({"voxelize", "-", "--like", w["field.mdf"], "-o", "-"}, input).out == grid);
    EXPECT_FALSE(succeed({"voxelize", w["target.obj"], "--like", w["field.mdf"], "--fit", "-o", "-"}).out == grid);
}

TEST_F(CommandLine, MatchPrintsTheResultOnly) {
    const nlohmann::json result = succeed({"match", w["field.mdf"], w["target.obj"], "--repeat", "3", "--json"}).json();
    EXPECT_THAT(keysOf(result),
                IsSupersetOf({"state", "actuators", "iou", "unmatchedVolume", "overfilledVolume", "ms"}));
    ASSERT_EQ(result["state"].size(), 3U);
    ASSERT_EQ(result["actuators"].size(), 3U);
    for (const nlohmann::json& actuator : result["actuators"]) {
        EXPECT_THAT(keysOf(actuator), IsSupersetOf({"name", "errors", "intersections"}));
        EXPECT_EQ(actuator["errors"].size(), 5U);
        EXPECT_EQ(actuator["intersections"].size(), 5U);
    }
    for (const char* stage : {"voxelize", "match", "refine"}) EXPECT_TRUE(result["ms"][stage]["median"].is_number());
    EXPECT_GT(result["iou"].get<double>(), 0.2);
    EXPECT_THAT(succeed({"match", w["field.mdf"], w["target.obj"]}).out, HasSubstr("IoU"));
}

TEST_F(CommandLine, MatchCertifiesHowMuchBetterAStateCouldBe) {
    const std::vector<std::string> command{"match", w["field.mdf"], w["target.obj"], "--method", "refined", "--certify",
                                           "30"};
    std::vector<std::string> asJson = command;
    asJson.emplace_back("--json");
    const nlohmann::json result = succeed(asJson).json();
    EXPECT_NEAR(result["gap"].get<double>(), 0.0, 1e-12) << "three actuators of five levels are solved";
    EXPECT_DOUBLE_EQ(result["upperBound"].get<double>(), result["iou"].get<double>());
    EXPECT_THAT(succeed(command).out, HasSubstr("this is the best possible"));
}

TEST_F(CommandLine, MatchGivesTheSameStateForMeshAndGrid) {
    nlohmann::json fromMesh = succeed({"match", w["field.mdf"], w["target.obj"], "--json"}).json();
    succeed({"voxelize", w["target.obj"], "--like", w["field.mdf"], "-o", w["t.nrrd"]});
    nlohmann::json fromGrid = succeed({"match", w["field.mdf"], w["t.nrrd"], "--json"}).json();
    nlohmann::json fromInput = succeed({"match", w["field.mdf"], "-", "--json"}, textOfFile(w["t.nrrd"])).json();
    for (nlohmann::json* json : {&fromMesh, &fromGrid, &fromInput}) json->erase("ms");
    EXPECT_EQ(fromMesh, fromGrid);
    EXPECT_EQ(fromMesh, fromInput);
}

TEST_F(CommandLine, MatchWarnsOnStandardError) {
    writeFile(w["far.obj"], "v 5 5 5\nv 6 5 5\nv 5 6 5\nv 5 5 6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const Outcome outcome = lumorph({"match", w["field.mdf"], w["far.obj"], "--json"});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.json()["state"], nlohmann::json({0, 0, 0}));
    EXPECT_EQ(outcome.json()["warnings"].size(), 1U);
    EXPECT_THAT(outcome.err, HasSubstr("lumorph: warning: The target does not overlap"));
}

TEST_F(CommandLine, MatchRepairsAnOpenTargetAndSaysSo) {
    writeFile(w["open.obj"], "v 0.01 0.021 0.01\nv 0.06 0.021 0.01\nv 0.01 0.04 0.01\nv 0.01 0.021 0.06\n"
                             "f 1 3 2\nf 1 4 3\nf 2 3 4\n");
    const Outcome outcome = lumorph({"match", w["field.mdf"], w["open.obj"], "--json"});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_THAT(outcome.err, HasSubstr("has been repaired"));
}

} // namespace
} // namespace lumorph::test
