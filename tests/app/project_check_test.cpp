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
    EXPECT_EQ(report["schemaVersion"], 2);
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

TEST_F(ProjectCheck, RefusesAFileThatIsNoProject) {
    writeFile(w["newer.lumorph"], std::string(R"({"schemaVersion": 3, "rig": "rig.glb"})"));
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
