#include "core/render/viewport_renderer.h"

#include <algorithm>
#include <array>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/render/headless_context.h"
#include "tests/core/render/viewport_scenes.h"

namespace lumorph {
namespace {

const glm::ivec2 kSize(400, 320);
constexpr std::array kBoth{ViewportQuality::moving, ViewportQuality::still};

ViewCamera cameraAt(double distance, double yaw = 20.0, double pitch = 30.0) {
    ViewCamera camera;
    camera.yaw = Angle::degrees(yaw);
    camera.pitch = Angle::degrees(pitch);
    camera.distance = distance;
    return camera;
}

ViewportScene sphereScene(const glm::vec3& color = {0.9F, 0.2F, 0.2F}) {
    ViewportScene scene;
    scene.surfaces = {surfaceOf(sphereMesh(0.05F, 5), color)};
    scene.bounds = {glm::vec3(-0.05F), glm::vec3(0.05F)};
    scene.groundHeight = -0.06F;
    scene.grid = false;
    return scene;
}

glm::ivec2 at(const ViewCamera& camera, const glm::vec3& point) {
    return {pixelOf(camera, point, glm::vec2(kSize)).value()};
}

int grey(const Image::Pixel& p) { return (p[0] + p[1] + p[2]) / 3; }
bool reddish(const Image::Pixel& p) { return p[0] > 1.6 * p[1] && p[0] > 1.6 * p[2]; }

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

TEST(ViewportRenderer, ATintedSurfaceShowsTheClassOfTheVoxelsItPasses) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene({0.8F, 0.8F, 0.8F});
    scene.surfaces[0].tinted = true;
    ViewportTint tint;
    tint.frame = {glm::vec3(-0.06F), 0.005, glm::ivec3(24)};
    std::vector<std::uint8_t> classes(24 * 24 * 24);
    for (std::size_t i = 0; i < classes.size(); ++i) classes[i] = i % 24 < 12 ? (i / 24 % 24 < 12 ? 1 : 2) : 0;
    tint.classes = std::make_shared<const std::vector<std::uint8_t>>(classes);
    tint.colors = {glm::vec4(0.0F), glm::vec4(0.9F, 0.1F, 0.1F, 0.9F), glm::vec4(0.1F, 0.8F, 0.1F, 0.9F)};
    scene.tint = tint;
    for (const ViewportQuality quality : kBoth) {
        const ViewCamera camera = cameraAt(0.4, 0.0, 0.0);
        const auto drawn = [&](const Image& image, float x, float y) {
            const glm::ivec2 p = at(camera, {x, y, std::sqrt(0.0025F - x * x - y * y)});
            return image.at(p.x, p.y);
        };
        const Image image = draw(renderer, scene, camera, kSize, quality);
        for (const float a : {0.012F, 0.02F, 0.028F}) {
            EXPECT_TRUE(reddish(drawn(image, -a, -a))) << a;
            const Image::Pixel green = drawn(image, -a, a);
            EXPECT_GT(green[1], 1.6 * green[0]) << a;
            const Image::Pixel plain = drawn(image, a, a);
            EXPECT_LT(std::abs(plain[0] - plain[1]), 14) << a;
        }
    }
}

TEST(ViewportRenderer, OtherClassesAreShownAtOnce) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene({0.8F, 0.8F, 0.8F});
    scene.surfaces[0].tinted = true;
    const ViewCamera camera = cameraAt(0.4, 0.0, 0.0);
    const auto middle = [&](std::uint8_t value) {
        ViewportTint tint;
        tint.frame = {glm::vec3(-0.06F), 0.005, glm::ivec3(24)};
        tint.classes = std::make_shared<const std::vector<std::uint8_t>>(24 * 24 * 24, value);
        tint.colors[1] = {0.9F, 0.1F, 0.1F, 1.0F};
        scene.tint = tint;
        return draw(renderer, scene, camera, kSize, ViewportQuality::moving).at(200, 160);
    };
    EXPECT_TRUE(reddish(middle(1)));
    EXPECT_FALSE(reddish(middle(0)));
    EXPECT_TRUE(reddish(middle(1)));
}

TEST(ViewportRenderer, TheOutlineRunsAroundTheSelectedSurfaceOnly) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    for (const float opacity : {1.0F, 0.5F})
        for (const ViewportQuality quality : kBoth) {
            ViewportScene scene = sphereScene({0.8F, 0.8F, 0.8F});
            scene.surfaces[0].opacity = opacity;
            scene.accent = {1.0F, 0.0F, 1.0F};
            const ViewCamera camera = cameraAt(0.4, 0.0, 0.0);
            const Image plain = draw(renderer, scene, camera, kSize, quality);
            scene.surfaces[0].outlined = true;
            const Image outlined = draw(renderer, scene, camera, kSize, quality);
            const glm::vec2 middle = glm::vec2(at(camera, glm::vec3(0.0F)));
            // The silhouette of a sphere in perspective.
            const float radius = 0.05F / std::sqrt(0.16F - 0.0025F) * 160.0F / std::tan(glm::radians(14.0F));
            int width = 0;
            for (int x = static_cast<int>(middle.x); x < kSize.x; ++x) {
                const int difference = apart(plain.at(x, 160), outlined.at(x, 160));
                const auto away = static_cast<float>(x) + 0.5F - 200.0F;
                if (away < radius - 1.5F || away > radius + 4.0F)
                    EXPECT_LE(difference, 3) << away;
                else if (outlined.at(x, 160)[0] > 200 && outlined.at(x, 160)[1] < 100)
                    ++width;
            }
            EXPECT_GE(width, 2) << opacity << " " << static_cast<int>(quality);
            EXPECT_LE(width, 3) << opacity << " " << static_cast<int>(quality);
        }
}

TEST(ViewportRenderer, AVoxelIsACubeOfItsColourInItsPlace) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene;
    ViewportVoxels cloud;
    cloud.frame = {glm::vec3(-0.05F), 0.01, glm::ivec3(10)};
    cloud.voxels = std::make_shared<const std::vector<ViewportVoxel>>(
        std::vector<ViewportVoxel>{{2, 7, 5, 0, {220, 40, 40, 255}}, {7, 2, 5, 0, {40, 60, 220, 255}}});
    scene.voxels = {cloud};
    scene.bounds = cloud.frame.box();
    scene.groundHeight = -0.05F;
    scene.grid = false;
    for (const float opacity : {1.0F, 0.6F})
        for (const ViewportQuality quality : kBoth) {
            scene.voxels[0].opacity = opacity;
            const ViewCamera camera = cameraAt(0.4);
            const Image image = draw(renderer, scene, camera, kSize, quality);
            glm::vec2 low(1e9F);
            glm::vec2 high(-1e9F);
            glm::vec2 lowSeen(1e9F);
            glm::vec2 highSeen(-1e9F);
            const glm::vec3 centre(cloud.frame.centre(2, 7, 5));
            for (unsigned k = 0; k < 8; ++k) {
                const glm::vec3 side(k & 1U ? 1 : -1, k & 2U ? 1 : -1, k & 4U ? 1 : -1);
                const glm::vec2 p = *pixelOf(camera, centre + 0.0046F * side, glm::vec2(kSize));
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x)
                    if (reddish(image.at(x, y))) {
                        lowSeen = glm::min(lowSeen, glm::vec2(x, y));
                        highSeen = glm::max(highSeen, glm::vec2(x + 1, y + 1));
                    }
            EXPECT_LT(glm::distance(low, lowSeen), 2.0F);
            EXPECT_LT(glm::distance(high, highSeen), 2.0F);
            const glm::ivec2 blue = at(camera, glm::vec3(cloud.frame.centre(7, 2, 5)));
            EXPECT_GT(image.at(blue.x, blue.y)[2], 1.6 * image.at(blue.x, blue.y)[0]);
        }
}

TEST(ViewportRenderer, ALineIsAsWideAsItSaysTimesTheScale) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    for (const ViewportQuality quality : kBoth)
        for (const float scale : {1.0F, 2.0F}) {
            ViewportScene scene;
            scene.grid = false;
            scene.groundHeight = -1.0F;
            scene.lines = {{{-0.05F, 0.0F, 0.0F}, {0.05F, 0.0F, -0.1F}, {1.0F, 1.0F, 1.0F}, 3.0F}};
            const ViewCamera camera = cameraAt(0.4, 0.0, 0.0);
            const Image with = draw(renderer, scene, camera, kSize, quality, scale);
            scene.lines.clear();
            const Image without = draw(renderer, scene, camera, kSize, quality, scale);
            for (const int x : {150, 200, 240}) {
                double width = 0.0; // sum of the coverage down a column
                for (int y = 0; y < kSize.y; ++y)
                    width += static_cast<double>(with.at(x, y)[1] - without.at(x, y)[1]) / (255 - without.at(x, y)[1]);
                EXPECT_NEAR(width, static_cast<double>(3.0F * scale), 0.35) << x;
            }
        }
}

TEST(ViewportRenderer, ALineOnTopShinesFaintlyThroughASurface) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene({0.1F, 0.1F, 0.1F});
    const ViewCamera camera = cameraAt(0.4, 0.0, 0.0);
    const auto green = [&](bool onTop, const glm::vec3& from, const glm::vec3& to) {
        scene.lines = {{from, to, {0.0F, 1.0F, 0.0F}, 5.0F, onTop}};
        return static_cast<int>(draw(renderer, scene, camera, kSize, ViewportQuality::moving).at(200, 160)[1]);
    };
    const int hidden = green(false, {-0.1F, 0, 0}, {0.1F, 0, 0});
    const int faint = green(true, {-0.1F, 0, 0}, {0.1F, 0, 0});
    const int full = green(true, {-0.1F, 0, 0.1F}, {0.1F, 0, 0.1F});
    EXPECT_LT(hidden, 80);
    EXPECT_GT(faint, hidden + 40);
    EXPECT_GT(full, faint + 40);
}

TEST(ViewportRenderer, TheOrderOfTranslucentThingsInTheListDoesNotMatter) {
    const HeadlessContext context;
    ViewportRenderer renderer;
    ViewportScene scene = sphereScene();
    scene.surfaces[0].opacity = 0.5F;
    for (int i = 1; i < 4; ++i) {
        scene.surfaces.push_back(scene.surfaces[0]);
        scene.surfaces.back().color = {0.2F * static_cast<float>(i), 0.9F, 0.9F - 0.3F * static_cast<float>(i)};
        scene.surfaces.back().worldFromSurface =
            glm::translate(glm::mat4(1.0F), glm::vec3(0.03F, 0.01F, -0.07F) * static_cast<float>(i));
    }
    for (const ViewportQuality quality : kBoth) {
        const Image once = draw(renderer, scene, cameraAt(0.6), kSize, quality);
        std::reverse(scene.surfaces.begin(), scene.surfaces.end());
        const Image again = draw(renderer, scene, cameraAt(0.6), kSize, quality);
        int worst = 0;
        for (std::size_t i = 0; i < once.pixels().size(); ++i)
            worst = std::max(worst, apart(once.pixels()[i], again.pixels()[i]));
        EXPECT_LE(worst, 1);
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
    EXPECT_EQ(after, expected);
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
