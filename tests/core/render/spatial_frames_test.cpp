#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "tests/core/render/gl/broken_shader.h"
#include "tests/core/render/spatial_scene.h"

// What stays and what changes from one frame of the renderer to the next.

namespace lumorph {
namespace {

TEST(SpatialFrames, ProjectorsComeGoAndChangeTheirSize) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    EXPECT_THROW((void)renderer.readEye(), InvalidInput);
    EXPECT_THROW((void)renderer.readMask(), InvalidInput);
    EXPECT_THROW(renderer.showEye(0), InvalidInput);
    SceneInRoom scene = unlitScene(glm::vec3(0.8F), glm::vec3(0.8F), {overhead(), overhead()});
    scene.projectors[1].camera.size = {1, 1};
    scene.projectors[1].camera.principal = {0.0, 0.0};
    renderer.setEyeSize({64, 48});
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_EQ(renderer.readEye().size(), glm::ivec2(64, 48));
    EXPECT_EQ(renderer.readProjector(0).size(), glm::ivec2(480, 320));
    EXPECT_EQ(renderer.readProjector(1).size(), glm::ivec2(1, 1));
    const std::size_t two = renderer.objectCount();

    scene.projectors[0].camera.size = {200, 100};
    scene.projectors[1].enabled = false;
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_EQ(renderer.readProjector(0).size(), glm::ivec2(200, 100));
    EXPECT_EQ(renderer.projectorTexture(1), 0U);
    EXPECT_LT(renderer.objectCount(), two);

    scene.projectors.clear();
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_THROW((void)renderer.readProjector(0), InvalidInput);
    EXPECT_EQ(renderer.readEye().size(), glm::ivec2(64, 48));

    scene.projectors = {overhead()};
    scene.projectors[0].camera.size = {100'000, 10};
    EXPECT_THROW(renderer.draw(frameOf(scene, liftedFlaps())), InvalidInput);
    scene.projectors[0].camera.size = {100, 10};
    scene.projectors[0].camera.focal.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(renderer.draw(frameOf(scene, liftedFlaps())), InvalidInput);
    EXPECT_THROW(renderer.draw({}), InvalidInput);
    EXPECT_THROW(renderer.setEyeSize({0, 10}), InvalidInput);
    ShowFrame odd = frameOf(scene, liftedFlaps());
    odd.devicePositions = std::make_shared<const std::vector<glm::vec3>>(3);
    EXPECT_THROW(renderer.draw(odd), InvalidInput);
    ShowFrame nowhere = frameOf(unlitScene(glm::vec3(0.8F), glm::vec3(0.8F), {}), liftedFlaps());
    EXPECT_NO_THROW(renderer.draw(nowhere));
    nowhere.installation = nullptr;
    EXPECT_THROW(renderer.draw(nowhere), InvalidInput);
    EXPECT_THROW(renderer.drawEye(nowhere), InvalidInput);
}

// A lit scene of which each step changes something else than the one before.
ShowFrame changingFrame(int step) {
    SceneInRoom scene = defaultSceneInRoom();
    scene.projectors = {overhead()};
    scene.projectors[0].camera.size = {240, 160};
    scene.projectors[0].camera.focal *= 0.4;
    scene.projectors[0].camera.principal = {119.5, 79.5};
    scene.projectors[0].camera.distortion = {-0.3, 0.05, 0.002, -0.003, 0.0}; // bends edges beyond their ends
    scene.items.push_back(box({0.05F, 0.09F, 0.02F}, Anchor::device, {0.0F, 1.0F, 0.0F}));
    scene.items.back().id = 7;
    std::vector<double> strokes(bundledTablet()->actuatorCount(), 0.0);
    if (step >= 1) strokes[0] = 0.9;
    if (step >= 2) scene.eye = {0.3F, 0.4F, 0.4F};
    if (step >= 3) scene.items.back().position = {-0.14F, 0.05F, 0.1F};
    if (step >= 4) strokes[1] = 0.8;
    if (step >= 5) scene.items.front().position = {0.5F, 0.35F, 0.5F};
    if (step >= 6) scene.table.material.color = {0.3F, 0.5F, 0.8F};
    if (step >= 7) scene.worldFromDevice[3] = glm::vec4(0.06F, 0.0F, -0.03F, 1.0F);
    if (step >= 8) scene.items.pop_back();
    if (step >= 9) strokes.assign(strokes.size(), 1.0); // long shadows on the table
    if (step >= 10) scene.projectors[0].peak = 2.0;
    if (step >= 12) strokes[2] = 0.4; // it moves while nobody is there
    if (step >= 14) {                 // ink reaches beyond the rim, and no shadow does
        scene.table.material.unlit = true;
        std::get<LightItem>(scene.items.front().kind).shadows = false;
        scene.device.creases = {.emphasis = 0.6, .width = 0.1};
        scene.items.push_back(box({0.2F, 0.04F, 0.14F}, Anchor::world, {1.0F, 0.0F, 0.0F})); // another part
        scene.items.back().id = 8;
    }
    if (step >= 15) strokes[3] = 0.5;
    if (step >= 16) strokes[0] = 0.2;
    if (step >= 17) {
        scene.table.material.unlit = false;
        LightItem& lamp = std::get<LightItem>(scene.items.front().kind);
        lamp.kind = LightItem::Kind::lamp;
        lamp.shadows = true;
        lamp.softness = 0.3;
        scene.items.front().position = {0.15F, 0.3F, 0.1F};
    }
    if (step >= 18) strokes[4] = 0.3;
    ShowFrame frame = posed(frameOf(scene, strokes));
    if (step == 11 || step == 12 || step == 16) frame.eye.reset();
    return frame;
}

int differingPixels(const Image& first, const Image& second) {
    int count = 0;
    for (std::size_t i = 0; i < first.pixels().size(); ++i) count += first.pixels()[i] == second.pixels()[i] ? 0 : 1;
    return count;
}

TEST(SpatialFrames, PictureIsTheSameWhateverWasDrawnBefore) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    Image before;
    for (int step = 0; step <= 18; ++step) {
        const ShowFrame frame = changingFrame(step);
        renderer.draw(frame);
        const Image sent = renderer.readProjector(0);
        SpatialRenderer fresh;
        fresh.setEyeSize({320, 200});
        fresh.draw(frame);
        // Now and then a shadow's edge falls on the other side of a rounding.
        EXPECT_LE(differingPixels(sent, fresh.readProjector(0)), 3) << "step " << step;
        EXPECT_NE(sent, before) << "step " << step << " changes nothing";
        before = sent;
    }
}

/// Of a picture that two projectors share: how much brighter their middle is than it has to be, about 2 where they do
/// not know of one another.
double excess(const Image& sent, const Image& shared) {
    const auto light = [](const Image& image) {
        return std::pow((image.at(240, 160)[0] / 255.0 + 0.055) / 1.055, 2.4);
    };
    return light(sent) / light(shared);
}

// What needs the program is left out, from every projector, and nothing else.
TEST(SpatialFrames, WithoutAProjectorsShaderTheShowGoesOn) {
    const HeadlessContext context;
    constexpr bool kShares = true;
    const ShowFrame frame = frameOf(
        unlitScene(glm::vec3(0.5F, 0.1F, 0.1F), glm::vec3(0.1F, 0.5F, 0.1F), {overhead(), overhead()}), liftedFlaps());
    SpatialRenderer whole;
    whole.setEyeSize({320, 200});
    whole.draw(frame);
    for (const auto& [name, shares] : {std::pair("projector_surface.frag", kShares),
                                       {"projector.frag", kShares},
                                       {"projector_done.frag", kShares},
                                       {"projector_mixed.frag", kShares},
                                       {"projector_edges.frag", !kShares},
                                       {"projector_distance.frag", !kShares},
                                       {"projector_weight.frag", !kShares}}) {
        const BrokenShader broken(name);
        SpatialRenderer renderer;
        renderer.setEyeSize({320, 200});
        for (int i = 0; i < 2; ++i) renderer.draw(frame);
        const std::vector<std::string> warnings = renderer.warnings();
        ASSERT_EQ(warnings.size(), 1U) << name;
        EXPECT_NE(warnings.front().find(std::string(name) + ":3"), std::string::npos) << warnings.front();
        for (const std::size_t projector : {0U, 1U}) {
            const Image sent = renderer.readProjector(projector);
            const Image::Pixel device = sent.at(240, 160);
            const Image::Pixel table = sent.at(5, 160);
            EXPECT_GT(device[0], 2 * device[1]) << name << projector;
            EXPECT_GT(table[1], 2 * table[0]) << name << projector;
            EXPECT_NEAR(excess(sent, whole.readProjector(projector)), shares ? 1.0 : 2.0, 0.1) << name;
        }
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << name;
    }
}

TEST(SpatialFrames, WithoutEyeOrSharingWhatIsLeftIsDrawn) {
    const HeadlessContext context;
    const BrokenShader lookup("projector.frag");
    lookup.breakToo("projector_weight.frag");
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    for (int i = 0; i < 2; ++i)
        renderer.draw(
            frameOf(unlitScene(glm::vec3(0.5F, 0.1F, 0.1F), glm::vec3(0.1F), {overhead(), overhead()}), liftedFlaps()));
    EXPECT_EQ(renderer.warnings().size(), 2U);
    const Image::Pixel device = renderer.readProjector(1).at(240, 160);
    EXPECT_GT(device[0], 2 * device[1]);
}

TEST(SpatialFrames, WithoutTheShadersOfShadowsThereAreNone) {
    const HeadlessContext context;
    SceneInRoom scene = defaultSceneInRoom();
    scene.projectors = {overhead()};
    const auto sent = [&](SpatialRenderer& renderer) {
        renderer.setEyeSize({320, 200});
        for (int i = 0; i < 2; ++i) renderer.draw(posed(frameOf(scene, liftedFlaps())));
        return renderer.readProjector(0);
    };
    std::vector<std::string> warnings;
    Image without;
    {
        const BrokenShader broken("eye_tiles.frag");
        SpatialRenderer renderer;
        without = sent(renderer);
        warnings = renderer.warnings();
    }
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings.front().find("eye_tiles.frag:3"), std::string::npos) << warnings.front();
    SpatialRenderer renderer;
    EXPECT_GT(differingPixels(sent(renderer), without), 2'000);
    std::get<LightItem>(scene.items.front().kind).shadows = false;
    EXPECT_LE(differingPixels(sent(renderer), without), 3);
}

TEST(SpatialFrames, WithoutTheLabsShaderItShowsTheBareDevice) {
    const HeadlessContext context;
    const BrokenShader broken("lab.frag");
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    const ShowFrame frame =
        frameOf(unlitScene(glm::vec3(0.8F, 0.1F, 0.1F), glm::vec3(0.1F, 0.8F, 0.1F), {overhead()}), liftedFlaps());
    renderer.draw(frame);
    EXPECT_TRUE(renderer.warnings().empty());
    for (int i = 0; i < 2; ++i) {
        const Image lab = renderer.readLab(overhead().camera);
        EXPECT_GT(lab.at(240, 160)[0], 1.5 * lab.at(5, 160)[0]);
        EXPECT_GT(lab.at(5, 160)[0], 0);
    }
    ASSERT_EQ(renderer.warnings().size(), 1U);
    EXPECT_NE(renderer.warnings().front().find("lab.frag:3"), std::string::npos) << renderer.warnings().front();
    // What a projector reaches cannot be told, and is not made up.
    EXPECT_THROW(static_cast<void>(renderer.readMask()), DataError);
    renderer.draw(frame);
    EXPECT_GT(renderer.readProjector(0).at(240, 160)[0], 100);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

double linearOf(std::uint8_t value) {
    const double share = value / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

// Light adds up: what is seen in a dim room is what projectors make in a dark one, and what the room makes without
// them.
TEST(SpatialFrames, ARoomThatIsDimAddsItsLightAndShowsFloorAndWalls) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    SceneInRoom scene = unlitScene(glm::vec3(0.5F, 0.1F, 0.1F), glm::vec3(0.1F, 0.4F, 0.1F), {overhead()});
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    const CalibratedCamera low = cameraLookingAt({0.9, 0.5, 1.0}, {0.0, 0.0, 0.0}, {320, 200}, 160.0);
    const Image dark = renderer.readLab(low), dim = renderer.readLab(low, kDimRoom), bare = renderer.readBare(low);
    int black = 0, lit = 0, floor = 0, more = 0;
    for (std::size_t k = 0; k < dim.pixels().size(); ++k) {
        const Image::Pixel &without = dark.pixels()[k], &with = dim.pixels()[k], &room = bare.pixels()[k];
        black += with[0] + with[1] + with[2] == 0 ? 1 : 0;
        lit += without[0] + without[1] > 60 ? 1 : 0;
        floor += without == Image::Pixel{0, 0, 0, 255} ? 1 : 0;
        // Walls have a lamp of their own, and the device's sides what the table gives back: there it is more.
        for (std::size_t c = 0; c < 3; ++c) {
            if (with[c] > 250 || room[c] > 250) continue;
            const double sum = linearOf(without[c]) + linearOf(room[c]) * double{kDimRoom} / double{kWorkRoom};
            ASSERT_GT(linearOf(with[c]), sum - 0.006) << k;
            more += linearOf(with[c]) > sum + 0.006 && without[0] + without[1] > 60 ? 1 : 0;
        }
    }
    EXPECT_EQ(black, 0);
    EXPECT_GT(lit, 500);
    EXPECT_LT(more, 0.05 * 3 * lit) << "channels of what projectors light";
    EXPECT_GT(floor, 5000) << "what the table does not fill was black";
    EXPECT_EQ(renderer.warnings().size(), 0U);
}

TEST(SpatialFrames, WithoutEvenTheLabsStandInProjectorsGoOn) {
    const HeadlessContext context;
    const BrokenShader broken("flat.frag");
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.8F), glm::vec3(0.8F), {overhead()}), liftedFlaps());
    for (int i = 0; i < 2; ++i) {
        renderer.draw(frame);
        EXPECT_EQ(renderer.readLab(overhead().camera), Image(overhead().camera.size)) << "black";
        EXPECT_GT(renderer.readProjector(0).at(240, 160)[0], 100);
    }
    ASSERT_EQ(renderer.warnings().size(), 1U);
    EXPECT_NE(renderer.warnings().front().find("flat.frag:3"), std::string::npos) << renderer.warnings().front();
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(SpatialFrames, WithoutTheShaderOfPicturesTheyAreCopied) {
    const HeadlessContext context;
    const ShowFrame frame =
        frameOf(unlitScene(glm::vec3(0.8F, 0.1F, 0.1F), glm::vec3(0.1F, 0.8F, 0.1F), {overhead()}), liftedFlaps());
    const auto pictures = [&](SpatialRenderer& renderer) {
        renderer.setEyeSize({320, 200});
        renderer.draw(frame);
        return std::pair(renderer.readEye(), renderer.readLab(overhead().camera));
    };
    SpatialRenderer whole;
    const auto [eye, lab] = pictures(whole);
    const BrokenShader broken("picture_output.frag");
    SpatialRenderer renderer;
    const auto [copiedEye, copiedLab] = pictures(renderer);
    ASSERT_EQ(renderer.warnings().size(), 1U);
    EXPECT_NE(renderer.warnings().front().find("picture_output.frag:3"), std::string::npos)
        << renderer.warnings().front();
    // Upright, in its place and of its colour; how bright is up to the driver.
    for (const auto& [expected, copied] : {std::pair(&eye, &copiedEye), std::pair(&lab, &copiedLab)}) {
        const glm::ivec2 size = expected->size();
        ASSERT_EQ(copied->size(), size);
        int agreeing = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Image::Pixel a = expected->at(x, y);
                const Image::Pixel b = copied->at(x, y);
                if ((a[0] > a[1]) == (b[0] > b[1]) && (a[0] > 0) == (b[0] > 0)) ++agreeing;
            }
        EXPECT_GT(agreeing, 0.99 * size.x * size.y);
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

SceneTexture texture(const std::string& image, int columns = 1) {
    SceneTexture texture;
    texture.image = image;
    texture.columns = columns;
    texture.framesPerSecond = columns > 1 ? 20.0 : 0.0;
    return texture;
}

/// A scene of everything: pictures, a flip-book, waves, fog, two projectors.
SceneInRoom busyScene() {
    SceneInRoom scene = unlitScene({0.9F, 0.2F, 0.0F}, {0.0F, 0.3F, 0.9F}, {overhead(), overhead()});
    scene.device.material.colorTexture = texture("flip-book", 4);
    scene.device.creases.emphasis = 0.5;
    scene.table.material.colorTexture = texture("wood");
    scene.items.push_back(box({0.25F, 0.03F, 0.2F}, Anchor::world, {0.0F, 1.0F, 0.0F}));
    scene.items.back().material.unlit = false;
    scene.items.back().material.normalMaps[0] = texture("bumps");
    SceneItem water = box({0.0F, 0.04F, 0.0F}, Anchor::device, {0.2F, 0.4F, 0.9F});
    water.id = 2;
    HeightItem waves;
    waves.waves.emplace_back();
    water.kind = waves;
    scene.items.push_back(water);
    SceneItem fog = box({0.0F, 0.05F, 0.0F}, Anchor::device, {1.0F, 1.0F, 1.0F});
    fog.id = 3;
    fog.kind = FogItem{};
    scene.items.push_back(fog);
    SceneItem sun = box({0.3F, 0.8F, 0.3F}, Anchor::world, {1.0F, 1.0F, 1.0F});
    sun.id = 4;
    sun.kind = LightItem{};
    std::get<LightItem>(sun.kind).shadows = false; // their maps take most of a frame
    scene.items.push_back(sun);
    for (InstalledProjector& projector : scene.projectors) {
        projector.camera.size = {48, 32};
        projector.camera.focal *= 0.1;
        projector.camera.principal = {23.5, 15.5};
    }
    return scene;
}

/// The pictures of that scene; all but the flip-book are read anew.
std::shared_ptr<const SceneAssets> readAnew() {
    static const auto sheet = std::make_shared<const Image>(glm::ivec2(16, 4), Image::Pixel{90, 200, 40, 255});
    auto assets = std::make_shared<SceneAssets>();
    assets->images["flip-book"] = sheet;
    assets->images["wood"] = std::make_shared<const Image>(glm::ivec2(8), Image::Pixel{120, 80, 40, 255});
    assets->images["bumps"] = std::make_shared<const Image>(glm::ivec2(8), Image::Pixel{128, 128, 255, 255});
    return assets;
}

/// What the driver itself has, by kind.
std::array<std::size_t, 6> liveObjects() {
    constexpr GLuint kNames = 500000; // a driver need not use a name twice
    std::array<std::size_t, 6> count{};
    for (GLuint name = 1; name < kNames; ++name) {
        count[0] += glIsTexture(name);
        count[1] += glIsBuffer(name);
        count[2] += glIsVertexArray(name);
        count[3] += glIsFramebuffer(name);
        count[4] += glIsRenderbuffer(name);
        count[5] += glIsProgram(name);
    }
    return count;
}

TEST(SpatialFrames, ManyFramesKeepAsManyObjects) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({64, 40});
    SceneInRoom scene = busyScene();
    ScenePoser poser;
    const char* soak = std::getenv("LUMORPH_SOAK");
    const int frames = 150 * (soak != nullptr ? std::max(1, std::atoi(soak)) : 1);
    const CalibratedCamera observer = cameraLookingAt({0.0, 0.5, 0.5}, {0.0, 0.0, 0.0}, {32, 24}, 40.0);
    std::size_t settled = 0;
    std::array<std::size_t, 6> live{};
    auto assets = readAnew();
    for (int i = 0; i < frames; ++i) {
        std::vector<double> strokes(bundledTablet()->actuatorCount());
        for (std::size_t k = 0; k < strokes.size(); ++k) strokes[k] = 0.5 + 0.5 * std::sin(0.1 * i + double(k));
        scene.eye.x = 0.3F * std::sin(0.05F * static_cast<float>(i));
        ShowFrame frame = frameOf(scene, strokes);
        if (i % 5 == 4) assets = readAnew();
        frame.assets = assets;
        frame = posedBy(poser, std::move(frame), 0.05 * i);
        if (i % 10 == 9) frame.eye.reset();
        renderer.draw(frame);
        if (i % 50 == 0) (void)renderer.readLab(observer);
        if (i % 50 == 1 && frame.eye) (void)renderer.readMask();
        if (i == 60) {
            settled = renderer.objectCount();
            live = liveObjects();
        }
        if (i > 60) {
            ASSERT_EQ(renderer.objectCount(), settled) << i;
        }
    }
    EXPECT_EQ(liveObjects(), live);
    EXPECT_EQ(glGetError(), unsigned{GL_NO_ERROR});
}

} // namespace
} // namespace lumorph
