#include "core/render/viewport/viewport_renderer.h"

#include <algorithm>
#include <array>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/render/gl/headless_context.h"
#include "core/render/viewport/studio_look.h"
#include "tests/core/render/viewport/viewport_scenes.h"

namespace lumorph {
namespace {

TEST(ViewportRenderer, ASphereCoversExactlyThePixelsWhoseRaysMeetIt) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    for (const bool parallel : {false, true})
        for (const ViewportQuality quality : kBoth) {
            ViewCamera camera = cameraAt(0.4);
            camera.orthographic = parallel;
            const Image image = draw(renderer, sphereScene(), camera, kSize, quality);
            int wrong = 0;
            int covered = 0;
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x) {
                    const Ray ray = rayThrough(camera, {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F},
                                               glm::vec2(kSize));
                    const float along = -glm::dot(ray.origin, ray.direction);
                    const float aside = glm::length(ray.origin + along * ray.direction);
                    const float pixel = metresPerPixel(camera, glm::vec3(0.0F), glm::vec2(kSize));
                    if (std::abs(aside - 0.05F) < pixel) continue; // the edge
                    covered += aside < 0.05F;
                    wrong += reddish(image.at(x, y)) != (aside < 0.05F);
                }
            EXPECT_EQ(wrong, 0) << parallel << " " << static_cast<int>(quality);
            EXPECT_GT(covered, 15'000);
        }
}

TEST(ViewportRenderer, TheGroundIsDarkerOnTheSideAwayFromTheLight) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    const glm::vec3 light = keyLightDirection();
    const glm::vec3 shadow = (-0.06F / light.y) * light; // below the middle of the sphere
    for (const ViewportQuality quality : kBoth) {
        const ViewCamera camera = cameraAt(0.5, 0.0, 70.0);
        const Image image = draw(renderer, scene, camera, kSize, quality);
        const glm::vec3 outside(shadow.x + 0.05F, -0.06F, shadow.z - 0.02F);
        const glm::vec3 opposite(-outside.x, -0.06F, -outside.z);
        const glm::ivec2 dark = at(camera, outside);
        const glm::ivec2 bright = at(camera, opposite);
        EXPECT_LT(grey(image.at(dark.x, dark.y)), 0.8 * grey(image.at(bright.x, bright.y)));
    }
}

TEST(ViewportRenderer, TheTwoQualitiesAgree) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    scene.grid = true;
    scene.surfaces[0].paper = 1.0F;
    scene.surfaces.push_back(surfaceOf(boxMesh({0.06F, -0.06F, -0.05F}, {0.12F, 0.04F, 0.05F}), {0.2F, 0.6F, 0.8F}, 2));
    scene.surfaces[1].opacity = 0.5F;
    scene.surfaces[1].outlined = true;
    scene.bounds.max.x = 0.12F;
    scene.lines = {{{-0.1F, 0, 0}, {0.1F, 0.1F, 0}, {1, 1, 0}, 2.0F, true}};
    for (const Theme theme : {Theme::dark, Theme::light}) {
        scene.theme = theme;
        const Image moving = draw(renderer, scene, cameraAt(0.6), kSize, ViewportQuality::moving);
        const Image still = draw(renderer, scene, cameraAt(0.6), kSize, ViewportQuality::still);
        double sum = 0.0;
        for (std::size_t i = 0; i < moving.pixels().size(); ++i) sum += apart(moving.pixels()[i], still.pixels()[i]);
        EXPECT_LT(sum / static_cast<double>(moving.pixels().size()), 5.0);
        EXPECT_TRUE(std::all_of(still.pixels().begin(), still.pixels().end(), [](auto& p) { return p[3] == 255; }));
        EXPECT_TRUE(std::all_of(moving.pixels().begin(), moving.pixels().end(), [](auto& p) { return p[3] == 255; }));
    }
}

TEST(ViewportRenderer, TheBackdropFollowsTheTheme) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    for (const ViewportQuality quality : kBoth) {
        scene.theme = Theme::dark;
        EXPECT_LT(grey(draw(renderer, scene, cameraAt(0.5), kSize, quality).at(3, 3)), 60);
        scene.theme = Theme::light;
        EXPECT_GT(grey(draw(renderer, scene, cameraAt(0.5), kSize, quality).at(3, 3)), 190);
    }
}

TEST(ViewportRenderer, AStillFrameIsGivenUpWhenAskedTo) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    const ViewportScene scene = sphereScene();
    const FrameTarget target(kSize, 0);
    int pieces = 0;
    const auto drawn = [&](ViewportQuality quality, int last) {
        pieces = 0;
        return renderer.draw(target.framebuffer(), kSize, scene, cameraAt(0.5), quality, 1.0F,
                             [&] { return ++pieces == last; });
    };
    EXPECT_FALSE(drawn(ViewportQuality::still, 1));
    EXPECT_EQ(pieces, 1);
    EXPECT_FALSE(drawn(ViewportQuality::still, 10));
    EXPECT_EQ(pieces, 10);
    EXPECT_TRUE(drawn(ViewportQuality::still, -1));
    const Image after = target.read();
    ViewportRenderer fresh; // what was given up leaves no trace
    const Image expected = draw(fresh, scene, cameraAt(0.5), kSize, ViewportQuality::still);
    ASSERT_EQ(after.size(), expected.size());
    int different = 0; // the pieces may be others, and with them the last bits of an edge
    for (std::size_t i = 0; i < after.pixels().size(); ++i)
        different += apart(after.pixels()[i], expected.pixels()[i]) > 2;
    EXPECT_LT(different, 30);
}

TEST(ViewportRenderer, ManyScenesLeaveNothingBehindAndNoError) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    const ViewportScene fixed = sphereScene();
    const glm::ivec2 size(96, 72);
    const auto settle = [&] {
        for (int i = 0; i < 3; ++i)
            for (const ViewportQuality quality : kBoth) (void)draw(renderer, fixed, cameraAt(0.5), size, quality);
        return renderer.objectCount();
    };
    std::mt19937 random(5);
    const auto any = [&] { return static_cast<float>(random() % 1000) / 1000.0F; };
    const auto place = [&] { return 0.2F * glm::vec3(any(), any(), any()) - 0.1F; };
    std::size_t settled = 0;
    std::weak_ptr<const std::vector<glm::vec3>> last;
    for (int i = 0; i < 200; ++i) {
        ViewportScene scene;
        for (unsigned k = random() % 4; k > 0; --k) {
            scene.surfaces.push_back(surfaceOf(torusMesh(0.03F, 0.01F, 12), {any(), any(), any()}));
            ViewportSurface& surface = scene.surfaces.back();
            surface.worldFromSurface = glm::scale(glm::translate(glm::mat4(1.0F), place()), glm::vec3(any(), -1, 1));
            surface.opacity = any() < 0.5F ? 1.0F : any();
            surface.tinted = any() < 0.5F;
            surface.outlined = any() < 0.5F;
            last = surface.positions;
        }
        for (unsigned k = random() % 3; k > 0; --k) {
            std::vector<ViewportVoxel> voxels(random() % 50);
            for (ViewportVoxel& voxel : voxels) voxel.x = static_cast<std::uint16_t>(random() % 12); // some outside
            scene.voxels.push_back({k,
                                    {place(), 0.01, glm::ivec3(10)},
                                    std::make_shared<const std::vector<ViewportVoxel>>(voxels),
                                    any()});
        }
        for (unsigned k = random() % 5; k > 0; --k)
            scene.lines.push_back({10.0F * place(), place(), {any(), any(), any()}, 4.0F * any(), any() < 0.5F});
        if (any() < 0.5F) {
            scene.tint.emplace();
            scene.tint->frame = {place(), 0.02, glm::ivec3(5)};
            scene.tint->classes = std::make_shared<const std::vector<std::uint8_t>>(any() < 0.1F ? 7 : 125, 200);
        }
        if (any() < 0.8F) scene.bounds = {glm::vec3(-0.15F), glm::vec3(0.15F)};
        scene.grid = any() < 0.7F;
        scene.theme = any() < 0.5F ? Theme::dark : Theme::light;
        ViewCamera camera = cameraAt(0.01 + any(), 360.0 * static_cast<double>(any()), 180.0 * any() - 90.0);
        camera.orthographic = any() < 0.5F;
        (void)draw(renderer, scene, camera, size, kBoth[random() % 2]);
        ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << i;
        if (i == 40) settled = settle();
    }
    EXPECT_EQ(settle(), settled);
    EXPECT_TRUE(last.expired()); // nothing of a scene outlives its frames
}

TEST(ViewportRenderer, TheObjectsCountedAreThoseThere) {
    const HeadlessContext context;
    const auto live = [] {
        std::size_t count = 0;
        for (GLuint name = 1; name < 2000; ++name)
            count += glIsBuffer(name) + glIsVertexArray(name) + glIsTexture(name) + glIsFramebuffer(name) +
                     glIsRenderbuffer(name) + glIsProgram(name) + glIsShader(name);
        return count;
    };
    {
        ViewportRenderer renderer;
        ViewportScene scene = sphereScene();
        scene.surfaces[0].outlined = true;
        scene.lines = {{{0, 0, 0}, {0.1F, 0, 0}}};
        const FrameTarget target(kSize, 0);
        const std::size_t of = live();
        for (const ViewportQuality quality : kBoth)
            for (int i = 0; i < 50; ++i) {
                scene.surfaces[0].positions =
                    std::make_shared<const std::vector<glm::vec3>>(*scene.surfaces[0].positions);
                if (quality == ViewportQuality::moving || i < 2)
                    (void)renderer.draw(target.framebuffer(), kSize, scene, cameraAt(0.5), quality);
            }
        EXPECT_LE(renderer.objectCount(), of + 40);
        EXPECT_EQ(renderer.objectCount(), live() - 5U); // less those of the target
    }
    EXPECT_EQ(live(), 0U);
}

TEST(ViewportRenderer, NewPositionsAreShownInTheNextFrame) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    const ViewCamera camera = cameraAt(0.6, 0.0, 0.0);
    const auto redAt = [&](const glm::vec3& place) {
        auto moved = std::make_shared<std::vector<glm::vec3>>(sphereMesh(0.05F, 5).positions);
        for (glm::vec3& p : *moved) p += place;
        scene.surfaces[0].positions = moved;
        const glm::ivec2 p = at(camera, place);
        return reddish(draw(renderer, scene, camera, kSize, ViewportQuality::moving).at(p.x, p.y));
    };
    EXPECT_TRUE(redAt({0.0F, 0.0F, 0.0F}));
    EXPECT_TRUE(redAt({0.11F, 0.0F, 0.0F}));
    EXPECT_TRUE(redAt({-0.11F, 0.03F, 0.0F}));
}

TEST(ViewportRenderer, TheGroundHidesWhatLiesBelowItFromAboveOnly) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    scene.groundHeight = 0.06F;
    for (const ViewportQuality quality : kBoth) {
        EXPECT_FALSE(reddish(draw(renderer, scene, cameraAt(0.4, 20, 40), kSize, quality).at(200, 160)));
        EXPECT_TRUE(reddish(draw(renderer, scene, cameraAt(0.4, 20, -40), kSize, quality).at(200, 160)));
    }
}

TEST(ViewportGrid, StepsByTensWithRoomBetweenTheLines) {
    const glm::vec2 size(1000.0F, 800.0F);
    ViewCamera camera;
    std::string before;
    for (camera.distance = 0.01; camera.distance < 50.0; camera.distance *= 1.3) {
        const ViewportGrid grid = gridOf(camera, size);
        const float pixels = grid.step / metresPerPixel(camera, camera.pivot, size);
        EXPECT_GE(pixels, 8.9F);
        EXPECT_LE(pixels, 91.0F);
    }
    camera.distance = 0.6;
    EXPECT_EQ(gridOf(camera, size).label, "1 cm");
    EXPECT_FLOAT_EQ(gridOf(camera, size).step, 0.01F);
    camera.distance = 0.06;
    EXPECT_EQ(gridOf(camera, size).label, "1 mm");
    camera.distance = 6.0;
    EXPECT_EQ(gridOf(camera, size).label, "10 cm");
    camera.distance = 60.0;
    EXPECT_EQ(gridOf(camera, size).label, "1 m");
}

TEST(ViewportPicture, IsTheSameAtAnySizeUpToItsPixels) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    const ViewportScene scene = sphereScene();
    const Image small = renderViewport(renderer, scene, cameraAt(0.4), {300, 240});
    const Image large = renderViewport(renderer, scene, cameraAt(0.4), {1500, 1200}); // more than one piece wide
    ASSERT_EQ(large.size(), glm::ivec2(1500, 1200));
    double sum = 0.0;
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 300; ++x) sum += apart(small.at(x, y), large.at(5 * x + 2, 5 * y + 2));
    EXPECT_LT(sum / (300.0 * 240.0), 2.0);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

} // namespace
} // namespace lumorph
