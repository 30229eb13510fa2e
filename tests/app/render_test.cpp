#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/image.h"
#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/support/cut_tablet.h"

// `lumorph render` as a script uses it.

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

// The same picture; software GL rounds now and then otherwise.
bool same(const Image& one, const Image& other) {
    if (one.size() != other.size()) return false;
    for (std::size_t i = 0; i < one.pixels().size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(one.pixels()[i][c] - other.pixels()[i][c]) > 2) return false;
    return true;
}

class Render : public ::testing::Test {
protected:
    Render() {
        Project project;
        project.rig = writeCutTablet(w.folder()).filename().string();
        project.scene.device.material.color = {0.9F, 0.3F, 0.2F};
        writeProject(project, w["p.lumorph"]);
    }
    Outcome render(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", w["p.lumorph"]};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }
    /// The picture of a view at a small size, with more arguments if need be.
    Image picture(const std::string& view, std::vector<std::string> more = {"--size", "320x200"}) const {
        more.insert(more.end(), {"--view", view, "-o", w["out.png"]});
        const Outcome outcome = render(more);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return readPng(w["out.png"]);
    }
    /// Wrong use: one line on stderr, and no file.
    void expectRefused(const std::vector<std::string>& more, const std::string& says) const {
        SCOPED_TRACE(says);
        std::vector<std::string> arguments = more;
        arguments.insert(arguments.end(), {"-o", w["none.png"]});
        const Outcome outcome = render(arguments);
        EXPECT_EQ(outcome.exitCode, 2);
        EXPECT_THAT(outcome.err, ::testing::MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
        EXPECT_THAT(outcome.err, HasSubstr(says));
        EXPECT_FALSE(std::filesystem::exists(w["none.png"]));
    }

    SmallWorkspace w;
};

TEST_F(Render, TheLitDeviceLooksAsItShouldWhereEyeAndProjectorSeeIt) {
    const std::vector<std::string> more{"--size", "640x400", "--state", "10,0,20,0,5,0"};
    const Image eye = picture("eye", more);
    const Image lab = picture("lab", more);
    const Image mask = picture("mask", more);
    ASSERT_EQ(eye.size(), glm::ivec2(640, 400));
    ASSERT_EQ(lab.size(), eye.size());
    ASSERT_EQ(mask.size(), eye.size());
    double difference = 0.0;
    double white = 0.0;
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        if (mask.pixels()[i][0] < 128) continue;
        white += 1.0;
        for (std::size_t c = 0; c < 3; ++c) difference += std::abs(eye.pixels()[i][c] - lab.pixels()[i][c]);
    }
    EXPECT_GT(white, 0.3 * 640 * 400);
    EXPECT_LT(difference / white / 3.0, 6.0) << "sRGB levels on average";
    EXPECT_FALSE(mask == Image(mask.size(), {255, 255, 255, 255})) << "flanks are hidden from the projector";
}

TEST_F(Render, TheProjectorsPictureHasTheProjectorsSize) {
    const Project project = readProject(w["p.lumorph"]);
    EXPECT_EQ(picture("projector", {}).size(), project.installation.projectors[0].camera.size);
    expectRefused({"--view", "projector", "--size", "320x200"}, "1920 x 1080");
    expectRefused({"--view", "projector", "--projector", "3"}, "the project's last one is 0");
}

TEST_F(Render, AnObserverElsewhereSeesTheSameLightFromThere) {
    const Image eye = picture("lab");
    const Image beside = picture("lab", {"--size", "320x200", "--observer", "0.5,0.4,0.3"});
    EXPECT_EQ(beside.size(), eye.size());
    EXPECT_FALSE(same(beside, eye));
    EXPECT_TRUE(same(picture("lab", {"--size", "320x200", "--observer", "0,0.45,0.55"}), eye))
        << "the project's own eye";
}

TEST_F(Render, AHandInTheLabShadowsTheProjectorAndTheRoomLightsTheShadow) {
    Project project = readProject(w["p.lumorph"]);
    InstalledProjector& projector =
        project.installation.projectors[0]; // overhead, so that the hand's shadow is below it
    projector.camera.cameraFromWorld =
        cameraLookingAt({0.0, 1.6, 0.0}, {0.0, 0.0, 0.001}, projector.camera.size, projector.camera.focal.x)
            .cameraFromWorld;
    projector.camera.principal = 0.5 * glm::dvec2(projector.camera.size) - 0.5;
    writeProject(project, w["p.lumorph"]);
    const std::vector<std::string> beside{"--size", "320x200", "--observer", "0.6,0.4,0"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), beside.begin(), beside.end());
        return picture("lab", more);
    };
    const Image open = with({});
    const Image shadowed = with({"--hand", "0,0.3,0"});
    const Image lit = with({"--hand", "0,0.3,0", "--ambient", "0.1"});
    const glm::ivec2 middle(160, 100);
    EXPECT_GT(open.at(middle.x, middle.y)[0], 60);
    EXPECT_LT(shadowed.at(middle.x, middle.y)[0], 5);
    // A tenth of white, of white paper: 89 of 255.
    EXPECT_NEAR(lit.at(middle.x, middle.y)[0], 89, 3);
    for (std::size_t i = 0; i < open.pixels().size(); ++i)
        EXPECT_LE(shadowed.pixels()[i][0], open.pixels()[i][0] + 1) << "a hand only takes light away";
    const Outcome projectLast = lumorph({"render", "--view", "lab", "--size", "320x200", "--observer", "0.6,0.4,0",
                                         "-o", w["last.png"], "--hand", "0,0.3,0", w["p.lumorph"]});
    ASSERT_EQ(projectLast.exitCode, 0) << projectLast.err;
    EXPECT_TRUE(same(readPng(w["last.png"]), shadowed));
    const Image away = with({"--hand", "0,0.3,0.8"});
    EXPECT_TRUE(same(away, open)) << "a hand outside of the light";
    expectRefused({"--view", "eye", "--hand", "0,0.3,0"}, "--view lab");
    expectRefused({"--view", "lab", "--hands-tracked"}, "--hand X,Y,Z");
    expectRefused({"--view", "lab", "--hand", "0,0.3"}, "three numbers");
    expectRefused({"--view", "lab", "--hand", ""}, "empty");
    expectRefused({"--view", "lab", "--ambient", "-1"}, "--ambient");
}

TEST_F(Render, ADeviceFollowsTheShowOrIsHeldInAState) {
    const Image atRest = picture("device");
    EXPECT_TRUE(same(picture("device", {"--size", "320x200", "--state", "0,0,0,0,0,0"}), atRest));
    EXPECT_FALSE(same(picture("device", {"--size", "320x200", "--state", "32,0,0,0,0,0"}), atRest));
    Project project = readProject(w["p.lumorph"]);
    project.matching.driver = Driver::hand;
    project.strokes = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    writeProject(project, w["p.lumorph"]);
    const Image begun = picture("device", {"--size", "320x200", "--time", "0.1"});
    const Image arrived = picture("device", {"--size", "320x200", "--time", "3"});
    EXPECT_TRUE(same(picture("device"), atRest)) << "at time 0 it has not moved yet";
    EXPECT_FALSE(same(begun, atRest));
    EXPECT_FALSE(same(begun, arrived)) << "its motors take their time";
    EXPECT_TRUE(same(picture("device", {"--size", "320x200", "--time", "3"}), arrived)) << "the same every time";
}

TEST_F(Render, JsonTellsHowThePictureWasSeen) {
    const Outcome outcome = render(
        {"--view", "lab", "--size", "320x200", "--eye", "0.1,0.5,0.4", "--time", "0.25", "--json", "-o", w["out.png"]});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json report = outcome.json();
    EXPECT_EQ(report["view"], "lab");
    EXPECT_EQ(report["size"], nlohmann::json({320, 200}));
    EXPECT_EQ(report["seconds"], 0.25);
    EXPECT_EQ(report["strokes"].size(), 6U);
    EXPECT_EQ(report["camera"]["matrix"].size(), 9U);
    EXPECT_EQ(report["camera"]["cameraFromWorld"].size(), 16U);
    EXPECT_NEAR(report["camera"]["position"][0].get<double>(), 0.1, 1e-6);
    EXPECT_NEAR(report["camera"]["position"][1].get<double>(), 0.5, 1e-6);
    EXPECT_GT(report["milliseconds"]["lab"].get<double>(), 0.0);
}

TEST_F(Render, WrongUseIsExplained) {
    expectRefused({"--view", "ghost"}, "--view");
    expectRefused({"--view", "eye", "--eye", "1,2"}, "three numbers");
    expectRefused({"--view", "eye", "--eye", "0,-0.4,0.5"}, "not above the table, so nothing is seen");
    expectRefused({"--view", "eye", "--eye", "0,nan,0.5"}, "--eye");
    expectRefused({"--view", "lab", "--observer", "0.5,0,0.5"}, "not above the table, so nothing is seen");
    expectRefused({"--view", "eye", "--eye", "0,0.01,0"}, "eye");
    expectRefused({"--view", "eye", "--size", "320"}, "1280x800");
    expectRefused({"--view", "eye", "--size", "4x4"}, "out of range");
    expectRefused({"--view", "eye", "--time", "-1"}, "--time");
    expectRefused({"--view", "eye", "--state", "0,1"}, "state");
    expectRefused({"--view", "eye", "--state", "0,0,0,0,0,99"}, "level 99");
    const Outcome noProject = lumorph({"render", w["none.lumorph"], "--view", "eye", "-o", w["none.png"]});
    EXPECT_EQ(noProject.exitCode, 1);
    EXPECT_THAT(noProject.err, HasSubstr("none.lumorph"));
    const Outcome noResource = lumorph({"render", "resource:../p.lumorph", "--view", "eye", "-o", w["none.png"]});
    EXPECT_EQ(noResource.exitCode, 1);
}

TEST_F(Render, ABundledProjectIsFoundByItsName) {
    const Outcome outcome = lumorph({"render", "resource:projects/water.lumorph", "--view", "eye", "--size", "160x100",
                                     "--time", "0.5", "-o", w["out.png"]});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(readPng(w["out.png"]).size(), glm::ivec2(160, 100));
}

} // namespace
} // namespace lumorph::test
