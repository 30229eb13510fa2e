#include <array>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/project.h"

// Projects as earlier versions wrote them, kept as files: what they say is read here a second time, by itself.

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kFolder = LUMORPH_SOURCE_DIR "/tests/data/projects";

json documentOf(const char* name) {
    std::ifstream file(kFolder / name);
    return json::parse(file);
}

/// What a file says of a vector: each number as the value that this program keeps of it.
template <typename Vector> Vector vectorOf(const json& list) {
    Vector vector;
    EXPECT_EQ(list.size(), std::size_t(Vector::length()));
    for (int i = 0; i < Vector::length(); ++i)
        vector[i] = static_cast<typename Vector::value_type>(list.at(static_cast<std::size_t>(i)).get<double>());
    return vector;
}

/// The sixteen numbers stand row by row, and a matrix holds columns.
template <typename Matrix> Matrix matrixOf(const json& list) {
    Matrix matrix;
    EXPECT_EQ(list.size(), 16U);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = static_cast<typename Matrix::value_type>(
                list.at(static_cast<std::size_t>(4 * row + column)).get<double>());
    return matrix;
}

void expectProjector(const InstalledProjector& read, const json& file) {
    SCOPED_TRACE(read.name);
    EXPECT_EQ(read.name, file.at("name").get<std::string>());
    EXPECT_EQ(read.enabled, file.at("enabled").get<bool>());
    EXPECT_EQ(read.referenceDistance, file.at("referenceDistance").get<double>());
    EXPECT_EQ(read.peak, file.at("peak").get<double>());
    EXPECT_EQ(read.gain, vectorOf<glm::vec3>(file.at("gain")));
    EXPECT_EQ(read.gamma, file.at("gamma").get<double>());
    const json& camera = file.at("camera");
    EXPECT_EQ(read.camera.size, vectorOf<glm::ivec2>(camera.at("size")));
    EXPECT_EQ(read.camera.focal, vectorOf<glm::dvec2>(camera.at("focal")));
    EXPECT_EQ(read.camera.principal, vectorOf<glm::dvec2>(camera.at("principal")));
    EXPECT_EQ(read.camera.distortion, (camera.at("distortion").get<std::array<double, 5>>()));
    EXPECT_EQ(read.camera.cameraFromWorld, matrixOf<glm::dmat4>(camera.at("cameraFromWorld")));
    for (const Origin& origin : {read.lens, read.pose, read.response})
        EXPECT_EQ(origin, Origin()) << "nobody said where it came from";
}

/// Each value of `wanted` stands in `written` at the same place.
void expectHolds(const json& written, const json& wanted) {
    const json there = written.flatten();
    const json asked = wanted.flatten();
    for (const auto& [place, value] : asked.items()) {
        ASSERT_TRUE(there.contains(place)) << place;
        EXPECT_EQ(there.at(place), value) << place;
    }
}

TEST(ProjectMigration, ASchema2ProjectsRoomIsItsInstallation) {
    const json file = documentOf("schema2.lumorph");
    const json& scene = file.at("scene");
    ASSERT_EQ(file.at("schemaVersion"), 2);
    ASSERT_FALSE(file.contains("installation"));
    const Installation read = readProject(kFolder / "schema2.lumorph").installation;

    ASSERT_EQ(scene.at("projectors").size(), 2U);
    ASSERT_EQ(read.projectors.size(), 2U);
    expectProjector(read.projectors[0], scene.at("projectors")[0]);
    expectProjector(read.projectors[1], scene.at("projectors")[1]);
    EXPECT_EQ(read.tableSize, vectorOf<glm::vec2>(scene.at("table").at("size")));
    EXPECT_EQ(read.tableColor, vectorOf<glm::vec3>(scene.at("table").at("surfaceColor")));
    EXPECT_EQ(read.deviceColor, vectorOf<glm::vec3>(scene.at("device").at("surfaceColor")));
    EXPECT_EQ(read.eye, vectorOf<glm::vec3>(scene.at("eye")));
    EXPECT_EQ(read.worldFromDevice, matrixOf<glm::mat4>(scene.at("worldFromDevice")));
    ASSERT_EQ(scene.at("viewer"), "nearest");
    EXPECT_EQ(read.viewer, ViewerChoice::nearest);
    EXPECT_EQ(read.compensation, scene.at("compensation").get<bool>());
    EXPECT_EQ(read.predictionSeconds, scene.at("predictionSeconds").get<double>());
    // What it could not know.
    EXPECT_TRUE(read.cameras.empty());
    EXPECT_EQ(read.eyeFromHead, glm::vec3(0.0F));
    EXPECT_EQ(read.origins, Installation::Origins());

    // None of it is what a new project has, or it might have been lost unseen.
    const Installation fresh = defaultInstallation();
    EXPECT_NE(read.projectors[0], fresh.projectors[0]);
    EXPECT_NE(read.tableSize, fresh.tableSize);
    EXPECT_NE(read.tableColor, fresh.tableColor);
    EXPECT_NE(read.deviceColor, fresh.deviceColor);
    EXPECT_NE(read.eye, fresh.eye);
    EXPECT_NE(read.worldFromDevice, fresh.worldFromDevice);
    EXPECT_NE(read.viewer, fresh.viewer);
    EXPECT_NE(read.compensation, fresh.compensation);
    EXPECT_NE(read.predictionSeconds, fresh.predictionSeconds);
}

TEST(ProjectMigration, ASchema2ProjectShowsWhatItShowed) {
    const json file = documentOf("schema2.lumorph");
    const json written = json::parse(projectText(readProject(kFolder / "schema2.lumorph")));
    EXPECT_EQ(written.at("schemaVersion"), kProjectSchema);
    json kept = file;
    kept.erase("schemaVersion");
    kept.at("matching").erase("live"); // it names the driver since
    EXPECT_EQ(written.at("matching").at("driver"), "sceneItem");
    json& scene = kept.at("scene");
    for (const char* moved : {"projectors", "eye", "worldFromDevice", "viewer", "compensation", "predictionSeconds"}) {
        ASSERT_EQ(scene.erase(moved), 1U) << moved;
        EXPECT_FALSE(written.at("scene").contains(moved)) << moved;
        EXPECT_EQ(written.at("installation").at(moved).size(), file.at("scene").at(moved).size()) << moved;
    }
    ASSERT_EQ(scene.at("table").erase("size"), 1U);
    ASSERT_EQ(scene.at("table").erase("surfaceColor"), 1U);
    ASSERT_EQ(scene.at("device").erase("surfaceColor"), 1U);
    EXPECT_FALSE(written.at("scene").at("table").contains("size"));
    EXPECT_FALSE(written.at("scene").at("table").contains("surfaceColor"));
    EXPECT_FALSE(written.at("scene").at("device").contains("surfaceColor"));
    ASSERT_EQ(scene.at("items").size(), 5U);
    expectHolds(written, kept);
}

TEST(ProjectMigration, ASchema1ProjectStandsInTheVirtualLab) {
    const json file = documentOf("schema1.lumorph");
    ASSERT_EQ(file.at("schemaVersion"), 1);
    ASSERT_FALSE(file.contains("scene"));
    const Project project = readProject(kFolder / "schema1.lumorph");
    EXPECT_TRUE(project.installation == defaultInstallation());
    const Installation fresh = defaultInstallation();
    EXPECT_EQ(fresh.projectors.size(), 1U) << "as it was, when a scene held it";
    EXPECT_EQ(fresh.tableSize, glm::vec2(1.2F, 0.9F));
    EXPECT_EQ(fresh.eye, glm::vec3(0.0F, 0.45F, 0.55F));
    EXPECT_EQ(fresh.predictionSeconds, 0.06);
    EXPECT_TRUE(fresh.compensation);

    EXPECT_EQ(project.rig, file.at("rig").get<std::string>());
    EXPECT_EQ(project.field, file.at("field").get<std::string>());
    EXPECT_EQ(project.target, file.at("target").get<std::string>());
    EXPECT_EQ(project.animation, file.at("animation").get<int>());
    EXPECT_EQ(project.strokes, file.at("strokes").get<std::vector<double>>());
    EXPECT_EQ(project.placement.scale, file.at("placement").at("scale").get<double>());
    EXPECT_EQ(project.placement.yaw.inRadians(), file.at("placement").at("yaw").get<double>());
    EXPECT_EQ(project.placement.translation, vectorOf<glm::vec3>(file.at("placement").at("translation")));
    ASSERT_FALSE(file.at("matching").at("live").get<bool>());
    EXPECT_EQ(project.matching.driver, Driver::hand);
    EXPECT_EQ(project.matching.refined, file.at("matching").at("refined").get<bool>());
    EXPECT_EQ(project.matching.budgetMilliseconds, file.at("matching").at("budgetMilliseconds").get<double>());
    EXPECT_EQ(project.playback.playing, file.at("playback").at("playing").get<bool>());
    EXPECT_EQ(project.playback.spin, file.at("playback").at("spin").get<double>());
    EXPECT_EQ(project.view, file.at("view"));

    const SceneItem* driving = drivingItem(project.scene);
    ASSERT_TRUE(driving) << "its target is shown, and followed";
    EXPECT_TRUE(std::holds_alternative<TargetItem>(driving->kind));
    EXPECT_EQ(project.scene.items.size(), defaultScene().items.size() + 1);

    const json written = json::parse(projectText(project));
    EXPECT_EQ(written.at("schemaVersion"), kProjectSchema);
    EXPECT_EQ(written.at("author"), "Ada") << "a key that nobody knows";
    EXPECT_EQ(written.at("installation").at("projectors").size(), 1U);
    EXPECT_FALSE(written.at("scene").contains("projectors"));
}

// Before schema 4 a project said only whether servos follow something; whom, the scene said.
TEST(ProjectMigration, ASchema3ProjectIsDrivenAsItWas) {
    const json field = {{"id", 1}, {"name", "sea"}, {"role", "physical"}, {"kind", "heights"}};
    const auto driverOf = [](bool live, const json& items) {
        json document = {{"schemaVersion", 3}, {"rig", "resource:models/tablet.glb"}, {"matching", {{"live", live}}}};
        if (!items.is_null()) document["scene"] = {{"items", items}};
        return parseProject(document.dump(), "old.lumorph").matching.driver;
    };
    json hidden = field;
    hidden["visible"] = false;
    json light = field;
    light["role"] = "virtual";
    json target = field;
    target["kind"] = "target";
    EXPECT_EQ(driverOf(true, json::array({field})), Driver::sceneItem);
    EXPECT_EQ(driverOf(false, json::array({field})), Driver::hand);
    for (const json& other : {hidden, light, target}) EXPECT_EQ(driverOf(true, json::array({other})), Driver::target);
    EXPECT_EQ(driverOf(true, {}), Driver::target);
}

TEST(ProjectMigration, WhatIsWrittenIsReadTheSame) {
    for (const char* name : {"schema1.lumorph", "schema2.lumorph"}) {
        const Project once = readProject(kFolder / name);
        const std::string text = projectText(once);
        const Project again = parseProject(text, name);
        EXPECT_TRUE(again.scene == once.scene) << name;
        EXPECT_TRUE(again.installation == once.installation) << name;
        EXPECT_EQ(projectText(again), text) << name;
    }
}

TEST(ProjectMigration, ABrokenRoomOfASchema2ProjectIsStillRefused) {
    json file = documentOf("schema2.lumorph");
    file["scene"]["projectors"][1]["camera"]["focal"][0] = 0;
    EXPECT_THROW((void)parseProject(file.dump(), "a.lumorph"), DataError);
    file = documentOf("schema2.lumorph");
    file["scene"]["table"]["size"] = "large";
    EXPECT_THROW((void)parseProject(file.dump(), "a.lumorph"), DataError);
}

} // namespace
} // namespace lumorph
