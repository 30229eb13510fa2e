#include "core/scene/installation.h"

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/project.h"
#include "tests/core/scene/scenes.h"

namespace lumorph {
namespace {

using nlohmann::json;
using test::fullInstallation;

using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
using Edit = void (*)(Installation&);

Project projectIn(const Installation& installation) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    project.installation = installation;
    return project;
}

TEST(Installation, ComesBackExactlyFromAProjectsText) {
    for (const Installation& installation : {fullInstallation(), defaultInstallation(), Installation{}}) {
        const std::string text = projectText(projectIn(installation));
        const Project back = parseProject(text, "a.lumorph");
        EXPECT_TRUE(back.installation == installation);
        EXPECT_TRUE(back.scene == defaultScene());
        EXPECT_EQ(projectText(back), text);
    }
}

TEST(Installation, IsReadableForOthers) {
    const json room = json::parse(projectText(projectIn(fullInstallation())))["installation"];
    EXPECT_EQ(room["tableSize"], json({1.5, 1.0}));
    EXPECT_EQ(room["deviceColor"], json::parse("[0.8, 0.7, 0.6]"));
    EXPECT_EQ(room["eyeFromHead"], json::parse("[0.01, -0.07, 0.09]"));
    EXPECT_EQ(room["viewer"], "nearest");
    EXPECT_EQ(room["predictionSeconds"], 0.08);
    EXPECT_EQ(room["worldFromDevice"][3], 0.02) << "row by row";
    EXPECT_EQ(room["projectors"][0]["name"], "Beamer");
    EXPECT_EQ(room["projectors"][0]["poseOrigin"]["way"], "entered");
    EXPECT_EQ(room["projectors"][0]["lensOrigin"]["method"], "structured light, 12 boards");
    EXPECT_EQ(room["cameras"][0]["address"], "camera2");
    EXPECT_EQ(room["delaysOrigin"]["date"], "2026-11-23T12:40:00Z");
    EXPECT_FALSE(room["projectors"][1].contains("lensOrigin")) << "what is assumed is not written";
    EXPECT_FALSE(json::parse(projectText(projectIn(defaultInstallation())))["installation"].contains("tableOrigin"));
}

TEST(Installation, SimulatedOriginsComeBackFromAProjectsText) {
    Installation room = defaultInstallation();
    room.origins.delays = {Origin::Way::simulated, "20 flashes", "2026-11-28T10:00:00Z"};
    const std::string text = projectText(projectIn(room));
    EXPECT_EQ(json::parse(text)["installation"]["delaysOrigin"]["way"], "simulated");
    EXPECT_EQ(parseProject(text, "a.lumorph").installation, room);
}

TEST(MarkSimulated, MarksWhatWasMeasuredSinceAndNothingElse) {
    Installation before = defaultInstallation();
    before.origins.tracker = {Origin::Way::measured, "touched dots, 12", "2026-11-20T10:00:00Z"};
    before.origins.table = {Origin::Way::entered, {}, "2026-11-20T10:00:00Z"};
    Installation made = before;
    made.origins.delays = {Origin::Way::measured, "20 flashes", "2026-11-28T10:00:00Z"};
    made.projectors.front().response = made.origins.delays;
    markSimulated(before, made);
    EXPECT_EQ(made.origins.delays.way, Origin::Way::simulated);
    EXPECT_EQ(made.origins.delays.method, "20 flashes");
    EXPECT_EQ(made.projectors.front().response.way, Origin::Way::simulated);
    EXPECT_EQ(made.origins.tracker, before.origins.tracker) << "measured before, in the room";
    EXPECT_EQ(made.origins.table, before.origins.table);
    EXPECT_EQ(made.origins.servos.way, Origin::Way::assumed);
    const Installation once = made;
    markSimulated(before, made);
    EXPECT_EQ(made, once);
}

TEST(RealParts, NamesWhatWasMeasuredOrEntered) {
    Installation room = defaultInstallation();
    room.origins.delays.way = room.projectors.front().pose.way = Origin::Way::simulated;
    EXPECT_THAT(realParts(room), testing::IsEmpty()) << "what is assumed or simulated is of no room";
    room.projectors.front().name = "Beamer";
    room.projectors.front().lens.way = Origin::Way::measured;
    room.origins.table.way = Origin::Way::entered;
    EXPECT_THAT(realParts(room), testing::ElementsAre("lens of Beamer", "table"));
}

/// An edit of one part, and where that part's origin stands.
struct PartEdit {
    const char* what;
    Edit edit;
    Origin& (*origin)(Installation&);
};

constexpr auto kFirstLens = [](Installation& i) -> Origin& { return i.projectors[0].lens; };
constexpr auto kFirstPose = [](Installation& i) -> Origin& { return i.projectors[0].pose; };
constexpr auto kFirstResponse = [](Installation& i) -> Origin& { return i.projectors[0].response; };
constexpr auto kCameraLens = [](Installation& i) -> Origin& { return i.cameras[0].lens; };
constexpr auto kCameraPose = [](Installation& i) -> Origin& { return i.cameras[0].pose; };
constexpr auto kColors = [](Installation& i) -> Origin& { return i.origins.colors; };
constexpr auto kDevicePlace = [](Installation& i) -> Origin& { return i.origins.devicePlace; };

const PartEdit kPartEdits[] = {
    {"picture size", [](Installation& i) { i.projectors[0].camera.size.x = 1280; }, kFirstLens},
    {"focal length", [](Installation& i) { i.projectors[0].camera.focal.y += 1.0; }, kFirstLens},
    {"principal point", [](Installation& i) { i.projectors[0].camera.principal.x -= 2.0; }, kFirstLens},
    {"distortion", [](Installation& i) { i.projectors[0].camera.distortion[4] = 0.01; }, kFirstLens},
    {"lens of another", [](Installation& i) { i.projectors[1].camera.focal.x += 1.0; },
     [](Installation& i) -> Origin& { return i.projectors[1].lens; }},
    {"pose", [](Installation& i) { i.projectors[0].camera.cameraFromWorld[3].x += 0.1; }, kFirstPose},
    {"reference distance", [](Installation& i) { i.projectors[0].referenceDistance = 1.5; }, kFirstResponse},
    {"peak", [](Installation& i) { i.projectors[0].peak = 4.0; }, kFirstResponse},
    {"gain", [](Installation& i) { i.projectors[0].gain.b = 0.5F; }, kFirstResponse},
    {"gamma", [](Installation& i) { i.projectors[0].gamma = 0.0; }, kFirstResponse},
    {"camera's lens", [](Installation& i) { i.cameras[0].camera.distortion[0] = 0.0; }, kCameraLens},
    {"camera's pose", [](Installation& i) { i.cameras[0].camera.cameraFromWorld[3].z += 0.1; }, kCameraPose},
    {"table's size", [](Installation& i) { i.tableSize.y = 0.7F; },
     [](Installation& i) -> Origin& { return i.origins.table; }},
    {"device carried", [](Installation& i) { i.worldFromDevice[3].x = 0.3F; }, kDevicePlace},
    {"device turned",
     [](Installation& i) {
         const glm::vec4 place = i.worldFromDevice[3];
         i.worldFromDevice = glm::mat4(1.0F);
         i.worldFromDevice[3] = place;
     },
     kDevicePlace},
    {"device's colour", [](Installation& i) { i.deviceColor.g = 0.1F; }, kColors},
    {"table's colour", [](Installation& i) { i.tableColor.r = 0.9F; }, kColors},
    {"eye in the head", [](Installation& i) { i.eyeFromHead.z = 0.0F; },
     [](Installation& i) -> Origin& { return i.origins.eyeOffset; }},
    {"delay", [](Installation& i) { i.predictionSeconds = 0.1; },
     [](Installation& i) -> Origin& { return i.origins.delays; }},
    {"age of poses", [](Installation& i) { i.trackerSeconds = 0.02; },
     [](Installation& i) -> Origin& { return i.origins.delays; }},
    {"black", [](Installation& i) { i.projectors[0].black.g = 0.01F; }, kFirstResponse},
    {"response",
     [](Installation& i) {
         i.projectors[0].responseCurve = {{}, {1.0, glm::vec3(1.0F)}};
     },
     kFirstResponse},
    {"tracker", [](Installation& i) { i.worldFromTracker[3].x = 0.2F; },
     [](Installation& i) -> Origin& { return i.origins.tracker; }},
    {"device on its body", [](Installation& i) { i.bodyFromDevice[3].y = -0.01F; },
     [](Installation& i) -> Origin& { return i.origins.deviceBody; }},
    {"pointer's tip", [](Installation& i) { i.pointerTip.y = -0.15F; },
     [](Installation& i) -> Origin& { return i.origins.pointer; }},
    {"servos", [](Installation& i) { i.servos[0].points[1].rising = 0.4; },
     [](Installation& i) -> Origin& { return i.origins.servos; }},
    {"a servo's lag", [](Installation& i) { i.servos[1].lagSeconds = 0.08; },
     [](Installation& i) -> Origin& { return i.origins.delays; }},
};

const Origin kByHand{Origin::Way::entered, {}, "2026-11-24T17:05:00Z"};
const Origin kCalibrated{Origin::Way::measured, "structured light, 14 boards", "2026-11-24T18:00:00Z"};

TEST(MarkOrigins, MarksThePartThatWasEditedAlone) {
    for (const PartEdit& row : kPartEdits) {
        const Installation before = fullInstallation();
        Installation edited = before;
        row.edit(edited);
        ASSERT_FALSE(edited == before) << row.what;
        Installation expected = edited;
        row.origin(expected) = kByHand;
        markOrigins(before, edited, kByHand);
        EXPECT_TRUE(edited == expected) << row.what;
    }
}

TEST(MarkOrigins, LeavesTheOriginThatAnEditBrings) {
    for (const PartEdit& row : kPartEdits) {
        Installation edited = fullInstallation();
        row.edit(edited);
        row.origin(edited) = kCalibrated;
        const Installation brought = edited;
        markOrigins(fullInstallation(), edited, kByHand);
        EXPECT_TRUE(edited == brought) << row.what;
    }
}

TEST(MarkOrigins, MarksNothingWhereNoFigureChanges) {
    const std::pair<const char*, Edit> edits[] = {
        {"nothing", [](Installation&) {}},
        {"a name", [](Installation& i) { i.projectors[0].name = "Other"; }},
        {"on", [](Installation& i) { i.projectors[0].enabled = true; }},
        {"the eye of nobody", [](Installation& i) { i.eye.x = 1.0F; }},
        {"whom to follow", [](Installation& i) { i.viewer = ViewerChoice::first; }},
        {"compensation", [](Installation& i) { i.compensation = true; }},
        {"where it is sharp",
         [](Installation& i) {
             i.projectors[0].focus = {0.008, 1.7};
         }},
        {"a camera's name", [](Installation& i) { i.cameras[0].name = "Right"; }},
        {"a camera's address", [](Installation& i) { i.cameras[0].address = "camera0"; }},
        {"an origin", [](Installation& i) { i.origins.table = kCalibrated; }},
    };
    for (const auto& [what, edit] : edits) {
        Installation edited = fullInstallation();
        edit(edited);
        const Installation expected = edited;
        markOrigins(fullInstallation(), edited, kByHand);
        EXPECT_TRUE(edited == expected) << what;
    }
}

TEST(MarkOrigins, KnowsProjectorsAndCamerasByNameWhenOthersComeAndGo) {
    const Installation before = fullInstallation();
    Installation fewer = before;
    fewer.projectors.erase(fewer.projectors.begin());
    fewer.cameras.erase(fewer.cameras.begin());
    Installation expected = fewer;
    markOrigins(before, fewer, kByHand);
    EXPECT_TRUE(fewer == expected) << "the first was taken away";

    Installation swapped = before;
    std::swap(swapped.projectors[0], swapped.projectors[1]);
    std::swap(swapped.cameras[0], swapped.cameras[1]);
    expected = swapped;
    markOrigins(before, swapped, kByHand);
    EXPECT_TRUE(swapped == expected) << "in another order";

    Installation more = before;
    more.projectors.push_back(before.projectors[0]);
    more.projectors.back().name = "Third";
    more.projectors.back().camera.focal *= 2.0;
    more.projectors.back().lens = kCalibrated;
    expected = more;
    markOrigins(before, more, kByHand);
    EXPECT_TRUE(more == expected) << "a new one says itself where it came from";
}

TEST(SameRoom, IgnoresTheSimulatedEyeAndOriginsAndNothingElse) {
    const std::tuple<const char*, Edit, bool> rows[] = {
        {"nothing", [](Installation&) {}, true},
        {"eye",
         [](Installation& i) {
             i.eye = {0.3F, 0.4F, 0.5F};
         },
         true},
        {"lens origin", [](Installation& i) { i.projectors[0].lens = {}; }, true},
        {"pose origin", [](Installation& i) { i.projectors[0].pose = kCalibrated; }, true},
        {"response origin", [](Installation& i) { i.projectors[1].response = kByHand; }, true},
        {"camera's lens origin", [](Installation& i) { i.cameras[0].lens = {}; }, true},
        {"camera's pose origin", [](Installation& i) { i.cameras[1].pose = kCalibrated; }, true},
        {"table origin", [](Installation& i) { i.origins.table.way = Origin::Way::entered; }, true},
        {"device place origin", [](Installation& i) { i.origins.devicePlace.method = "other"; }, true},
        {"colours origin", [](Installation& i) { i.origins.colors.date = ""; }, true},
        {"eye offset origin", [](Installation& i) { i.origins.eyeOffset = {}; }, true},
        {"delays origin", [](Installation& i) { i.origins.delays = {}; }, true},
        {"projector's name", [](Installation& i) { i.projectors[0].name = "Other"; }, false},
        {"projector on", [](Installation& i) { i.projectors[0].enabled = true; }, false},
        {"picture size", [](Installation& i) { i.projectors[0].camera.size.y = 800; }, false},
        {"focal length", [](Installation& i) { i.projectors[0].camera.focal.x += 1e-3; }, false},
        {"principal point", [](Installation& i) { i.projectors[0].camera.principal.y += 1e-3; }, false},
        {"distortion", [](Installation& i) { i.projectors[0].camera.distortion[2] += 1e-6; }, false},
        {"pose", [](Installation& i) { i.projectors[1].camera.cameraFromWorld[3].y += 1e-6; }, false},
        {"reference distance", [](Installation& i) { i.projectors[0].referenceDistance = 2.0; }, false},
        {"focus", [](Installation& i) { i.projectors[0].focus.focusDistance = 1.7; }, false},
        {"peak", [](Installation& i) { i.projectors[0].peak = 2.6; }, false},
        {"gain", [](Installation& i) { i.projectors[0].gain.r = 1.0F; }, false},
        {"gamma", [](Installation& i) { i.projectors[0].gamma = 2.3; }, false},
        {"one projector less", [](Installation& i) { i.projectors.pop_back(); }, false},
        {"one projector more", [](Installation& i) { i.projectors.emplace_back(); }, false},
        {"camera's name", [](Installation& i) { i.cameras[0].name = "Other"; }, false},
        {"camera's address", [](Installation& i) { i.cameras[0].address = ""; }, false},
        {"camera's lens", [](Installation& i) { i.cameras[0].camera.focal.x += 1e-3; }, false},
        {"camera's pose", [](Installation& i) { i.cameras[0].camera.cameraFromWorld[3].x += 1e-6; }, false},
        {"no camera", [](Installation& i) { i.cameras.clear(); }, false},
        {"table size", [](Installation& i) { i.tableSize.x = 1.6F; }, false},
        {"device's place", [](Installation& i) { i.worldFromDevice[3].z = 0.0F; }, false},
        {"device's colour", [](Installation& i) { i.deviceColor.r = 1.0F; }, false},
        {"table's colour", [](Installation& i) { i.tableColor.b = 1.0F; }, false},
        {"eye from head", [](Installation& i) { i.eyeFromHead.x = 0.0F; }, false},
        {"viewer", [](Installation& i) { i.viewer = ViewerChoice::none; }, false},
        {"compensation", [](Installation& i) { i.compensation = true; }, false},
        {"delay", [](Installation& i) { i.predictionSeconds = 0.07; }, false},
        {"servos",
         [](Installation& i) {
             i.servos = {{"flap 1", {{}, {1.0, 0.9, 0.92}}, 0.08}};
         },
         false},
    };
    const Installation room = fullInstallation();
    for (const auto& [what, edit, same] : rows) {
        Installation other = room;
        edit(other);
        EXPECT_EQ(isSameRoom(room, other), same) << what;
        EXPECT_EQ(isSameRoom(other, room), same) << what;
    }
}

TEST(InstallationCheck, RefusesWhatCouldNotBeWrittenAndSaysWhoseItIs) {
    const std::tuple<Edit, const char*, const char*> cases[] = {
        {[](Installation& i) { i.eye.x = INFINITY; }, "installation", "eye is inf"},
        {[](Installation& i) { i.eye.y = kNaN; }, "installation", "eye is nan"},
        {[](Installation& i) { i.eye.z = 101.0F; }, "installation", "eye is 101, not a number from -100 to 100"},
        {[](Installation& i) { i.eyeFromHead.y = kNaN; }, "installation", "eyeFromHead is nan"},
        {[](Installation& i) { i.eyeFromHead.y = 1.5F; }, "installation", "eyeFromHead is 1.5"},
        {[](Installation& i) { i.tableSize.x = 0.0F; }, "installation", "tableSize is 0"},
        {[](Installation& i) { i.tableSize.y = kNaN; }, "installation", "tableSize is nan"},
        {[](Installation& i) { i.deviceColor.g = 1.1F; }, "installation", "deviceColor is 1.1"},
        {[](Installation& i) { i.tableColor.b = kNaN; }, "installation", "tableColor is nan"},
        {[](Installation& i) { i.predictionSeconds = std::nan(""); }, "installation", "predictionSeconds is nan"},
        {[](Installation& i) { i.predictionSeconds = -0.01; }, "installation", "predictionSeconds is -0.01"},
        {[](Installation& i) { i.worldFromDevice = glm::mat4(2.0F); }, "installation",
         "worldFromDevice is not a rotation"},
        {[](Installation& i) { i.worldFromDevice[3].x = kNaN; }, "installation", "worldFromDevice is nan"},
        {[](Installation& i) { i.bodyFromDevice = glm::mat4(2.0F); }, "installation",
         "bodyFromDevice is not a rotation"},
        {[](Installation& i) {
             i.servos = {{"flap 1", {{0.5, 0.5, 0.5}, {0.5, 0.6, 0.6}}, 0.0}};
         },
         "servo \"flap 1\"", "points.commanded does not rise from 0 to 1"},
        {[](Installation& i) {
             i.servos = {{"flap 1", {{}, {0.5, 0.5, 3.0}, {1.0, 1.0, 1.0}}, 0.0}};
         },
         "installation", "servos[0].points[1].falling is 3"},
        {[](Installation& i) {
             i.projectors[0].responseCurve = {{}, {0.9, glm::vec3(1.0F)}};
         },
         "projector \"Beamer\"", "responseCurve.value does not rise from 0 to 1"},
        {[](Installation& i) { i.projectors.resize(17); }, "installation", "projectors are 17, and 16 is the most"},
        {[](Installation& i) { i.cameras.resize(17); }, "installation", "cameras are 17, and 16 is the most"},
        {[](Installation& i) { i.origins.table.method = std::string(1001, 'x'); }, "installation",
         "tableOrigin.method is too long"},
        {[](Installation& i) { i.projectors[0].camera.focal.x = 0.0; }, "projector \"Beamer\"", "camera.focal is 0"},
        {[](Installation& i) { i.projectors[0].camera.focal.y = std::nan(""); }, "projector \"Beamer\"",
         "camera.focal is nan"},
        {[](Installation& i) {
             i.projectors[0].camera.size = {0, 10};
         },
         "projector \"Beamer\"", "camera.size is 0"},
        {[](Installation& i) { i.projectors[0].camera.distortion[1] = std::nan(""); }, "projector \"Beamer\"",
         "camera.distortion is nan"},
        {[](Installation& i) { i.projectors[0].camera.cameraFromWorld[1][1] *= -1.0; }, "projector \"Beamer\"",
         "camera.cameraFromWorld is not a"},
        {[](Installation& i) { i.projectors[0].peak = std::nan(""); }, "projector \"Beamer\"", "peak is nan"},
        {[](Installation& i) { i.projectors[0].gain.b = 0.0F; }, "projector \"Beamer\"", "gain is 0"},
        {[](Installation& i) { i.projectors[1].gamma = std::nan(""); }, "projector \"Projector\"", "gamma is nan"},
        {[](Installation& i) { i.cameras[0].camera.principal.x = std::nan(""); }, "camera \"Kamera \"links\"\"",
         "camera.principal is nan"},
    };
    EXPECT_NO_THROW(checkInstallation(fullInstallation()));
    EXPECT_NO_THROW(checkInstallation(defaultInstallation()));
    EXPECT_NO_THROW(checkInstallation({}));
    for (const auto& [spoil, whose, says] : cases) {
        Installation installation = fullInstallation();
        spoil(installation);
        try {
            checkInstallation(installation);
            ADD_FAILURE() << whose << ": " << says << " was accepted";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(error.subject(), whose);
            EXPECT_THAT(error.why(), HasSubstr(says));
            EXPECT_FALSE(error.remedy().empty());
        }
        EXPECT_THROW((void)projectText(projectIn(installation)), InvalidInput) << says;
    }
}

TEST(UtcDate, IsNowInOneForm) {
    EXPECT_THAT(utcDate(),
                testing::MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]Z"));
}

} // namespace
} // namespace lumorph
