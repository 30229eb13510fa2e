#include "core/scene/project.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "tests/core/file_size_limit.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kTablet = "resource:models/tablet.glb";

std::string textOf(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, 1'000'000);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::size_t filesIn(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

Project fullProject() {
    Project project;
    project.rig = kTablet;
    project.field = "fields/tablet.mdf";
    project.target = "my files/Kühe & Pferde.glb";
    project.animation = 3;
    project.placement = {0.1,
                         Angle::radians(-2.345678901234567),
                         {0.1F, -2.5e-7F, 3.0F},
                         glm::normalize(glm::quat(0.5F, 0.1F, -0.7F, 0.3F)),
                         true};
    project.strokes = {0.0, 1.0, 1.0 / 3.0, 0.1, 1e-300, 0.999999999999999};
    project.matching = {Driver::hand, false, 12.5};
    project.playback = {false, -0.7853981633974483};
    project.poses.actuators = {"left", "right"};
    project.poses.sequence.poses = {{"Öffnen", {1.0 / 3.0, 1.0}}, {"shut", {0.0, 1e-300}}};
    project.poses.sequence.steps = {{"shut", 0.1, 0.0, Easing::linear}, {"Öffnen", 2.5, 1.0 / 3.0, Easing::smooth}};
    project.poses.sequence.loop = true;
    project.view = {{"camera", {{"yaw", 0.25}}}, {"slices", {1, 2, 3}}};
    return project;
}

/// The smallest document that is a project, with `key` (a JSON pointer) set to `value`.
std::string projectWith(const std::string& key, const json& value) {
    json document = {{"schemaVersion", kProjectSchema}, {"rig", kTablet}};
    document[json::json_pointer(key)] = value;
    return document.dump();
}

TEST(ProjectFile, ComesBackAsItWasWritten) {
    const TemporaryFolder folder;
    const Project project = fullProject();
    writeProject(project, folder / "a.lumorph");
    const Project back = readProject(folder / "a.lumorph");
    EXPECT_EQ(back.rig, project.rig);
    EXPECT_EQ(back.field, project.field);
    EXPECT_EQ(back.target, project.target);
    EXPECT_EQ(back.animation, 3);
    EXPECT_EQ(back.placement.scale, project.placement.scale);
    EXPECT_EQ(back.placement.yaw, project.placement.yaw);
    EXPECT_EQ(back.placement.translation, project.placement.translation);
    EXPECT_EQ(back.placement.orientation, project.placement.orientation);
    EXPECT_TRUE(back.placement.relief);
    EXPECT_EQ(back.strokes, project.strokes);
    EXPECT_EQ(back.matching, project.matching);
    EXPECT_EQ(back.playback, project.playback);
    EXPECT_EQ(back.poses, project.poses);
    EXPECT_EQ(back.view, project.view);
    writeProject(back, folder / "b.lumorph");
    EXPECT_EQ(textOf(folder / "a.lumorph"), textOf(folder / "b.lumorph"));
    EXPECT_EQ(filesIn(folder.path()), 2U);
}

TEST(ProjectFile, HoldsTheKeysThatOtherProgramsMayRead) {
    const json document = json::parse(projectText(fullProject()));
    EXPECT_EQ(document["schemaVersion"], 4);
    EXPECT_EQ(document["rig"], kTablet);
    EXPECT_EQ(document["target"], "my files/Kühe & Pferde.glb");
    EXPECT_EQ(document["placement"]["scale"], 0.1);
    EXPECT_EQ(document["placement"]["translation"].size(), 3U);
    EXPECT_EQ(document["matching"]["budgetMilliseconds"], 12.5);
    EXPECT_EQ(document["playback"]["spin"], -0.7853981633974483);
    EXPECT_EQ(document["view"]["slices"], json({1, 2, 3}));
}

TEST(ProjectFile, WhatIsNotStatedIsAsInANewProject) {
    const Project project = parseProject(R"({"schemaVersion": 1, "rig": "a.glb"})", "a.lumorph");
    const Project fresh;
    EXPECT_EQ(project.rig, "a.glb");
    EXPECT_EQ(project.field, "");
    EXPECT_EQ(project.target, "");
    EXPECT_EQ(project.placement.scale, 1.0);
    EXPECT_TRUE(project.strokes.empty());
    EXPECT_EQ(project.matching, fresh.matching);
    EXPECT_EQ(project.playback, fresh.playback);
    EXPECT_EQ(project.poses, PoseBook());
    EXPECT_FALSE(json::parse(projectText(project)).contains("poses")) << "a project without any is as before";
}

TEST(ProjectFile, KeepsTheKeysItDoesNotKnow) {
    const std::string text = R"({"schemaVersion": 1, "rig": "a.glb", "author": "Ada", "nothing": null,
        "matching": {"driver": "hand", "colour": [1, {"deep": true}]}, "placement": {"pinned": true},
        "lamps": [{"at": [1, 2, 3]}]})";
    Project project = parseProject(text, "a.lumorph");
    project.target = "cow.obj";
    project.matching.driver = Driver::target;
    const json written = json::parse(projectText(project));
    EXPECT_EQ(written["author"], "Ada");
    EXPECT_TRUE(written.contains("nothing"));
    EXPECT_EQ(written["lamps"], json::parse(R"([{"at": [1, 2, 3]}])"));
    EXPECT_EQ(written["matching"]["colour"], json::parse(R"([1, {"deep": true}])"));
    EXPECT_EQ(written["matching"]["driver"], "target");
    EXPECT_EQ(written["placement"]["pinned"], true);
    EXPECT_EQ(written["placement"]["scale"], 1.0);
    EXPECT_EQ(written["target"], "cow.obj");
}

TEST(ProjectFile, ADraftWithoutVersionIsMigrated) {
    for (const char* text : {R"({"model": "a.glb", "author": "Ada", "strokes": [0.5]})",
                             R"({"schemaVersion": 0, "model": "a.glb", "author": "Ada", "strokes": [0.5]})"}) {
        const Project project = parseProject(text, "a.lumorph");
        EXPECT_EQ(project.rig, "a.glb");
        EXPECT_THAT(project.strokes, ElementsAre(0.5));
        const json written = json::parse(projectText(project));
        EXPECT_EQ(written["schemaVersion"], 4);
        EXPECT_EQ(written["author"], "Ada");
        EXPECT_FALSE(written.contains("model"));
    }
    const Project present = parseProject(projectWith("/model", "not a rig here"), "a.lumorph");
    EXPECT_EQ(present.rig, kTablet) << "a document of today's schema was migrated";
}

TEST(ProjectFile, EveryBrokenValueIsNamedWithItsKey) {
    json nested = 1;
    for (int i = 0; i < 70; ++i) nested = json::array({nested});
    const struct {
        std::string text;
        const char* says;
    } cases[] = {
        {"", "is not valid JSON at byte"},
        {R"({"schemaVersion": 1,)", "is not valid JSON at byte 2"},
        {"[]", "is not a project"},
        {projectWith("/strokes", json::parse("[1]")).replace(15, 1, "\xff"), "is not valid JSON"},
        {projectWith("/deep", nested), "nests JSON deeper than 64 levels"},
        {projectWith("/many", std::vector<int>(1'000'001, 0)), "more than 1000000 JSON values"},
        {R"({"rig": "a.glb", "strokes": [1e999]})", "is not valid JSON"},
        {projectWith("/schemaVersion", 5),
         "schemaVersion: was written by a newer Lumorph (schema 5; this one reads up to 4)"},
        {projectWith("/schemaVersion", 18446744073709551615ULL), "newer Lumorph"},
        {projectWith("/schemaVersion", -1), "schemaVersion: is not a whole number"},
        {projectWith("/schemaVersion", "1"), "schemaVersion: is not a whole number"},
        {projectWith("/schemaVersion", 1.5), "schemaVersion: is not a whole number"},
        {R"({"schemaVersion": 1})", "rig: is missing"},
        {projectWith("/rig", ""), "rig: is missing"},
        {projectWith("/rig", 7), "rig: is not a text"},
        {projectWith("/field", json::array()), "field: is not a text"},
        {projectWith("/target", nullptr), "target: is not a text"},
        {projectWith("/animation", -1), "animation: is not a whole number from 0 to 100000"},
        {projectWith("/animation", 0.5), "animation: is not a whole number"},
        {projectWith("/animation", 100'001), "animation: is not a whole number"},
        {projectWith("/placement", 3), "placement: is not an object"},
        {projectWith("/placement/scale", 0), "placement.scale: is not a number from 1e-06 to 1000000.0"},
        {projectWith("/placement/scale", "big"), "placement.scale: is not a number"},
        {projectWith("/placement/scale", 1e300), "placement.scale: is not a number"},
        {projectWith("/placement/orientation", {0.0, 0.0, 0.0, 0.0}), "placement.orientation: is no rotation"},
        {projectWith("/placement/orientation", {0.0, 1.0}), "placement.orientation: is not a list of 4 numbers"},
        {projectWith("/placement/yaw", true), "placement.yaw: is not a number"},
        {projectWith("/placement/translation", {1, 2}), "placement.translation: is not a list of 3 numbers"},
        {projectWith("/placement/translation", {1, 2, 3, 4}), "placement.translation: is not a list of 3 numbers"},
        {projectWith("/placement/translation", {1, "2", 3}), "placement.translation[1]: is not a number"},
        {projectWith("/placement/translation", {1, 2, 1e7}), "placement.translation[2]: is not a number"},
        {projectWith("/strokes", 1), "strokes: is not a list"},
        {projectWith("/strokes", {0.5, 1.01}), "strokes[1]: is not a number from 0.0 to 1.0"},
        {projectWith("/strokes", {-0.1}), "strokes[0]: is not a number"},
        {projectWith("/strokes", {nullptr}), "strokes[0]: is not a number"},
        {projectWith("/strokes", std::vector<int>(65'001, 0)), "strokes: is not a list of at most 65000 numbers"},
        {projectWith("/matching", "driver"), "matching: is not an object"},
        {projectWith("/matching/driver", 1), "matching.driver: is not a text"},
        {projectWith("/matching/driver", "dance"), "matching.driver: is 'dance', not who can move the servos"},
        {projectWith("/matching/refined", "yes"), "matching.refined: is neither true nor false"},
        {projectWith("/matching/budgetMilliseconds", 0),
         "matching.budgetMilliseconds: is not a number from 0.1 to 10000.0"},
        {projectWith("/playback", nullptr), "playback: is not an object"},
        {projectWith("/playback/playing", "on"), "playback.playing: is neither true nor false"},
        {projectWith("/playback/spin", 1000), "playback.spin: is not a number from -100.0 to 100.0"},
        {projectWith("/poses", 3), "poses: is not an object"},
        {projectWith("/poses/actuators", {"a", 1}), "poses.actuators[1]: is not a text"},
        {projectWith("/poses/named", json::parse(R"([{"name": "a", "strokes": []}, {"name": "a", "strokes": []}])")),
         "poses.pose 'a': another pose has the same name"},
        {projectWith("/poses", json::parse(R"({"actuators": ["x"], "named": [{"name": "a", "strokes": [0, 1]}]})")),
         "poses.pose 'a': it has 2 strokes, the device 1 actuators"},
        {projectWith("/poses", json::parse(R"({"actuators": ["x"], "named": [{"name": "a", "strokes": [null]}]})")),
         "poses.named[0].strokes[0]: is not a number from 0.0 to 1.0"},
        {projectWith("/poses/steps", json::parse(R"([{"pose": "gone"}])")), "poses.pose 'gone': no pose has this name"},
        {projectWith("/poses/steps", json::parse(R"([{"pose": "a", "travelSeconds": 1e9}])")),
         "poses.steps[0].travelSeconds: is not a number from 0.0 to 3600.0"},
        {projectWith("/poses/steps", json::parse(R"([{"pose": "a", "easing": "wild"}])")),
         "poses.steps[0].easing: is 'wild', not a way to move"},
        {projectWith("/poses/steps", json(std::vector<json>(kMaxPoseSteps + 1, json::object()))),
         "poses.steps: has 1001 entries, and 1000 is the most"},
        {projectWith("/view", {1, 2}), "view: is not an object"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.says);
        try {
            (void)parseProject(c.text, "/a/b.lumorph");
            ADD_FAILURE() << "was read: " << c.text.substr(0, 100);
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), "/a/b.lumorph");
            EXPECT_THAT(error.why(), HasSubstr(c.says));
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

TEST(ProjectFile, NamesNoFileOutsideItsFolder) {
    for (const char* path :
         {"../a.glb", "a/../../b.glb", "a/..", "/etc/passwd", "/", ".", "./", "resource:../CMakeLists.txt",
          "resource:/etc/passwd", "resource:", "resource:models/../../README.md"}) {
        for (const char* key : {"rig", "field", "target"}) {
            SCOPED_TRACE(std::string(key) + " " + path);
            try {
                (void)parseProject(projectWith(std::string("/") + key, path), "a.lumorph");
                ADD_FAILURE() << "was read";
            } catch (const DataError& error) {
                EXPECT_THAT(error.why(), testing::AllOf(HasSubstr(std::string(key) + ": "), HasSubstr("leads out")));
            }
            Project project;
            project.rig = kTablet;
            (*key == 'r' ? project.rig : *key == 'f' ? project.field : project.target) = path;
            const TemporaryFolder folder;
            EXPECT_THROW(writeProject(project, folder / "a.lumorph"), InvalidInput);
            EXPECT_EQ(filesIn(folder.path()), 0U);
        }
    }
    const std::string zero = projectWith("/rig", std::string("a\0b.glb", 7));
    EXPECT_THROW((void)parseProject(zero, "a.lumorph"), DataError);
}

TEST(ProjectFile, FollowsNoLinkOutOfItsFolder) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "outside");
    fs::create_directories(folder / "project/inside");
    std::ofstream(folder / "outside/a.glb") << "a";
    std::ofstream(folder / "project/inside/a.glb") << "a";
    fs::create_directory_symlink("../outside", folder / "project/out");
    fs::create_symlink("../outside/a.glb", folder / "project/out.glb");
    fs::create_directory_symlink("inside", folder / "project/in");
    const fs::path file = folder / "project/p.lumorph";
    for (const char* asset : {"out/a.glb", "out.glb", "out"}) {
        std::ofstream(file) << projectWith("/rig", asset);
        try {
            (void)readProject(file);
            ADD_FAILURE() << asset << " was followed";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), file.string());
            EXPECT_THAT(error.why(), HasSubstr("rig: "));
        }
        EXPECT_THROW((void)assetPath(file, asset), DataError);
        Project project;
        project.rig = asset;
        EXPECT_THROW(writeProject(project, file), InvalidInput);
    }
    std::ofstream(file) << projectWith("/rig", "in/a.glb");
    EXPECT_EQ(assetPath(file, readProject(file).rig), fs::canonical(folder / "project/inside/a.glb"));
}

TEST(ProjectFile, RefusesValuesThatCouldNotBeReadBack) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.lumorph";
    writeProject(fullProject(), file);
    const std::string before = textOf(file);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    json deep = 1;
    for (int i = 0; i < 70; ++i) deep = json::array({deep});
    const std::vector<std::pair<std::function<void(Project&)>, const char*>> cases = {
        {[](Project& p) { p.rig.clear(); }, "rig"},
        {[&](Project& p) { p.placement.scale = nan; }, "placement.scale"},
        {[&](Project& p) { p.placement.yaw = Angle::radians(nan); }, "placement.yaw"},
        {[&](Project& p) { p.placement.translation.y = INFINITY; }, "placement.translation[1]"},
        {[](Project& p) {
             p.strokes = {0.5, 1.5};
         },
         "strokes[1]"},
        {[&](Project& p) { p.playback.spin = nan; }, "playback.spin"},
        {[](Project& p) { p.animation = -1; }, "animation"},
        {[](Project& p) { p.view = "text"; }, "view"},
        {[&](Project& p) {
             p.view = {{"deep", deep}};
         },
         "deeper"},
        {[](Project& p) { p.target = "\xff.glb"; }, "UTF-8"},
    };
    for (const auto& [spoil, says] : cases) {
        Project project = fullProject();
        spoil(project);
        try {
            writeProject(project, file);
            ADD_FAILURE() << says << " was written";
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), HasSubstr(says));
        }
    }
    EXPECT_EQ(textOf(file), before);
}

TEST(ProjectFile, StaysAsItWasWhenTheDiskIsFull) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.lumorph";
    writeProject(fullProject(), file);
    const std::string before = textOf(file);
    Project project = fullProject();
    project.view["notes"] = std::string(10'000, 'x');
    {
        const FileSizeLimit limit(4096);
        EXPECT_THROW(writeProject(project, file), DeviceError);
    }
    EXPECT_EQ(textOf(file), before);
    EXPECT_EQ(filesIn(folder.path()), 1U);
    EXPECT_THROW(writeProject(project, "/dev/full"), DeviceError);
    EXPECT_THROW(writeProject(project, folder / "missing/a.lumorph"), DeviceError);
}

TEST(ProjectFile, NamesAFileThatCannotBeRead) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe.lumorph").c_str(), 0600), 0);
    std::ofstream(folder / "large.lumorph").seekp((std::streamoff{64} << 20) + 1).put(' ');
    for (const fs::path& file :
         {folder / "missing.lumorph", folder.path(), folder / "pipe.lumorph", folder / "large.lumorph"}) {
        try {
            (void)readProject(file);
            ADD_FAILURE() << file << " was read";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), file.string());
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

} // namespace
} // namespace lumorph
