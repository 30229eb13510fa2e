#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/render/gl/broken_shader.h"
#include "tests/core/render/gl/predicted_region.h"

namespace lumorph {
namespace {

std::shared_ptr<const Image> waves(int side) {
    auto image = std::make_shared<Image>(glm::ivec2(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double slope = 0.5 * std::sin(6.2831853 * 4.0 * (x + 0.5) / side);
            const glm::dvec3 n = glm::normalize(glm::dvec3(slope, 0.0, 1.0));
            const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * v)); };
            image->at(x, y) = {byte(n.x), byte(n.y), byte(n.z), 255};
        }
    return image;
}
// R27
TEST(EyePass, BumpMapsChangeLightOnTheDeviceAndNothingElse) {
    EyeStage stage;
    stage.scene.sky = glm::vec3(0.2F);
    stage.strokes = {0.2, 0, 0.1, 0.3, 0, 0.1};
    stage.assets->images["waves"] = waves(128);
    stage.scene.device.material.color = {0.9F, 0.1F, 0.1F};
    stage.scene.table.material.color = {0.1F, 0.9F, 0.1F};
    const LinearPicture before = stage.draw();
    stage.scene.device.material.normalMaps[0] = EyeStage::textured("waves", 0.04F);
    const LinearPicture after = stage.draw();
    const auto region = near(meet(stage.frame(), stage.camera()), stage.size, 1, onDevice);
    const Change change = changeOf(before, after, region);
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, change.area / 2);
    for (std::size_t i = 0; i < before.pixels.size(); ++i) // the outline stays where it is
        ASSERT_EQ(before.pixels[i].r > before.pixels[i].g, after.pixels[i].r > after.pixels[i].g);
}

// R28
TEST(EyePass, MovingTexturesMoveOnTheDeviceAlone) {
    EyeStage stage;
    stage.assets->images["checks"] = EyeStage::checks({64, 64}, 8, {250, 250, 250, 255}, {20, 20, 20, 255});
    stage.scene.device.material.colorTexture = EyeStage::textured("checks", 0.0625F);
    stage.scene.device.material.colorTexture.velocity = {0.03125F, 0.015625F};
    const LinearPicture before = stage.draw();
    stage.seconds = 0.7;
    const LinearPicture after = stage.draw();
    const auto region = near(meet(stage.frame(), stage.camera()), stage.size, 1, onDevice);
    const Change change = changeOf(before, after, region);
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, change.area / 5);
    stage.seconds = 8.0; // four tiles, and two
    EXPECT_TRUE(before.pixels == stage.draw().pixels);
}

// R28
TEST(EyePass, AFlipBookShowsItsPicturesInOrder) {
    EyeStage stage;
    auto book = std::make_shared<Image>(glm::ivec2(96, 64));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            book->at(x, y) = {static_cast<std::uint8_t>(40 * (x / 32) + x % 32),
                              static_cast<std::uint8_t>(90 * (y / 32)), static_cast<std::uint8_t>(4 * (y % 32)), 255};
    stage.assets->images["book"] = book;
    SceneTexture& texture = stage.scene.device.material.colorTexture;
    texture = EyeStage::textured("book", 0.05F);
    texture.columns = 3;
    texture.rows = 2;
    texture.framesPerSecond = 10.0;
    for (const int cell : {0, 2, 4, 5}) {
        stage.seconds = 0.1 * (cell + 12) + 0.05; // the third time round
        const LinearPicture shown = stage.draw();
        auto page = std::make_shared<Image>(glm::ivec2(32));
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) page->at(x, y) = book->at(32 * (cell % 3) + x, 32 * (cell / 3) + y);
        stage.assets->images["page"] = page;
        const SceneInRoom flipBook = stage.scene;
        stage.scene.device.material.colorTexture = EyeStage::textured("page", 0.05F);
        EXPECT_TRUE(shown.pixels == stage.draw().pixels) << cell;
        stage.scene = flipBook;
    }
}

// R30
TEST(EyePass, BlurredFoldsChangeLightOnTheDeviceAlone) {
    EyeStage stage;
    stage.strokes = {0, 0, 0, 0, 0.3, 0};
    stage.sun().shadows = false;
    const LinearPicture before = stage.draw();
    stage.scene.device.creases.emphasis = -1.0;
    const LinearPicture soft = stage.draw();
    const auto region = near(meet(stage.frame(), stage.camera()), stage.size, 1, onDevice);
    const Change change = changeOf(before, soft, region);
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, change.area / 10);
}

// R33: light carries what servos that lag, or that are off, do not.
TEST(EyePass, ASplitItemLooksTheSameWhateverTheServosDo) {
    EyeStage stage;
    stage.sun().shadows = false;
    SceneItem sea;
    sea.id = 7;
    sea.name = "Sea";
    sea.role = ItemRole::split;
    sea.position = {0.0F, 0.045F, 0.0F};
    sea.material = EyeStage::plain({0.2F, 0.4F, 0.9F});
    HeightItem waves;
    waves.size = {0.16F, 0.11F};
    waves.waves = {{0.004, 0.06, 2.0, Angle::degrees(20.0), {}}};
    sea.kind = waves;
    stage.scene.items.push_back(sea);
    const LinearPicture atRest = stage.draw();
    const std::vector<Met> before = meet(stage.frame(), stage.camera());
    stage.strokes = {0.1, 0.3, 0.2, 0.0, 0.3, 0.1};
    const LinearPicture lifted = stage.draw();
    const std::vector<Met> after = meet(stage.frame(), stage.camera());
    std::vector<bool> surface; // but where a flap rises through it, and the pixels beside
    for (std::size_t i = 0; i < before.size(); ++i)
        surface.push_back(before[i].thing != EyeStage::firstItem || after[i].thing != EyeStage::firstItem);
    surface = grown(surface, stage.size, 1);
    surface.flip();
    const Change change = changeOf(atRest, lifted, surface);
    EXPECT_GT(change.area, 10'000);
    EXPECT_EQ(change.inside, 0);
    EXPECT_GT(change.outside, 500) << "the bare device beside it does move";
    stage.seconds = 0.5;
    EXPECT_GT(changeOf(lifted, stage.draw(), surface).inside, change.area / 4) << "the wave goes on";
}

// R31
TEST(EyePass, AFloatingThingAndItsShadowChangeTheirOwnPlaces) {
    EyeStage stage;
    stage.strokes = {0.2, 0.1, 0, 0.3, 0, 0};
    const LinearPicture before = stage.draw();
    stage.addBox({0.01F, 0.08F, 0.02F}, 0.028F).material.color = {0.8F, 0.2F, 0.1F};
    const LinearPicture after = stage.draw();
    const auto met = meet(stage.frame(), stage.camera());
    const auto changes = [](const Met& m) { return m.thing == EyeStage::firstItem || m.shadowOfItem; };
    const Change change = changeOf(before, after, near(met, stage.size, 2, changes));
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, 6'000);
}

// R32, R34
TEST(EyePass, AHoleIsTheTableAlongTheEyesRay) {
    EyeStage stage;
    stage.scene.sky = glm::vec3(0.3F);
    stage.assets->images["checks"] = EyeStage::checks({64, 64}, 16, {230, 190, 120, 255}, {110, 60, 30, 255});
    stage.scene.table.material.colorTexture = EyeStage::textured("checks", 0.06F);
    const LinearPicture whole = stage.draw();
    const glm::dvec2 centre(0.01, 0.012);
    const double radius = 0.022;
    stage.scene.device.holes = {{glm::vec2(centre), radius}};
    const LinearPicture holed = stage.draw();
    const ShowFrame frame = stage.frame();
    ShowFrame alone = frame;
    alone.rig.reset();
    const LinearPicture table = stage.draw(alone, stage.camera());

    const auto met = meet(frame, stage.camera());
    const auto within = [&](double r) {
        return [=](const Met& m) {
            return m.thing == EyeStage::device && m.place.y > 0.0199 &&
                   glm::distance(glm::dvec2(m.place.x, m.place.z), centre) < r;
        };
    };
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < met.size(); ++i) {
        if (!within(radius - 0.001)(met[i])) continue;
        for (int c = 0; c < 3; ++c) squares += std::pow(holed.pixels[i][c] - table.pixels[i][c], 2.0);
        ++count;
    }
    ASSERT_GT(count, 3'000);
    EXPECT_GE(-10.0 * std::log10(squares / (3.0 * count) + 1e-12), 30.0);
    const Change change = changeOf(whole, holed, near(met, stage.size, 2, within(radius)));
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, count / 2);
}

// R32
TEST(EyePass, ShrinkingShowsTheTableAtTheRim) {
    EyeStage stage;
    stage.sun().shadows = false;
    stage.scene.device.material.color = {0.9F, 0.1F, 0.1F};
    stage.scene.table.material.color = {0.1F, 0.9F, 0.1F};
    stage.scene.device.shrink = 0.2;
    const LinearPicture picture = stage.draw();
    const auto met = meet(stage.frame(), stage.camera());
    int rim = 0;
    for (std::size_t i = 0; i < met.size(); ++i) {
        const glm::dvec2 share = glm::abs(glm::dvec2(met[i].place.x, met[i].place.z)) / glm::dvec2(0.105, 0.075);
        const bool top = met[i].thing == EyeStage::device && met[i].place.y > 0.0199;
        if (!top || std::abs(std::max(share.x, share.y) - 0.8) < 0.02) continue;
        const bool outside = std::max(share.x, share.y) > 0.8;
        rim += outside ? 1 : 0;
        ASSERT_EQ(picture.pixels[i].g > picture.pixels[i].r, outside) << share.x << " " << share.y;
    }
    EXPECT_GT(rim, 10'000);
}

TEST(EyePass, ToneMapsLinearLightOnce) {
    EyeStage stage;
    stage.scene.device.material.unlit = true;
    const auto shown = [&](double exposure, bool mapped) {
        stage.scene.exposure = exposure;
        stage.scene.toneMapping = mapped;
        return stage.draw().at(stage.size.x / 2, stage.size.y / 2);
    };
    for (const double v : {0.05, 0.2, 0.5, 0.69, 0.8, 1.0, 2.0, 8.0}) {
        const double curve = v <= 0.7 ? v : 0.7 + 0.3 * (v - 0.7) / (v - 0.4);
        EXPECT_NEAR(shown(v, true).g, curve, 1e-3) << v;
        EXPECT_NEAR(shown(v, false).g, std::min(v, 1.0), 1e-3) << v;
        EXPECT_EQ(shown(v, true).a, 1.0F);
    }
    // sRGB is decoded: 188 of 255 is half the light.
    stage.scene.device.material.color = glm::vec3(188.0F / 255.0F);
    EXPECT_NEAR(shown(1.0, false).g, 0.503, 2e-3);
}

// Where no eye looks there is the device as it is, without what hangs in the air, and without holes.
TEST(EyePass, UnseenPlacesShowThePhysicalDevice) {
    EyeStage stage;
    stage.scene.device.material.color = {0.9F, 0.1F, 0.1F};
    stage.scene.table.material.color = {0.1F, 0.9F, 0.1F};
    stage.scene.device.holes = {{{0.0F, 0.0F}, 0.03}};
    stage.addBox({0.07F, 0.05F, 0.0F}, 0.03F).material.color = {0.1F, 0.1F, 0.9F};
    const Image picture = stage.drawUnseen();
    const Image::Pixel& middle = picture.at(stage.size.x / 2, stage.size.y / 2 + 10);
    EXPECT_GT(middle[0], 2 * middle[1]);
    EXPECT_GT(middle[0], 60);
    EXPECT_EQ(picture.at(0, 0)[3], 255); // drawn, for all was cleared to 0
    for (const auto& [red, green, blue, alpha] : picture.pixels()) ASSERT_LE(blue, std::max(red, green));
}

TEST(EyePass, FogVeilsWhatIsBehindIt) {
    EyeStage stage;
    stage.scene.sky = glm::vec3(0.4F);
    stage.scene.device.material.color = glm::vec3(0.05F);
    const LinearPicture clear = stage.draw();
    SceneItem fog;
    fog.id = 7;
    fog.name = "Fog";
    fog.position = {0.0F, 0.05F, 0.0F};
    fog.kind = FogItem{.size = {0.2F, 0.08F, 0.14F}, .density = 30.0};
    stage.scene.items.push_back(fog);
    const LinearPicture veiled = stage.draw();
    const auto middle = [&](const LinearPicture& p) { return p.at(stage.size.x / 2, stage.size.y / 2).g; };
    EXPECT_GT(middle(veiled), middle(clear) + 0.1F);
    stage.seconds = 1.0;
    EXPECT_FALSE(stage.draw().pixels == veiled.pixels); // it drifts
}

TEST(EyePass, ABrokenShaderIsNamedAndAPlainOneStandsIn) {
    const BrokenShader broken("eye_surface.frag");
    EyeStage stage;
    stage.scene.device.material.color = {0.9F, 0.1F, 0.1F};
    stage.scene.table.material.color = {0.1F, 0.9F, 0.1F};
    const LinearPicture picture = stage.draw();
    const auto warnings = stage.pass.warnings();
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings.front().find("eye_surface.frag:3"), std::string::npos) << warnings.front();
    EXPECT_GT(picture.at(320, 200).r, 0.2F);
    EXPECT_GT(picture.at(5, 5).g, 0.2F);
}

TEST(EyePass, BrokenInputIsLeftOutOrRefused) {
    EyeStage stage;
    const LinearPicture before = stage.draw();
    stage.addBox({0.0F, 0.05F, 0.0F}, 0.03F);
    ShowFrame frame = stage.frame();
    PosedSurface& surface = frame.posed.surfaces.front();
    auto positions = std::make_shared<std::vector<glm::vec3>>(*surface.positions);
    positions->front().x = std::numeric_limits<float>::quiet_NaN();
    surface.positions = positions;
    frame.posed.lights.push_back(frame.posed.lights.front());
    frame.posed.lights.back().position.x = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(stage.draw(frame, stage.camera()).pixels == before.pixels);
    frame.posed.surfaces.front().topology = nullptr;
    EXPECT_TRUE(stage.draw(frame, stage.camera()).pixels == before.pixels);
    CalibratedCamera camera = stage.camera();
    camera.size = {0, 400};
    EXPECT_THROW(stage.pass.draw(frame, camera, 0), InvalidInput);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(EyePass, KeepsNoMoreObjectsFrameAfterFrame) {
    EyeStage stage;
    stage.addBox({0.0F, 0.05F, 0.0F}, 0.03F).motion = {1.0, 0.005, 2.0};
    (void)stage.draw();
    const std::size_t first = stage.pass.objectCount();
    for (int i = 0; i < 5; ++i) {
        stage.seconds += 0.1;
        stage.strokes[0] = 0.1 * i;
        (void)stage.draw();
    }
    EXPECT_EQ(stage.pass.objectCount(), first);
}

} // namespace
} // namespace lumorph
