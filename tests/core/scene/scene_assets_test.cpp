#include "core/scene/scene_assets.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene/posed_scene.h"
#include "tests/core/scene/scenes.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/animated_target.h"
#include "tests/support/full_model.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using test::itemOf;
using testing::AllOf;
using testing::HasSubstr;

/// A JPEG of 8 x 8 pixels, all of one grey: written by hand from ITU T.81, one table of each kind.
std::vector<std::byte> greyJpeg() {
    std::vector<std::uint8_t> bytes = {0xFF, 0xD8, 0xFF, 0xDB, 0x00, 0x43, 0x00};
    bytes.insert(bytes.end(), 64, 1); // quantisation
    const std::vector<std::uint8_t> rest = {
        0xFF, 0xC0, 0x00, 0x0B, 0x08, 0x00, 0x08, 0x00, 0x08, 0x01, 0x01, 0x11, 0x00, // frame: 8 bits, 8 x 8, one part
        0xFF, 0xC4, 0x00, 0x14, 0x00, 1,    0,    0,    0,    0,    0,    0,    0,
        0,    0,    0,    0,    0,    0,    0,    0,    0x00, // DC: code 0 is "no change"
        0xFF, 0xC4, 0x00, 0x14, 0x10, 1,    0,    0,    0,    0,    0,    0,    0,
        0,    0,    0,    0,    0,    0,    0,    0,    0x00, // AC: code 0 is "end"
        0xFF, 0xDA, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3F, 0x00, 0x3F, 0xFF, 0xD9};
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    std::vector<std::byte> result;
    for (const std::uint8_t byte : bytes) result.push_back(std::byte{byte});
    return result;
}

class SceneAssetsTest : public ::testing::Test {
protected:
    [[nodiscard]] fs::path projectFile() const { return folder / "p.lumorph"; }
    void write(const std::string& name, std::span<const std::byte> bytes) const {
        writeFileAtomically(folder / name, bytes);
    }
    static Scene skinned(const std::string& image) {
        Scene scene;
        scene.device.material.colorTexture.image = image;
        return scene;
    }
    /// The scene's picture is a placeholder, and its problem names file, cause and remedy.
    void expectBroken(const std::string& name, const std::string& why) const {
        const auto assets = loadSceneAssets(skinned(name), projectFile());
        ASSERT_TRUE(assets->images.contains(name));
        EXPECT_EQ(assets->images.at(name)->at(0, 0), (Image::Pixel{255, 0, 255, 255}));
        ASSERT_TRUE(assets->problems.contains(name));
        EXPECT_THAT(assets->problems.at(name), AllOf(HasSubstr(name + ": "), HasSubstr(why), HasSubstr("; ")));
    }
    TemporaryFolder folder;
};

TEST_F(SceneAssetsTest, PicturesAreDecodedToTheirPixels) {
    Image picture({3, 2}, {10, 20, 30, 255});
    picture.at(2, 1) = {200, 100, 50, 128};
    writePng(picture, folder / "a.png");
    write("b.jpg", greyJpeg());
    Scene scene = skinned("a.png");
    scene.table.material.holes.image = "b.jpg";
    const auto assets = loadSceneAssets(scene, projectFile());
    EXPECT_TRUE(assets->problems.empty());
    EXPECT_EQ(*assets->images.at("a.png"), picture);
    EXPECT_EQ(assets->images.at("b.jpg")->size(), glm::ivec2(8, 8));
    EXPECT_EQ(assets->images.at("b.jpg")->at(3, 3), (Image::Pixel{128, 128, 128, 255}));
}

TEST_F(SceneAssetsTest, BundledPicturesAreFoundWithoutAProject) {
    const auto assets = loadSceneAssets(skinned("resource:materials/wood.png"), {});
    EXPECT_TRUE(assets->problems.empty());
    EXPECT_EQ(assets->images.at("resource:materials/wood.png")->size(), glm::ivec2(512, 512));
    writePng(Image({2, 2}), folder / "a.png");
    EXPECT_TRUE(loadSceneAssets(skinned((folder / "a.png").string()), {})->problems.empty()) << "an absolute path";
    EXPECT_EQ(loadSceneAssets(skinned("a.png"), {})->problems.size(), 1U) << "relative to nothing";
}

TEST_F(SceneAssetsTest, WhatIsBrokenGetsAPlaceholderAndSaysWhy) {
    writePng(Image({64, 64}, {1, 2, 3, 255}), folder / "whole.png");
    std::vector<std::byte> cut = readFile(folder / "whole.png", 1'000'000);
    cut.resize(cut.size() / 2);
    write("cut.png", cut);
    write("empty.png", {});
    const std::string text = "no picture at all";
    write("text.png", std::as_bytes(std::span(text)));
    fs::create_directories(folder / "folder.png");
    std::vector<std::byte> huge = readFile(folder / "whole.png", 1'000'000);
    for (const std::size_t i : {16U, 20U}) huge[i + 2] = std::byte{0x3F}; // width and height: 16192
    write("huge.png", huge);
    expectBroken("cut.png", "is broken");
    expectBroken("empty.png", "is empty");
    expectBroken("text.png", "is no PNG or JPEG");
    expectBroken("missing.png", "is not there");
    expectBroken("folder.png", "");
    expectBroken("huge.png", "too many");
    expectBroken("../outside.png", "leads out");
    expectBroken("resource:materials/none.png", "is not there");
}

TEST_F(SceneAssetsTest, WhatHasNotChangedIsTakenOver) {
    writePng(Image({2, 2}), folder / "a.png");
    writePng(Image({2, 2}), folder / "b.png");
    write("fish.glb", writeGlb(support::fullModel()));
    Scene scene = skinned("a.png");
    scene.table.material.colorTexture.image = "b.png";
    scene.items.push_back(itemOf(1, MeshItem{"fish.glb"}));
    const auto before = loadSceneAssets(scene, projectFile());
    writePng(Image({4, 4}), folder / "b.png");
    scene.device.material.holes.image = "missing.png";
    const auto after = loadSceneAssets(scene, projectFile(), before.get());
    EXPECT_EQ(after->images.at("a.png"), before->images.at("a.png"));
    EXPECT_EQ(after->models.at("fish.glb"), before->models.at("fish.glb"));
    EXPECT_EQ(after->images.at("b.png")->size(), glm::ivec2(4, 4)) << "it has changed";
    for (const auto& [name, image] : before->images)
        EXPECT_TRUE(name == "b.png" || after->images.at(name) == image) << name;
    EXPECT_EQ(after->problems.count("fish.glb"), before->problems.count("fish.glb"));
    scene.table.material.colorTexture.image.clear();
    EXPECT_FALSE(loadSceneAssets(scene, projectFile(), after.get())->images.contains("b.png")) << "nobody shows it";
}

TEST_F(SceneAssetsTest, AModelBroughtBackIsReadAgain) {
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"fish.glb"}));
    const std::string text = "glTF";
    write("fish.glb", std::as_bytes(std::span(text)));
    const auto broken = loadSceneAssets(scene, projectFile());
    EXPECT_FALSE(broken->models.contains("fish.glb"));
    EXPECT_EQ(broken->problems.count("fish.glb"), 1U);
    write("fish.glb", writeGlb(test::animatedEllipsoid(8, 6)));
    const auto whole = loadSceneAssets(scene, projectFile(), broken.get());
    EXPECT_TRUE(whole->models.contains("fish.glb"));
    EXPECT_TRUE(whole->problems.empty());
}

TEST_F(SceneAssetsTest, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)loadSceneAssets(defaultScene(), {}, nullptr, Progress({}, stop.get_token())), Cancelled);
}

Model texturedModel(const TemporaryFolder& folder) {
    Model model = test::animatedEllipsoid(8, 6);
    writePng(Image({2, 2}, {0, 128, 64, 255}), folder / "map.png");
    model.images.push_back({"map", "image/png", readFile(folder / "map.png", 1'000'000)});
    model.images.push_back({"bad", "image/png", {std::byte{1}}});
    Model::Material material;
    material.name = "Scales";
    material.baseColor = {0.21404F, 1.0F, 0.0F, 0.5F};
    material.alphaMode = "BLEND";
    material.roughness = 0.8F;
    material.metallic = 1.0F;
    material.emissive = {0.0F, 0.0F, 1.0F};
    material.normalScale = 0.5F;
    material.baseColorImage = 0;
    material.metallicRoughnessImage = 0;
    material.normalImage = 1;
    material.extras = {
        {"lumorph",
         {{"flipBook", {{"columns", 4}, {"rows", 2}, {"framesPerSecond", 12}}}, {"uvVelocity", {0.1, -0.2}}}}};
    model.materials = {material};
    model.meshes[0].primitives[0].material = 0;
    return model;
}

TEST_F(SceneAssetsTest, MaterialsOfAModelBecomeOurs) {
    write("fish.glb", writeGlb(texturedModel(folder)));
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"fish.glb"}));
    const auto assets = loadSceneAssets(scene, projectFile());
    const Material& m = assets->models.at("fish.glb")->materials.at(0);
    EXPECT_EQ(m.name, "Scales");
    EXPECT_NEAR(m.color.r, 0.5F, 1e-3F) << "sRGB";
    EXPECT_FLOAT_EQ(m.opacity, 0.5F);
    EXPECT_EQ(m.alpha, Material::Alpha::blend);
    EXPECT_NEAR(m.roughness, 0.8F * 128.0F / 255.0F, 1e-4F);
    EXPECT_NEAR(m.metallic, 64.0F / 255.0F, 1e-4F);
    EXPECT_FLOAT_EQ(m.emission.b, 1.0F);
    EXPECT_FLOAT_EQ(m.normalStrength, 0.5F);
    EXPECT_EQ(m.colorTexture.image, imageName("fish.glb", 0));
    EXPECT_EQ(m.colorTexture.tile, glm::vec2(1.0F));
    EXPECT_EQ(m.colorTexture.columns, 4);
    EXPECT_EQ(m.colorTexture.rows, 2);
    EXPECT_EQ(m.colorTexture.framesPerSecond, 12.0);
    EXPECT_EQ(m.colorTexture.velocity, glm::vec2(0.1F, -0.2F));
    EXPECT_EQ(assets->images.at(imageName("fish.glb", 0))->at(0, 0), (Image::Pixel{0, 128, 64, 255}));
    EXPECT_EQ(assets->images.at(imageName("fish.glb", 1))->at(0, 0), (Image::Pixel{255, 0, 255, 255}));
    EXPECT_THAT(assets->problems.at("fish.glb"), HasSubstr("'bad'"));
    const PosedScene own = ScenePoser().pose(scene, *assets, {});
    EXPECT_EQ(own.surfaces.at(0).material, m);
    std::get<MeshItem>(scene.items[0].kind).ownMaterials = false;
    EXPECT_EQ(ScenePoser().pose(scene, *assets, {}).surfaces.at(0).material, scene.items[0].material);
}

TEST_F(SceneAssetsTest, NonsenseInExtrasIsPassedOver) {
    Model model = texturedModel(folder);
    model.materials[0].extras = {
        {"lumorph", {{"flipBook", {{"columns", -3}, {"rows", "two"}}}, {"uvVelocity", {1e9}}}}};
    write("fish.glb", writeGlb(model));
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"fish.glb"}));
    const auto assets = loadSceneAssets(scene, projectFile());
    const SceneTexture& texture = assets->models.at("fish.glb")->materials.at(0).colorTexture;
    EXPECT_EQ(texture.columns, 1);
    EXPECT_EQ(texture.rows, 1);
    EXPECT_EQ(texture.velocity, glm::vec2(0.0F));
}

/// All corners of all triangles in world space, surface by surface.
std::vector<glm::vec3> cornersOf(const PosedScene& posed) {
    std::vector<glm::vec3> corners;
    for (const PosedSurface& surface : posed.surfaces)
        for (const glm::uvec3& t : surface.topology->triangles)
            for (const std::uint32_t i : {t.x, t.y, t.z})
                corners.emplace_back(surface.worldFromSurface * glm::vec4((*surface.positions)[i], 1.0F));
    return corners;
}

std::shared_ptr<const SceneAssets> assetsOf(const std::string& name, const Model& model) {
    auto scene = std::make_shared<SceneModel>();
    scene->model = model;
    scene->materials.resize(model.materials.size());
    auto assets = std::make_shared<SceneAssets>();
    assets->models[name] = scene;
    return assets;
}

/// Largest distance from a corner of the posed model to that of the flattened one.
double distanceToFlattened(const Model& model, double sceneSeconds, double animationSeconds, double speed) {
    const Scene scene = [&] {
        Scene one;
        one.items.push_back(itemOf(1, MeshItem{"m.glb", 0, speed}));
        return one;
    }();
    PoseInput input;
    input.seconds = sceneSeconds;
    const auto corners = cornersOf(ScenePoser().pose(scene, *assetsOf("m.glb", model), input));
    const TriangleMesh flat = flatten(model, model.animations[0], animationSeconds);
    EXPECT_EQ(corners.size(), 3 * flat.triangles.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        worst = std::max(worst, static_cast<double>(glm::distance(
                                    corners[i], flat.positions[flat.triangles[i / 3][static_cast<int>(i % 3)]])));
    return worst;
}

TEST(SceneModels, ASkinnedAndMorphedModelIsWhereItsAnimationPutsIt) {
    const Model skinned = support::fullModel(); // lasts 3 seconds
    for (const double t : {0.0, 0.4, 1.7}) EXPECT_LT(distanceToFlattened(skinned, t, t, 1.0), 1e-5) << t;
    EXPECT_LT(distanceToFlattened(skinned, 3.0 + 0.4, 0.4, 1.0), 1e-5) << "it repeats";
    EXPECT_LT(distanceToFlattened(skinned, 0.5, 1.0, 2.0), 1e-5) << "at twice the speed";
    EXPECT_LT(distanceToFlattened(skinned, 1.0, 2.0, -1.0), 1e-5) << "backwards";
    const Model morphed = test::animatedEllipsoid(16, 12);
    for (const double t : {0.0, 0.7, 1.3}) EXPECT_LT(distanceToFlattened(morphed, t, t, 1.0), 1e-5) << t;
}

TEST(SceneModels, WhatOnlyMovesKeepsItsSurface) {
    Model model = test::animatedEllipsoid(16, 12);
    model.meshes[0].primitives[0].morphTargets.clear();
    model.meshes[0].targetNames.clear();
    model.meshes[0].weights.clear();
    std::erase_if(model.animations[0].channels, [](const auto& c) { return c.path == Model::Path::weights; });
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"m.glb"}));
    const auto assets = assetsOf("m.glb", model);
    ScenePoser poser;
    PoseInput input;
    const PosedSurface first = poser.pose(scene, *assets, input).surfaces.at(0);
    input.seconds = 0.4;
    const PosedSurface second = poser.pose(scene, *assets, input).surfaces.at(0);
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.normals, second.normals);
    EXPECT_NE(first.worldFromSurface, second.worldFromSurface) << "its node turns";
}

TEST(SceneModels, AStillModelStandsAtItsRestPose) {
    const Model model = support::fullModel();
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"m.glb", -1}));
    scene.items.push_back(itemOf(2, MeshItem{"m.glb", 77}));
    PoseInput input;
    input.seconds = 1.0;
    const PosedScene posed = ScenePoser().pose(scene, *assetsOf("m.glb", model), input);
    std::vector<glm::vec3> corners = cornersOf(posed);
    const TriangleMesh flat = flatten(model);
    ASSERT_EQ(corners.size(), 6 * flat.triangles.size()) << "both items";
    for (std::size_t i = 0; i < 3 * flat.triangles.size(); ++i)
        EXPECT_LT(glm::distance(corners[i], flat.positions[flat.triangles[i / 3][static_cast<int>(i % 3)]]), 1e-5F);
    for (const PosedSurface& surface : posed.surfaces)
        for (const glm::vec3& normal : *surface.normals) EXPECT_NEAR(glm::length(normal), 1.0F, 1e-4F);
}

TEST(SceneModels, AMissingModelIsAMarkedBox) {
    Scene scene;
    scene.items.push_back(itemOf(1, MeshItem{"gone.glb"}));
    scene.items.push_back(itemOf(2, MeshItem{}));
    scene.items[0].scale = glm::vec3(2.0F);
    const PosedScene posed = ScenePoser().pose(scene, {}, {});
    ASSERT_EQ(posed.surfaces.size(), 1U) << "an item without a model shows nothing";
    EXPECT_EQ(posed.surfaces[0].material.color, glm::vec3(1.0F, 0.0F, 1.0F));
    EXPECT_TRUE(posed.surfaces[0].material.unlit);
    EXPECT_FLOAT_EQ(boundingBox(cornersOf(posed)).size().x, 0.1F);
}

} // namespace
} // namespace lumorph
