#include <limits>

#include <gtest/gtest.h>

#include "app/studio/document/scene_edit.h"
#include "app/studio/document/scene_files.h"
#include "app/workspaces/scene/euler.h"
#include "app/workspaces/scene/projector_pose.h"
#include "app/workspaces/scene/projector_reach.h"
#include "app/workspaces/scene/sun_path.h"
#include "core/scene/project.h"
#include "tests/ui/project_world.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using test::ProjectWorld;
using test::SessionFiles;

SceneItem box(const std::string& name = "Box") {
    SceneItem item;
    item.name = name;
    item.kind = ShapeItem{};
    return item;
}

SceneItem group(const std::string& name) {
    SceneItem item;
    item.name = name;
    return item;
}

std::vector<std::string> namesOf(const Scene& scene) {
    std::vector<std::string> names;
    for (const SceneItem& item : scene.items) names.push_back(item.name);
    return names;
}

int idOf(const Scene& scene, const std::string& name) {
    for (const SceneItem& item : scene.items)
        if (item.name == name) return item.id;
    return 0;
}

Scene emptied() {
    Scene scene = defaultScene();
    scene.items.clear();
    return scene;
}

struct SceneDocument : testing::Test {
    SceneDocument() { test::needApplication(); }
    [[nodiscard]] const Scene& scene() const { return *document.state().scene; }
    [[nodiscard]] const Installation& room() const { return *document.state().installation; }
    StudioDocument document;
};

TEST_F(SceneDocument, EveryKindOfEditIsAStepThatComesBackExactly) {
    ASSERT_TRUE(document.state().scene) << "a new document has a scene";
    editScene(document, "Add", [](Scene& s) { addItem(s, box("Changed")); });
    const int id = idOf(scene(), "Changed");
    const auto item = [id](Scene& s) -> SceneItem& { return *itemOf(s, id); };
    const std::vector<std::pair<const char*, SceneEdit>> edits = {
        {"add", [](Scene& s) { addItem(s, box()); }},
        {"add a group", [](Scene& s) { addItem(s, group("Group")); }},
        {"move into it", [id](Scene& s) { moveItem(s, id, idOf(s, "Group")); }},
        {"duplicate", [id](Scene& s) { duplicateItem(s, id); }},
        {"rename", [&](Scene& s) { item(s).name = "Other"; }},
        {"hide", [&](Scene& s) { item(s).visible = false; }},
        {"role", [id](Scene& s) { setItemRole(s, id, ItemRole::physical); }},
        {"place",
         [&](Scene& s) {
             item(s).position = {0.1F, 0.2F, 0.3F};
         }},
        {"turn", [&](Scene& s) { item(s).rotation = glm::angleAxis(0.5F, glm::vec3(0, 1, 0)); }},
        {"motion",
         [&](Scene& s) {
             item(s).motion = {0.4, 0.01, 2.0};
         }},
        {"material",
         [&](Scene& s) {
             item(s).material.color = {0.1F, 0.2F, 0.3F};
         }},
        {"texture",
         [&](Scene& s) {
             item(s).material.colorTexture.velocity = {0.1F, 0.0F};
         }},
        {"kind", [&](Scene& s) { item(s).kind = HeightItem{}; }},
        {"skin", [](Scene& s) { s.device.shrink = 0.3; }},
        {"holes",
         [](Scene& s) {
             s.device.holes.push_back({{0.01F, 0.02F}, 0.01});
         }},
        {"table",
         [](Scene& s) {
             s.table.material.color = {0.2F, 0.1F, 0.3F};
         }},
        {"view dependence",
         [](Scene& s) {
             s.viewDependence = {true, Angle::degrees(60.0)};
         }},
        {"showing", [](Scene& s) { s.showing = Showing::physical; }},
        {"delete", [id](Scene& s) { removeItem(s, id); }},
    };
    std::vector<Scene> scenes = {scene()};
    const int before = document.undoStack().count();
    for (const auto& [name, edit] : edits) {
        editScene(document, name, edit);
        EXPECT_FALSE(scene() == scenes.back()) << name << " was refused";
        EXPECT_EQ(document.undoStack().count(), before + static_cast<int>(scenes.size())) << name;
        scenes.push_back(scene());
    }
    for (std::size_t i = edits.size(); i-- > 0;) {
        document.undoStack().undo();
        EXPECT_TRUE(scene() == scenes[i]) << "undoing " << edits[i].first;
    }
    for (std::size_t i = 0; i < edits.size(); ++i) {
        document.undoStack().redo();
        EXPECT_TRUE(scene() == scenes[i + 1]) << "redoing " << edits[i].first;
    }
}

TEST_F(SceneDocument, EveryEditOfTheRoomIsAStepThatComesBackExactly) {
    ASSERT_TRUE(document.state().installation) << "a new document has a room";
    const std::vector<std::pair<const char*, InstallationEdit>> edits = {
        {"table",
         [](Installation& i) {
             i.tableSize = {2.0F, 1.0F};
         }},
        {"projector", [](Installation& i) { i.projectors.front().peak = 4.0; }},
        {"viewer", [](Installation& i) { i.viewer = ViewerChoice::first; }},
        {"eye",
         [](Installation& i) {
             i.eye = {0.2F, 0.4F, 0.6F};
         }},
        {"bare device", [](Installation& i) { i.deviceColor = glm::vec3(0.7F); }},
        {"no projector", [](Installation& i) { i.projectors.clear(); }},
    };
    const Scene shown = scene();
    std::vector<Installation> rooms = {room()};
    for (const auto& [name, edit] : edits) {
        editInstallation(document, name, edit);
        EXPECT_FALSE(room() == rooms.back()) << name << " was refused";
        EXPECT_EQ(document.undoStack().count(), static_cast<int>(rooms.size())) << name;
        rooms.push_back(room());
    }
    for (std::size_t i = edits.size(); i-- > 0;) {
        document.undoStack().undo();
        EXPECT_TRUE(room() == rooms[i]) << "undoing " << edits[i].first;
    }
    for (std::size_t i = 0; i < edits.size(); ++i) {
        document.undoStack().redo();
        EXPECT_TRUE(room() == rooms[i + 1]) << "redoing " << edits[i].first;
    }
    EXPECT_TRUE(scene() == shown) << "what is shown stays";
    EXPECT_EQ(rooms[1].origins.table.way, Origin::Way::entered) << "what is edited was entered by hand";
    EXPECT_FALSE(rooms[1].origins.table.date.empty());
    EXPECT_EQ(rooms[1].projectors.front().response, Origin());
    EXPECT_EQ(rooms[2].projectors.front().response.way, Origin::Way::entered);
    EXPECT_EQ(rooms[2].projectors.front().pose, Origin());
}

TEST_F(SceneDocument, AnEditOfTheRoomThatIsNotSoundIsRefused) {
    const Installation before = room();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::pair<const char*, InstallationEdit>> edits = {
        {"no number", [nan](Installation& i) { i.eye.x = nan; }},
        {"no picture",
         [](Installation& i) {
             i.projectors.front().camera.size = {0, 0};
         }},
        {"no table", [](Installation& i) { i.tableSize.x = 0.0F; }},
        {"no rotation", [](Installation& i) { i.worldFromDevice[0][0] = 2.0F; }},
    };
    for (const auto& [name, edit] : edits) {
        editInstallation(document, name, edit);
        previewInstallation(document, edit);
        document.cancelPreview();
        EXPECT_TRUE(room() == before) << name;
    }
    EXPECT_EQ(document.undoStack().count(), 0);
}

TEST_F(SceneDocument, AnEditThatIsNotSoundIsRefused) {
    editScene(document, "Add", [](Scene& s) { addItem(s, box()); });
    editScene(document, "Add", [](Scene& s) { addItem(s, box()); });
    const Scene before = scene();
    const int steps = document.undoStack().count();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::pair<const char*, SceneEdit>> edits = {
        {"no number", [nan](Scene& s) { s.items.back().position.x = nan; }},
        {"no size",
         [](Scene& s) {
             s.items.back().kind = ShapeItem{ShapeItem::Form::box, glm::vec3(-1.0F)};
         }},
        {"two ids", [](Scene& s) { s.items.back().id = s.items.front().id; }},
        {"two for the servos",
         [](Scene& s) {
             for (SceneItem& item : s.items)
                 if (item.name.starts_with("Box")) item.role = ItemRole::physical;
         }},
        {"an unknown group", [](Scene& s) { s.items.back().parent = 99; }},
    };
    for (const auto& [name, edit] : edits) {
        editScene(document, name, edit);
        previewScene(document, edit);
        document.cancelPreview();
        EXPECT_TRUE(scene() == before) << name;
    }
    EXPECT_EQ(document.undoStack().count(), steps);
}

TEST_F(SceneDocument, TheServosFollowOneThingAtATime) {
    Scene scene = emptied();
    const int first = addItem(scene, box());
    const int second = addItem(scene, box());
    setItemRole(scene, first, ItemRole::split);
    setItemRole(scene, second, ItemRole::physical);
    EXPECT_EQ(drivingItem(scene)->id, second);
    EXPECT_EQ(findItem(scene, first)->role, ItemRole::virtualOnly);
    const int copy = duplicateItem(scene, second);
    EXPECT_EQ(findItem(scene, copy)->role, ItemRole::virtualOnly);
    EXPECT_EQ(drivingItem(scene)->id, second);
    EXPECT_NO_THROW(checkScene(scene));
}

TEST_F(SceneDocument, GroupsKeepTheirMembersBehindThem) {
    Scene scene = emptied();
    addItem(scene, box("a"));
    const int outer = addItem(scene, group("outer"));
    const int inner = addItem(scene, group("inner"), outer);
    const int leaf = addItem(scene, box("leaf"), inner);
    addItem(scene, box("z"));
    ASSERT_EQ(namesOf(scene), (std::vector<std::string>{"a", "outer", "inner", "leaf", "z"}));

    EXPECT_FALSE(moveItem(scene, outer, inner)) << "a group within itself";
    EXPECT_FALSE(moveItem(scene, outer, idOf(scene, "a"))) << "a box holds nothing";
    EXPECT_FALSE(moveItem(scene, 77, 0));
    EXPECT_TRUE(moveItem(scene, idOf(scene, "z"), inner, leaf));
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"a", "outer", "inner", "z", "leaf"}));
    EXPECT_TRUE(moveItem(scene, inner, 0, idOf(scene, "a")));
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"inner", "z", "leaf", "a", "outer"}));
    EXPECT_NO_THROW(checkScene(scene));

    const int copy = duplicateItem(scene, inner);
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"inner", "z", "leaf", "inner 2", "z", "leaf", "a", "outer"}));
    EXPECT_EQ(itemsWithin(scene, copy).size(), 3U);
    EXPECT_NO_THROW(checkScene(scene));
    removeItem(scene, inner);
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"inner 2", "z", "leaf", "a", "outer"}));
    EXPECT_EQ(findItem(scene, leaf), nullptr);
}

TEST_F(SceneDocument, NamesCount) {
    Scene scene = emptied();
    for (int i = 0; i < 3; ++i) addItem(scene, box());
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"Box", "Box 2", "Box 3"}));
    duplicateItem(scene, idOf(scene, "Box 2"));
    EXPECT_EQ(namesOf(scene), (std::vector<std::string>{"Box", "Box 2", "Box 4", "Box 3"}));
}

TEST(HeadingTiltRoll, ComesBackAsTheSameRotation) {
    for (const double heading : {-2.5, 0.0, 1.0, 3.0})
        for (const double tilt : {-1.5707963267948966, -1.2, 0.0, 0.7, 1.5707963267948966})
            for (const double roll : {-1.4, 0.0, 2.0}) {
                const glm::dquat rotation = fromHeadingTiltRoll({heading, tilt, roll});
                const glm::dquat again = fromHeadingTiltRoll(headingTiltRoll(rotation));
                EXPECT_NEAR(std::abs(glm::dot(rotation, again)), 1.0, 1e-7) << heading << ' ' << tilt << ' ' << roll;
            }
}

TEST(SunPath, TheHourMovesTheSunAlongItsArc) {
    const glm::vec3 noon = sunAt(12.0, {0.0F, 1.0F, -0.5F});
    EXPECT_NEAR(noon.x, 0.0F, 1e-6F);
    EXPECT_NEAR(noon.z / noon.y, -0.5F, 1e-5F) << "the arc leads through where it was";
    for (const double hour : {6.5, 9.0, 12.0, 15.25, 17.5}) {
        const glm::vec3 sun = sunAt(hour, noon);
        EXPECT_NEAR(glm::length(sun), 1.0F, 1e-6F);
        EXPECT_NEAR(hourOf(sun), hour, 1e-4);
        EXPECT_NEAR(sun.z / sun.y, -0.5F, 1e-4F);
        EXPECT_GT(sun.y, 0.0F);
    }
    EXPECT_GT(sunAt(8.0, noon).x, 0.5F) << "mornings it stands on the right";
    EXPECT_LT(sunAt(16.0, noon).x, -0.5F);
}

TEST(ProjectorPose, IsCarriedAndTurnedAsTyped) {
    CalibratedCamera camera = defaultInstallation().projectors.front().camera;
    const auto looked = lookPoint(camera);
    ASSERT_TRUE(looked);
    carryTo(camera, positionOf(camera) + glm::dvec3(0.3, 0.0, 0.1));
    EXPECT_NEAR(lookPoint(camera)->x, looked->x + 0.3, 1e-9) << "it keeps its direction";
    EXPECT_NEAR(lookPoint(camera)->y, looked->y + 0.1, 1e-9);
    const glm::dvec3 position = positionOf(camera);
    lookAt(camera, {0.05, -0.12});
    EXPECT_NEAR(lookPoint(camera)->x, 0.05, 1e-7);
    EXPECT_NEAR(lookPoint(camera)->y, -0.12, 1e-7);
    EXPECT_NEAR(glm::length(positionOf(camera) - position), 0.0, 1e-9);
    EXPECT_NO_THROW(checkCamera(camera));
}

// R42: what the light does not reach well is told.
struct ProjectorReachTest : testing::Test {
    [[nodiscard]] studio::ProjectorReach reach(const glm::vec3& albedo = glm::vec3(1.0F)) const {
        const std::vector<glm::vec3> positions = {{0, 0, 0}, {0.1F, 0, 0}, {0.1F, 0, 0.1F}, {0, 0, 0.1F}};
        return reachOf(projector, albedo, positions, {{0, 3, 2}, {0, 2, 1}}, glm::mat4(1.0F));
    }
    /// Above the flat square, from where it looks straight down.
    InstalledProjector projector = [] {
        InstalledProjector made;
        made.camera = cameraLookingAt({0.05, 2.0, 0.05}, {0.05, 0.0, 0.05}, {1280, 800}, 3000.0);
        made.referenceDistance = 2.0;
        made.peak = 3.0;
        return made;
    }();
};

TEST_F(ProjectorReachTest, TellsWhatIsMissedAndWhatIsMetAtTooSteepAnAngle) {
    EXPECT_NEAR(reach().missed, 0.0, 1e-9);
    EXPECT_NEAR(reach().steep, 0.0, 1e-9);
    // Carried 7 m to the side it meets the flat square at 74 degrees.
    lookAt(projector.camera, {0.05, 0.05});
    carryTo(projector.camera, {7.05, 2.0, 0.05});
    EXPECT_NEAR(reach().missed, 1.0, 1e-9);
    lookAt(projector.camera, {0.05, 0.05});
    EXPECT_NEAR(reach().steep, 1.0, 1e-9);
    carryTo(projector.camera, {4.05, 2.0, 0.05});
    lookAt(projector.camera, {0.05, 0.05});
    EXPECT_NEAR(reach().steep, 0.0, 1e-9) << "63 degrees are not steep";
}

TEST_F(ProjectorReachTest, TellsWhatItCannotMakeWhite) {
    EXPECT_NEAR(reach().dim, 0.0, 1e-9);
    EXPECT_NEAR(reach(glm::vec3(0.4F)).dim, 0.0, 1e-9) << "1.2 of white";
    EXPECT_NEAR(reach(glm::vec3(0.25F)).dim, 1.0, 1e-9) << "0.75 of white";
    EXPECT_NEAR(reach({1.0F, 1.0F, 0.25F}).dim, 1.0, 1e-9) << "yellow at most";
    projector.gain.b = 0.25F;
    EXPECT_NEAR(reach().dim, 1.0, 1e-9) << "the lamp lacks blue";
    projector.gain.b = 1.0F;
    projector.referenceDistance = 1.0;
    EXPECT_NEAR(reach().dim, 1.0, 1e-9) << "a quarter of 3 at twice the distance";
    projector.referenceDistance = 2.0;
    // At 4 m to the side and 4.5 m away: 3 x cos 63 x (2 / 4.47)^2 = 0.27.
    carryTo(projector.camera, {4.05, 2.0, 0.05});
    lookAt(projector.camera, {0.05, 0.05});
    EXPECT_NEAR(reach().dim, 1.0, 1e-9);
    projector.peak = 12.0;
    EXPECT_NEAR(reach().dim, 0.0, 1e-9);
}

/// A picture of its own colour.
void writePicture(const fs::path& file, std::uint8_t red) {
    Image image({8, 8}, {red, 20, 30, 255});
    writePng(image, file);
}

struct SceneFiles : testing::Test {
    SceneFiles() {
        world.openRig(files / "cushion.glb");
        picture = (files / "red.png").string();
        writePicture(picture, 200);
    }
    void use(const std::string& asset) {
        editScene(world.document, "Choose a picture",
                  [&](Scene& scene) { scene.device.material.colorTexture.image = asset; });
    }
    /// What is in memory of an asset; the red of its first pixel, or -1.
    static int redOf(const ProjectWorld& of, const std::string& asset) {
        const auto& assets = of.state().assets;
        if (!assets || !assets->images.contains(asset)) return -1;
        return assets->images.at(asset)->at(0, 0)[0];
    }
    static const std::string& named(const ProjectWorld& of) {
        return of.state().scene->device.material.colorTexture.image;
    }
    [[nodiscard]] bool reads(int red) {
        return eventually([&] { return world.jobs.running().empty() && redOf(world, named(world)) == red; });
    }

    SessionFiles files;
    ProjectWorld world;
    std::string picture;
};

TEST_F(SceneFiles, APictureIsReadBesideTheWindowAndKeptByUndo) {
    use(picture);
    ASSERT_TRUE(reads(200));
    world.document.undoStack().undo();
    EXPECT_NE(named(world), picture);
    world.document.undoStack().redo();
    EXPECT_EQ(redOf(world, picture), 200) << "undo leaves what was read as it is";
}

TEST_F(SceneFiles, AProjectTakesItsPicturesAlong) {
    use(picture);
    ASSERT_TRUE(reads(200));
    editInstallation(world.document, "Measure", [](Installation& installation) {
        installation.deviceColor = {0.7F, 0.6F, 0.5F};
        installation.projectors.front().peak = 2.2;
    });
    fs::create_directories(files / "there");
    world.service.saveAs(files / "there/show.lumorph");
    EXPECT_FALSE(world.document.modified());
    fs::remove(picture);
    const std::string inside = readProject(files / "there/show.lumorph").scene.device.material.colorTexture.image;
    EXPECT_TRUE(isAssetName(inside)) << inside;

    fs::rename(files / "there", files / "elsewhere");
    ProjectWorld other;
    other.service.open(files / "elsewhere/show.lumorph");
    ASSERT_TRUE(eventually([&] { return other.jobs.running().empty() && redOf(other, named(other)) == 200; }));
    EXPECT_TRUE(other.notices.at("scene").empty());
    EXPECT_FALSE(other.document.modified());
    EXPECT_TRUE(fs::path(named(other)).is_absolute());
    Scene sameNames = *other.state().scene;
    sameNames.device.material.colorTexture.image = picture;
    EXPECT_TRUE(sameNames == *world.state().scene);
    EXPECT_TRUE(readProject(files / "elsewhere/show.lumorph").installation == *world.state().installation)
        << "a copy of the room it was shown in";
    EXPECT_TRUE(*other.state().installation == defaultInstallation())
        << "opening a project changes nothing in the room";
}

TEST_F(SceneFiles, APictureThatVanishedIsSavedFromMemory) {
    use(picture);
    ASSERT_TRUE(reads(200));
    fs::remove(picture);
    world.service.saveAs(files / "show.lumorph");
    EXPECT_TRUE(world.notices.at("project").empty());
    ProjectWorld other;
    other.service.open(files / "show.lumorph");
    EXPECT_TRUE(eventually([&] { return other.jobs.running().empty() && redOf(other, named(other)) == 200; }));
}

TEST_F(SceneFiles, ABrokenPictureIsAPlaceholderWithANoticeAndCanBeRelinked) {
    files.writeText("broken.png", "this is no picture");
    const std::string broken = (files / "broken.png").string();
    use(broken);
    ASSERT_TRUE(eventually([&] { return world.jobs.running().empty() && !world.notices.at("scene").empty(); }));
    EXPECT_TRUE(world.state().assets->images.contains(broken)) << "a placeholder stands in";
    const Notice told = world.notice("scene");
    EXPECT_EQ(told.subject, "broken.png");
    EXPECT_FALSE(told.why.isEmpty());
    ASSERT_FALSE(told.actions.empty());
    EXPECT_EQ(told.actions.front().text, "Relink...");
    QString asked;
    QObject::connect(&world.service, &ProjectService::chooseAsset, [&](const QString& asset) { asked = asset; });
    told.actions.front().run();
    EXPECT_EQ(asked.toStdString(), broken);

    const int steps = world.document.undoStack().count();
    world.service.relink(broken, picture);
    ASSERT_TRUE(reads(200));
    EXPECT_EQ(named(world), picture);
    EXPECT_EQ(world.document.undoStack().count(), steps + 1);
    EXPECT_TRUE(world.notices.at("scene").empty());

    world.document.undoStack().undo();
    world.service.saveAs(files / "show.lumorph"); // what is broken is still named, and nothing else is lost
    EXPECT_TRUE(world.notices.at("project").empty());
    EXPECT_EQ(fs::path(readProject(files / "show.lumorph").scene.device.material.colorTexture.image).filename(),
              "broken.png");
}

TEST_F(SceneFiles, AMissingPictureIsToldAndTheProjectOpens) {
    use(picture);
    ASSERT_TRUE(reads(200));
    fs::create_directories(files / "there");
    world.service.saveAs(files / "there/show.lumorph");
    const std::string inside = readProject(files / "there/show.lumorph").scene.device.material.colorTexture.image;
    ASSERT_TRUE(fs::remove(files / "there" / inside));
    ProjectWorld other;
    other.service.open(files / "there/show.lumorph");
    ASSERT_TRUE(eventually([&] { return other.jobs.running().empty() && !other.notices.at("scene").empty(); }));
    EXPECT_TRUE(other.state().rig.rig);
    EXPECT_EQ(other.notice("scene").subject.toStdString(), fs::path(inside).filename().string());
    other.service.relink(named(other), picture);
    EXPECT_TRUE(eventually([&] { return other.jobs.running().empty() && redOf(other, named(other)) == 200; }));
}

TEST_F(SceneFiles, APictureThatChangesOnDiskIsReadAgain) {
    use(picture);
    ASSERT_TRUE(reads(200));
    const int steps = world.document.undoStack().count();
    test::pass(std::chrono::milliseconds(500)); // its watch begins
    writePicture(picture, 90);
    EXPECT_TRUE(reads(90));
    EXPECT_EQ(world.document.undoStack().count(), steps) << "reading again is no step";
}

TEST_F(SceneFiles, ASessionKeepsTheSceneAndItsPictures) {
    use(picture);
    ASSERT_TRUE(reads(200));
    editScene(world.document, "Add", [](Scene& scene) { addItem(scene, box()); });
    const Scene kept = *world.state().scene;
    world.service.keepSession();
    {
        ProjectWorld next;
        bool ready = false;
        next.service.restoreSession([&] { ready = true; });
        ASSERT_TRUE(eventually([&] { return ready; }));
        EXPECT_TRUE(*next.state().scene == kept) << "its pictures go by the names they had";
        EXPECT_EQ(redOf(next, picture), 200);
    }
    fs::remove(picture);
    ProjectWorld last;
    bool ready = false;
    last.service.restoreSession([&] { ready = true; });
    ASSERT_TRUE(eventually([&] { return ready; }));
    EXPECT_EQ(redOf(last, named(last)), 200) << "a copy was kept";
    EXPECT_TRUE(last.notices.at("scene").empty());
}

} // namespace
} // namespace lumorph::studio
