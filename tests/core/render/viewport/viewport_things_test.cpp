#include <algorithm>
#include <array>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/render/gl/headless_context.h"
#include "tests/core/render/viewport/viewport_scenes.h"

namespace lumorph {
namespace {

TEST(ViewportThings, ATintedSurfaceShowsTheClassOfTheVoxelsItPasses) {
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

TEST(ViewportThings, OtherClassesAreShownAtOnce) {
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

TEST(ViewportThings, TheOutlineRunsAroundTheSelectedSurfaceOnly) {
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

TEST(ViewportThings, AVoxelIsACubeOfItsColourInItsPlace) {
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

TEST(ViewportThings, ALineIsAsWideAsItSaysTimesTheScale) {
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

TEST(ViewportThings, ALineOnTopShinesFaintlyThroughASurface) {
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

TEST(ViewportThings, TheOrderOfTranslucentThingsInTheListDoesNotMatter) {
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
        // The pieces of a still frame follow the time they take, and where two meet a pixel may round otherwise.
        int worst = 0;
        std::size_t differing = 0;
        for (std::size_t i = 0; i < once.pixels().size(); ++i) {
            const int by = apart(once.pixels()[i], again.pixels()[i]);
            worst = std::max(worst, by);
            differing += by > 1 ? 1 : 0;
        }
        const bool still = quality == ViewportQuality::still;
        EXPECT_LE(worst, still ? 12 : 1);
        EXPECT_LE(differing, still ? once.pixels().size() / 1000 : 0U);
    }
}

} // namespace
} // namespace lumorph
