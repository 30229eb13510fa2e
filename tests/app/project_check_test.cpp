#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

class ProjectCheck : public ::testing::Test {
protected:
    ProjectCheck() {
        project.rig = "rig.glb";
        project.field = "field.mdf";
        project.target = "target.obj";
        project.strokes = {0.0, 0.5, 1.0};
    }
    Outcome check(const std::vector<std::string>& more = {}) const {
        writeProject(project, w["p.lumorph"]);
        std::vector<std::string> arguments{"project", "check", w["p.lumorph"]};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }
    /// The check fails, says so in one line on stderr, and lists the same among its problems.
    void expectProblem(const std::string& says) const {
        SCOPED_TRACE(says);
        const Outcome outcome = check({"--json"});
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_THAT(outcome.err, ::testing::MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
        EXPECT_THAT(outcome.err, HasSubstr(says));
        const nlohmann::json report = outcome.json();
        EXPECT_EQ(report["ok"], false);
        ASSERT_EQ(report["problems"].size(), 1U);
        EXPECT_THAT(report["problems"][0].dump(), HasSubstr(says));
    }

    SmallWorkspace w;
    Project project;
};

TEST_F(ProjectCheck, TellsWhatAWholeProjectHolds) {
    const Outcome outcome = check({"--json"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json report = outcome.json();
    EXPECT_EQ(report["ok"], true);
    EXPECT_EQ(report["schemaVersion"], 4);
    EXPECT_EQ(report["rig"]["asset"], "rig.glb");
    EXPECT_EQ(report["rig"]["actuators"], nlohmann::json({"lift 0", "lift 1", "lift 2"}));
    EXPECT_EQ(report["field"]["levels"], 5);
    EXPECT_EQ(report["target"]["triangles"], 12);
    EXPECT_EQ(report["target"]["animations"], 0);
    EXPECT_TRUE(report["problems"].empty());
    EXPECT_THAT(check().out, ::testing::AllOf(HasSubstr("3 actuators"), HasSubstr("12 triangles")));
    project.field.clear();
    project.target.clear();
    EXPECT_TRUE(check({"--json"}).json()["field"].is_null());
}

TEST_F(ProjectCheck, NamesWhatIsWrongWithEachAsset) {
    const Project whole = project;
    project.target = "missing.obj";
    expectProblem("missing.obj");
    project = whole;
    writeFile(w["broken.glb"], std::string("glTF"));
    project.target = "broken.glb";
    expectProblem("broken.glb");
    project = whole;
    project.field = "target.obj";
    expectProblem("target.obj");
    project = whole;
    project.rig = "resource:models/tablet.glb";
    project.strokes.clear();
    expectProblem("was built for another rig");
    project = whole;
    project.strokes = {0.5};
    expectProblem("strokes");
    project = whole;
    project.animation = 1;
    expectProblem("animation");
}

TEST_F(ProjectCheck, TellsWhatTheSceneHolds) {
    project.scene.items.push_back({});
    project.scene.items.back().id = 2;
    project.scene.items.back().name = "Waves";
    project.scene.items.back().role = ItemRole::split;
    project.scene.items.back().kind = HeightItem{};
    const nlohmann::json scene = check({"--json"}).json()["scene"];
    EXPECT_EQ(scene["items"]["light"], 1);
    EXPECT_EQ(scene["items"]["heights"], 1);
    EXPECT_EQ(scene["items"]["mesh"], 0);
    EXPECT_EQ(scene["servosFollow"], "Waves");
    ASSERT_EQ(scene["projectors"].size(), 1U);
    EXPECT_EQ(scene["projectors"][0]["size"], nlohmann::json({1920, 1080}));
    EXPECT_EQ(scene["projectors"][0]["enabled"], true);
    ASSERT_GE(scene["assets"].size(), 1U);
    for (const nlohmann::json& asset : scene["assets"]) EXPECT_EQ(asset["ok"], true) << asset;
    EXPECT_THAT(check().out, HasSubstr("2 items, 1 projector"));
}

TEST_F(ProjectCheck, NamesWhatOfTheSceneIsBroken) {
    const Project whole = project;
    project.scene.device.material.colorTexture.image = "missing.png";
    expectProblem("missing.png");
    project = whole;
    writeFile(w["broken.jpg"], std::string("\xff\xd8\xff"));
    project.scene.device.material.holes.image = "broken.jpg";
    expectProblem("broken.jpg");
    const nlohmann::json assets = check({"--json"}).json()["scene"]["assets"];
    const auto broken = std::ranges::find_if(assets, [](const auto& asset) { return asset["asset"] == "broken.jpg"; });
    ASSERT_NE(broken, assets.end());
    EXPECT_EQ((*broken)["ok"], false);
    EXPECT_FALSE((*broken)["why"].get<std::string>().empty());
    EXPECT_FALSE((*broken)["remedy"].get<std::string>().empty());
    project = whole;
    SceneItem fish;
    fish.id = 2;
    fish.kind = MeshItem{"fish.glb"};
    project.scene.items.push_back(fish);
    writeFile(w["fish.glb"], std::string("glTF"));
    expectProblem("fish.glb");
}

TEST_F(ProjectCheck, TheBundledProjectsAreWhole) {
    for (const char* name : {"water", "techniques"}) {
        const std::string file = std::string(LUMORPH_SOURCE_DIR) + "/resources/projects/" + name + ".lumorph";
        const Outcome outcome = lumorph({"project", "check", file, "--json"});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_FALSE(outcome.json()["scene"]["servosFollow"].is_null());
    }
}

TEST_F(ProjectCheck, RefusesAFileThatIsNoProject) {
    writeFile(w["newer.lumorph"], std::string(R"({"schemaVersion": 5, "rig": "rig.glb"})"));
    for (const auto& [file, says] : {std::pair{"missing.lumorph", "missing.lumorph"},
                                     {"rig.glb", "not valid JSON"},
                                     {"newer.lumorph", "newest Lumorph"}}) {
        const Outcome outcome = lumorph({"project", "check", w[file], "--json"});
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, HasSubstr(says));
    }
    EXPECT_EQ(lumorph({"project", "check"}).exitCode, 2);
    EXPECT_EQ(lumorph({"project"}).exitCode, 2);
}

} // namespace
} // namespace lumorph::test
