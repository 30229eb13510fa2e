#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/project.h"
#include "core/scene/scene_assets.h"
#include "tests/core/scene/scenes.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

Project projectWith(Scene scene) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    project.scene = std::move(scene);
    project.installation = test::fullInstallation();
    return project;
}

json documentOfFullScene() { return json::parse(projectText(projectWith(test::fullScene()))); }

/// The text of the full scene with `key` (a JSON pointer below `scene`) set to `value`.
std::string with(const std::string& key, const json& value) {
    json document = documentOfFullScene();
    document[json::json_pointer("/scene" + key)] = value;
    return document.dump();
}

/// The same below `installation`.
std::string inRoom(const std::string& key, const json& value) {
    json document = documentOfFullScene();
    document[json::json_pointer("/installation" + key)] = value;
    return document.dump();
}

TEST(SceneFormat, EveryValueComesBackExactly) {
    const Project project = projectWith(test::fullScene());
    const std::string text = projectText(project);
    const Project back = parseProject(text, "a.lumorph");
    EXPECT_TRUE(back.scene == project.scene);
    EXPECT_EQ(projectText(back), text);
    EXPECT_TRUE(parseProject(projectText(projectWith(defaultScene())), "a").scene == defaultScene());
    EXPECT_TRUE(parseProject(projectText(projectWith(Scene{})), "a").scene == Scene{});
}

TEST(SceneFormat, AMirroredPoseIsNoPose) {
    Installation room = test::fullInstallation();
    ASSERT_NO_THROW(checkInstallation(room));
    room.worldFromDevice[0] = -room.worldFromDevice[0];
    EXPECT_THROW(checkInstallation(room), InvalidInput);
    room = test::fullInstallation();
    ASSERT_FALSE(room.projectors.empty());
    for (int row = 0; row < 4; ++row) room.projectors[0].camera.cameraFromWorld[row].y *= -1.0;
    EXPECT_THROW(checkInstallation(room), InvalidInput);
}

// What may be written may be read: the longest name there is, and not one byte more.
TEST(SceneFormat, TheLongestTextComesBackToo) {
    Project project = projectWith(test::fullScene());
    project.scene.items[0].name.assign(1000, 'n');
    EXPECT_EQ(parseProject(projectText(project), "a.lumorph").scene.items[0].name, project.scene.items[0].name);
    EXPECT_THROW((void)parseProject(with("/items/0/name", std::string(1001, 'n')), "a.lumorph"), DataError);
}

TEST(SceneFormat, AnyFloatComesBackExactly) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> numbers(-90.0F, 90.0F);
    Project project = projectWith(test::fullScene());
    Scene& scene = project.scene;
    Installation& installation = project.installation;
    for (int i = 0; i < 200; ++i) {
        installation.eye = {numbers(random), numbers(random) * 1e-20F, 1.0F / numbers(random)};
        scene.items[0].position = {numbers(random), std::nextafter(0.1F, numbers(random)), 0.1F};
        const Project back = parseProject(projectText(project), "a.lumorph");
        ASSERT_EQ(back.installation.eye, installation.eye);
        ASSERT_EQ(back.scene.items[0].position, scene.items[0].position);
    }
}

TEST(SceneFormat, AnglesAreWrittenInDegreesAndStayAsTheyAre) {
    Scene scene = test::fullScene();
    auto& wave = std::get<HeightItem>(scene.items[4].kind).waves[0];
    std::mt19937 random(3);
    std::uniform_real_distribution<double> degrees(-360.0, 360.0);
    for (int i = 0; i < 200; ++i) {
        wave.direction = Angle::degrees(degrees(random));
        wave.phase = Angle::radians(degrees(random));
        const Project once = parseProject(projectText(projectWith(scene)), "a.lumorph");
        const auto& read = std::get<HeightItem>(once.scene.items[4].kind).waves[0];
        ASSERT_EQ(read.direction, wave.direction) << "was given in degrees";
        ASSERT_NEAR(read.phase.inRadians(), wave.phase.inRadians(), 1e-13);
        ASSERT_TRUE(parseProject(projectText(once), "b.lumorph").scene == once.scene) << "drifts from save to save";
        ASSERT_EQ(projectText(once), projectText(projectWith(scene))) << "its text drifts";
    }
    const json document = documentOfFullScene();
    EXPECT_EQ(document["scene"]["viewDependence"]["thetaDegrees"], 75.0);
    EXPECT_EQ(document["scene"]["device"]["creases"]["thresholdDegrees"], 12.0);
    EXPECT_EQ(document["scene"]["device"]["material"]["colorTexture"]["turnDegrees"], 33.3);
}

TEST(SceneFormat, IsReadableForOthers) {
    const json document = documentOfFullScene();
    const json& items = document["scene"]["items"];
    EXPECT_EQ(items[0]["kind"], "group");
    EXPECT_EQ(items[0]["anchor"], "world");
    EXPECT_NEAR(items[0]["rotation"][3].get<double>(), std::cos(0.25), 1e-6) << "x, y, z, w";
    EXPECT_EQ(items[0]["position"], json::parse("[0.1, -0.2, 0.3]")) << "0.1F is written 0.1";
    EXPECT_EQ(items[1]["mesh"]["model"], "models/fish.glb");
    EXPECT_EQ(items[3]["shape"]["form"], "cylinder");
    EXPECT_EQ(items[4]["role"], "split");
    EXPECT_EQ(items[4]["heights"]["waves"][0]["directionDegrees"], -120.0);
    EXPECT_EQ(items[6]["light"]["form"], "lamp");
    EXPECT_EQ(document["scene"]["showing"], "virtual");
    EXPECT_EQ(document["installation"]["projectors"][0]["camera"]["size"], json({1920, 1080}));
}

TEST(SceneFormat, WhatIsNotStatedIsAsInANewProject) {
    const auto sceneOf = [](const char* text) {
        return parseProject(std::string(R"({"schemaVersion": 2, "rig": "a.glb")") + text + "}", "a.lumorph").scene;
    };
    EXPECT_TRUE(sceneOf("") == defaultScene());
    EXPECT_TRUE(sceneOf(R"(, "scene": {})") == defaultScene());
    Scene expected = defaultScene();
    expected.items.clear();
    expected.device.material = Material{};
    expected.device.material.color.r = 0.5F;
    EXPECT_FALSE(sceneOf(R"(, "scene": {"items": [], "device": {"material": {"color": [0.5, 0.8, 0.8]}}})") ==
                 defaultScene());
    expected.device.material.color = {0.5F, 0.8F, 0.8F};
    EXPECT_TRUE(sceneOf(R"(, "scene": {"items": [], "device": {"material": {"color": [0.5, 0.8, 0.8]}}})") == expected);
}

TEST(SceneFormat, WhatIsNotStatedOfTheRoomIsAsInTheVirtualLab) {
    const auto roomOf = [](const char* text) {
        return parseProject(std::string(R"({"schemaVersion": 3, "rig": "a.glb")") + text + "}", "a.lumorph")
            .installation;
    };
    EXPECT_TRUE(roomOf("") == defaultInstallation());
    EXPECT_TRUE(roomOf(R"(, "scene": {})") == defaultInstallation());
    EXPECT_TRUE(roomOf(R"(, "installation": {})") == defaultInstallation());
    Installation expected = defaultInstallation();
    expected.projectors.clear();
    expected.eye = {0.1F, 0.2F, 0.3F};
    EXPECT_TRUE(roomOf(R"(, "installation": {"projectors": [], "eye": [0.1, 0.2, 0.3]})") == expected);
}

TEST(SceneFormat, KeepsTheKeysItDoesNotKnow) {
    json document = documentOfFullScene();
    document["scene"]["rain"] = {{"drops", 3}};
    document["scene"]["device"]["creases"]["note"] = "sharp";
    document["installation"]["windows"] = {{"north", 2}};
    Project project = parseProject(document.dump(), "a.lumorph");
    project.scene.exposure = 2.0;
    const json written = json::parse(projectText(project));
    EXPECT_EQ(written["scene"]["rain"]["drops"], 3);
    EXPECT_EQ(written["scene"]["device"]["creases"]["note"], "sharp");
    EXPECT_EQ(written["scene"]["exposure"], 2.0);
    EXPECT_EQ(written["installation"]["windows"]["north"], 2);
}

TEST(SceneFormat, ASchema1ProjectGetsTheSceneItShowed) {
    const Project bare = parseProject(R"({"schemaVersion": 1, "rig": "a.glb", "target": ""})", "a.lumorph");
    EXPECT_TRUE(bare.scene == defaultScene());
    const Project aimed = parseProject(R"({"schemaVersion": 1, "rig": "a.glb", "target": "cow.obj"})", "a.lumorph");
    EXPECT_EQ(aimed.target, "cow.obj");
    const SceneItem* driving = drivingItem(aimed.scene);
    ASSERT_TRUE(driving);
    EXPECT_EQ(driving->role, ItemRole::physical);
    EXPECT_TRUE(std::holds_alternative<TargetItem>(driving->kind));
    EXPECT_EQ(aimed.scene.items.size(), defaultScene().items.size() + 1);
    checkScene(aimed.scene);
}

TEST(SceneFormat, EveryBrokenValueIsNamedWithItsKey) {
    json circle = documentOfFullScene()["scene"]["items"];
    circle[0]["parent"] = 3;
    json twice = documentOfFullScene()["scene"]["items"];
    twice[3]["id"] = 7;
    json twoDrive = documentOfFullScene()["scene"]["items"];
    twoDrive[2]["role"] = "physical";
    json noGroup = documentOfFullScene()["scene"]["items"];
    noGroup[3]["parent"] = 4;
    json lightDrives = documentOfFullScene()["scene"]["items"];
    lightDrives[4]["role"] = "virtual";
    lightDrives[6]["role"] = "physical";
    json many = json::array();
    for (int i = 1; i <= kMaxItems + 1; ++i) many.push_back({{"id", i}, {"kind", "group"}});
    const struct {
        std::string text;
        const char* says;
    } cases[] = {
        {with("", 3), "scene: is not an object"},
        {with("/items", "none"), "scene.items: is not a list"},
        {with("/items", many), "scene.items: has 501 entries, and 500 is the most"},
        {with("/items/0", 5), "scene.items[0]: is not an object"},
        {with("/items/0/kind", "cloud"), "scene.items[0].kind: 'cloud' is not known here"},
        {with("/items/0/kind", 7), "scene.items[0].kind: is not a text"},
        {with("/items/0/id", 0), "scene.items[0].id: is not a whole number from 1"},
        {with("/items/0/id", 1.5), "scene.items[0].id: is not a whole number"},
        {with("/items/0/name", std::string(1001, 'x')), "scene.items[0].name: is longer"},
        {with("/items/0/opacity", 1.01), "scene.items[0].opacity: is not a number from 0.0 to 1.0"},
        {with("/items/0/anchor", "sky"), "scene.items[0].anchor: 'sky' is not known here"},
        {with("/items/0/role", ""), "scene.items[0].role: '' is not known here"},
        {with("/items/0/position", {1, 2}), "scene.items[0].position: is not a list of 3 numbers"},
        {with("/items/0/position/1", nullptr), "scene.items[0].position[1]: is not a number"},
        {with("/items/0/position/2", 1e30), "scene.items[0].position[2]: is not a number from -100.0 to 100.0"},
        {with("/items/0/rotation", {0, 0, 0, 0}), "rotation is no rotation"},
        {with("/items/0/scale/0", 0), "scene.items[0].scale[0]: is not a number"},
        {with("/items/0/motion/bobPeriod", 0), "scene.items[0].motion.bobPeriod: is not a number"},
        {with("/items/1/mesh/model", "../fish.glb"), "scene.items[1].mesh.model: '../fish.glb' leads out"},
        {with("/items/1/mesh/animation", -2), "scene.items[1].mesh.animation: is not a whole number from -1"},
        {with("/items/3/shape/size/1", 0), "scene.items[3].shape.size[1]: is not a number"},
        {with("/items/3/shape/form", "torus"), "scene.items[3].shape.form: 'torus' is not known here"},
        {with("/items/4/heights/size/0", 0), "scene.items[4].heights.size[0]: is not a number"},
        {with("/items/4/heights/waves", json(33, json::object())), "scene.items[4].heights.waves: has 33 entries"},
        {with("/items/4/heights/waves/0/length", 0), "scene.items[4].heights.waves[0].length: is not a number"},
        {with("/items/4/heights/image", "/etc/passwd"), "scene.items[4].heights.image: '/etc/passwd' leads out"},
        {with("/items/4/material/color/0", -0.1), "scene.items[4].material.color[0]: is not a number"},
        {with("/items/4/material/colorTexture/columns", 0), "scene.items[4].material.colorTexture.columns: is not"},
        {with("/items/4/material/colorTexture/tile/0", 0), "scene.items[4].material.colorTexture.tile[0]: is not"},
        {with("/items/4/material/holes/image", "a/../../b.png"), "scene.items[4].material.holes.image: 'a/.."},
        {with("/items/4/material/alpha", true), "scene.items[4].material.alpha: is not a text"},
        {with("/items/5/fog/density", -1), "scene.items[5].fog.density: is not a number"},
        {with("/items/6/light/intensity", "bright"), "scene.items[6].light.intensity: is not a number"},
        {with("/items", circle), "item \"item 7\": its group 3 does not stand before it"},
        {with("/items", twice), "its id 7 is used twice"},
        {with("/items", twoDrive), "item \"item 6\": the servos follow item \"item 4\" already"},
        {with("/items", noGroup), "its parent 4 is no group"},
        {with("/items", lightDrives), "item \"item 9\": servos cannot follow it"},
        {with("/device/shrink", 0.95), "scene.device.shrink: is not a number from 0.0 to 0.9"},
        {with("/device/holes/0/radius", 0), "scene.device.holes[0].radius: is not a number"},
        {with("/device/creases/thresholdDegrees", 181), "scene.device.creases.thresholdDegrees: is not a number"},
        {with("/device/material/colorTexture/image", "../../x.png"), "scene.device.material.colorTexture.image: "},
        {inRoom("/deviceColor/1", 1.1), "installation.deviceColor[1]: is not a number from 0.0 to 1.0"},
        {inRoom("/tableColor/2", -0.1), "installation.tableColor[2]: is not a number from 0.0 to 1.0"},
        {inRoom("/tableSize/0", 0), "installation.tableSize[0]: is not a number"},
        {with("/exposure", 0), "scene.exposure: is not a number"},
        {with("/showing", "nothing"), "scene.showing: 'nothing' is not known here"},
        {inRoom("", 3), "installation: is not an object"},
        {inRoom("/viewer", 1), "installation.viewer: is not a text"},
        {with("/viewDependence/thetaDegrees", 0), "scene.viewDependence.thetaDegrees: is not a number"},
        {inRoom("/predictionSeconds", 2), "installation.predictionSeconds: is not a number"},
        {inRoom("/projectors", "none"), "installation.projectors: is not a list"},
        {inRoom("/projectors", json(17, json::object())),
         "installation.projectors: has 17 entries, and 16 is the most"},
        {inRoom("/projectors/0/camera/size", {0, 0}), "installation.projectors[0].camera.size[0]: is not a number"},
        {inRoom("/projectors/0/camera/focal/1", 0), "installation.projectors[0].camera.focal[1]: is not a number"},
        {inRoom("/projectors/0/camera/cameraFromWorld/5", 9),
         "projector \"Beamer\": camera.cameraFromWorld is not a rotation and a translation"},
        {inRoom("/projectors/0/poseOrigin/way", "guessed"),
         "installation.projectors[0].poseOrigin.way: 'guessed' is not known here"},
        {inRoom("/cameras", json(17, json::object())), "installation.cameras: has 17 entries, and 16 is the most"},
        {inRoom("/cameras/0/camera/focal/0", 0), "installation.cameras[0].camera.focal[0]: is not a number"},
        {inRoom("/cameras/0/camera/cameraFromWorld/0", 9),
         "camera \"Kamera \"links\"\": camera.cameraFromWorld is not"},
        {inRoom("/eye/1", 101), "installation.eye[1]: is not a number from -100.0 to 100.0"},
        {inRoom("/eyeFromHead/2", 1.5), "installation.eyeFromHead[2]: is not a number from -1.0 to 1.0"},
        {inRoom("/compensation", 1), "installation.compensation: is neither true nor false"},
        {inRoom("/tableOrigin/date", 7), "installation.tableOrigin.date: is not a text"},
        {inRoom("/worldFromDevice", json(16, 0)), "worldFromDevice is not a rotation and a translation"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.says);
        try {
            (void)parseProject(c.text, "/a/b.lumorph");
            ADD_FAILURE() << "was read";
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), "/a/b.lumorph");
            EXPECT_THAT(error.why(), HasSubstr(c.says));
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

TEST(SceneCheck, RefusesWhatCouldNotBeWritten) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::pair<std::function<void(Scene&)>, const char*>> cases = {
        {[&](Scene& s) { s.items[0].position.y = nan; }, "item \"item 7\": position is nan"},
        {[&](Scene& s) { s.items[0].rotation.w = nan; }, "rotation is no rotation"},
        {[](Scene& s) { s.items[1].parent = 1; }, "its group 1 does not stand before it"},
        {[](Scene& s) { s.items[0].id = -1; }, "id is -1"},
        {[](Scene& s) { s.items[4].material.roughness = 1.5F; }, "material.roughness is 1.5, not a number from 0 to 1"},
        {[](Scene& s) { s.items.resize(501); }, "items are 501, and 500 is the most"},
        {[](Scene& s) { s.device.shrink = -0.1; }, "device.shrink is -0.1"},
        {[&](Scene& s) { std::get<HeightItem>(s.items[4].kind).waves[0].phase = Angle::radians(nan); }, "phase"},
    };
    checkScene(test::fullScene());
    checkScene(defaultScene());
    for (const auto& [spoil, says] : cases) {
        Scene scene = test::fullScene();
        spoil(scene);
        try {
            checkScene(scene);
            ADD_FAILURE() << says << " was accepted";
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), HasSubstr(says));
        }
        EXPECT_THROW((void)projectText(projectWith(scene)), InvalidInput) << says;
    }
}

TEST(SceneFormat, FollowsNoLinkOutOfItsFolder) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "project/pictures");
    std::ofstream(folder / "outside.png") << "a";
    fs::create_symlink("../../outside.png", folder / "project/pictures/sea.png");
    Project project = projectWith(test::fullScene());
    EXPECT_THROW(writeProject(project, folder / "project/a.lumorph"), InvalidInput);
    std::ofstream(folder / "project/a.lumorph") << projectText(project);
    try {
        (void)readProject(folder / "project/a.lumorph");
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_THAT(error.why(), HasSubstr("'pictures/sea.png' leads out"));
    }
}

TEST(SceneAssets, AreNamedOnceEachAndRenamedEverywhere) {
    Scene scene = test::fullScene();
    EXPECT_THAT(assetNames(scene), testing::ElementsAre("models/fish.glb", "pictures/relief.png", "pictures/sea.png"));
    renameAssets(scene, [](const std::string& name) -> std::string {
        if (name == "pictures/sea.png") return "p files/sea.png";
        if (name == "models/fish.glb") return "p files/fish.glb";
        return name.empty() ? "nonsense" : name;
    });
    EXPECT_THAT(assetNames(scene), testing::ElementsAre("p files/fish.glb", "p files/sea.png", "pictures/relief.png"));
    EXPECT_EQ(scene.table.material.holes.image, "p files/sea.png");
    EXPECT_EQ(scene.items[4].material.normalMaps[1].image, "p files/sea.png");
    EXPECT_EQ(scene.items[4].material.normalMaps[0].image, "");
}

} // namespace
} // namespace lumorph
