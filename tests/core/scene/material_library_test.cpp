#include "core/scene/material_library.h"

#include <cmath>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "app/applications/techniques/techniques.h"
#include "app/applications/water/water.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "core/base/resources.h"
#include "core/scene/posed_scene.h"
#include "core/scene/project.h"
#include "core/scene/scene_assets.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

Scene sceneOfAll(const std::vector<Material>& materials) {
    Scene scene;
    for (const Material& material : materials) {
        SceneItem item;
        item.id = static_cast<int>(scene.items.size()) + 1;
        item.kind = ShapeItem{};
        item.material = material;
        scene.items.push_back(item);
    }
    return scene;
}

TEST(MaterialLibrary, HasWhatTheTechniquesNeedAndAllItsPictures) {
    const std::vector<Material> materials = readyMaterials();
    std::set<std::string> names;
    for (const Material& material : materials) names.insert(material.name);
    EXPECT_EQ(names.size(), materials.size()) << "a name twice";
    for (const char* name : {"Paper", "Water", "Wood", "Brick", "Map", "Ice"})
        EXPECT_TRUE(names.contains(name)) << name;
    const Scene scene = sceneOfAll(materials);
    checkScene(scene);
    const auto assets = loadSceneAssets(scene, {});
    EXPECT_TRUE(assets->problems.empty()) << assets->problems.begin()->second;
    EXPECT_THROW((void)readyMaterial("Gold"), InvalidInput);
    EXPECT_EQ(readyMaterial("Ice").name, "Ice");
}

TEST(MaterialLibrary, WaterIsSeenThroughAndMoves) {
    const Material water = readyMaterial("Water");
    EXPECT_GT(water.reflection, 0.0F);
    EXPECT_GT(water.refraction, 0.0F);
    for (const SceneTexture& map : water.normalMaps) EXPECT_GT(glm::length(map.velocity), 0.0F);
}

double difference(const Image::Pixel& a, const Image::Pixel& b) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(static_cast<double>(a[c]) - static_cast<double>(b[c]));
    return sum / 3.0;
}

/// Mean difference of neighbours across a line between columns (or rows); `at` 0 is the seam.
double jump(const Image& image, int at, bool columns) {
    const int side = image.size().x;
    const int before = (at + side - 1) % side;
    double sum = 0.0;
    for (int i = 0; i < side; ++i)
        sum += columns ? difference(image.at(before, i), image.at(at, i))
                       : difference(image.at(i, before), image.at(i, at));
    return sum / side;
}

/// The largest jump anywhere but at the seam.
double largestJump(const Image& image, bool columns) {
    double largest = 0.0;
    for (int i = 1; i < image.size().x; ++i) largest = std::max(largest, jump(image, i, columns));
    return largest;
}

TEST(MaterialLibrary, PicturesRepeatWithoutASeam) {
    int looked = 0;
    for (const auto& entry : fs::directory_iterator(resourcesFolder() / "materials")) {
        if (entry.path().extension() != ".png") continue;
        SCOPED_TRACE(entry.path().filename().string());
        EXPECT_LT(fs::file_size(entry.path()), 450'000U);
        const Image image = readPng(entry.path());
        EXPECT_EQ(image.size(), glm::ivec2(512, 512));
        ++looked;
        if (entry.path().stem() == "caustics") continue; // a sheet of sixteen
        EXPECT_LE(jump(image, 0, true), 1.05 * largestJump(image, true));
        EXPECT_LE(jump(image, 0, false), 1.05 * largestJump(image, false));
    }
    EXPECT_GE(looked, 15);
}

TEST(MaterialLibrary, EachPictureOfTheFlipBookRepeatsToo) {
    const Image sheet = readPng(resourceFile("materials/caustics.png"));
    constexpr int kSide = 128;
    for (int frame = 0; frame < 16; ++frame) {
        Image one({kSide, kSide});
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) one.at(x, y) = sheet.at(frame % 4 * kSide + x, frame / 4 * kSide + y);
        EXPECT_LE(jump(one, 0, true), 1.3 * largestJump(one, true)) << frame;
        EXPECT_LE(jump(one, 0, false), 1.3 * largestJump(one, false)) << frame;
    }
}

TEST(MaterialLibrary, NormalMapsHoldDirectionsOfLengthOneThatPointOutwards) {
    for (const auto& entry : fs::directory_iterator(resourcesFolder() / "materials")) {
        if (!entry.path().stem().string().ends_with("_normal")) continue;
        SCOPED_TRACE(entry.path().filename().string());
        const Image image = readPng(entry.path());
        glm::dvec3 mean(0.0);
        for (std::size_t i = 0; i < image.pixels().size(); i += 31) {
            const Image::Pixel& p = image.pixels()[i];
            const glm::dvec3 normal = glm::dvec3(p[0], p[1], p[2]) / 127.5 - 1.0;
            ASSERT_NEAR(glm::length(normal), 1.0, 0.03);
            ASSERT_GT(normal.z, 0.0);
            mean += normal;
        }
        mean = glm::normalize(mean);
        EXPECT_GT(mean.z, 0.995) << "it tilts as a whole";
    }
}

TEST(Techniques, EachKeyHasASceneThatCanBeSavedAndShown) {
    const std::vector<Technique> all = techniques();
    ASSERT_EQ(all.size(), 7U);
    std::set<std::string> texts;
    for (std::size_t i = 0; i < all.size(); ++i) {
        SCOPED_TRACE(all[i].name.english);
        EXPECT_EQ(all[i].key, static_cast<int>(i));
        EXPECT_FALSE(all[i].sentence.empty());
        const Scene scene = techniqueScene(all[i].key);
        checkScene(scene);
        EXPECT_TRUE(scene == techniqueScene(all[i].key));
        ASSERT_NE(drivingItem(scene), nullptr);
        EXPECT_TRUE(loadSceneAssets(scene, {})->problems.empty());
        Project project;
        project.rig = "resource:models/tablet.glb";
        project.scene = scene;
        texts.insert(projectText(project));
        EXPECT_TRUE(parseProject(projectText(project), "p").scene == scene);
    }
    EXPECT_EQ(texts.size(), 7U) << "two of them are the same";
    EXPECT_THROW((void)techniqueScene(7), InvalidInput);
    EXPECT_THROW((void)techniqueScene(-1), InvalidInput);
}

TEST(Techniques, ShowWhatTheyAreCalled) {
    EXPECT_FALSE(techniqueScene(1).device.material.normalMaps[0].image.empty());             // R27
    EXPECT_GT(techniqueScene(2).device.material.colorTexture.framesPerSecond, 0.0);          // R28
    EXPECT_NE(findItem(techniqueScene(3), techniqueScene(3).items[0].id)->motion.spin, 0.0); // R29
    EXPECT_EQ(techniqueScene(4).device.creases.emphasis, 1.0);                               // R30
    const auto cubes = [](const Scene& scene) {
        PoseInput input;
        return ScenePoser().pose(scene, {}, input).surfaces.size();
    };
    EXPECT_EQ(cubes(techniqueScene(5)), cubes(techniqueScene(1)) + 4); // R31
    EXPECT_GT(techniqueScene(6).device.shrink, 0.0);                   // R32
    EXPECT_FALSE(techniqueScene(6).device.holes.empty());
    // R33: what is slow and long is for the servos.
    const SceneItem* sea = drivingItem(waterScene());
    ASSERT_TRUE(sea);
}

TEST(Techniques, TheBundledProjectsAreWhatTheProgramMakes) {
    const auto expectProject = [](const char* name, const Scene& scene) {
        const Project project = readProject(resourceFile(name));
        EXPECT_TRUE(project.scene == scene) << name;
        EXPECT_TRUE(project.installation == defaultInstallation()) << name;
    };
    expectProject("projects/water.lumorph", waterScene());
    expectProject("projects/techniques.lumorph", techniqueScene(1));
}

} // namespace
} // namespace lumorph
