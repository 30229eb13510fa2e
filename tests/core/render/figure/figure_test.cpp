#include "core/render/figure/figure.h"

#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/gl/headless_context.h"
#include "tests/core/render/shapes.h"

namespace lumorph {
namespace {

Figure smallFigure() {
    Figure figure;
    figure.panels = {{"Fit", {{boxMesh({-0.05F, 0.0F, -0.04F}, {0.05F, 0.03F, 0.04F})}}},
                     {"Target", {{torusMesh(0.03F, 0.01F, 24), kAccentColor, 0.5F}}}};
    figure.footer = "IoU 0.91";
    return figure;
}

int luminance(const Image::Pixel& pixel) { return 2 * pixel[0] + 5 * pixel[1] + pixel[2]; }

bool inside(const FigureRect& rect, int x, int y) {
    return x >= rect.origin.x && y >= rect.origin.y && x < rect.origin.x + rect.size.x &&
           y < rect.origin.y + rect.size.y;
}

TEST(FigureLayout, StripsAndViewsDoNotOverlapAndFillTheWidth) {
    Figure figure = smallFigure();
    figure.panels.resize(3);
    const FigureLayout layout = layoutOf(figure, {1000, 400});
    for (int y = 0; y < 400; y += 7)
        for (int x = 0; x < 1000; ++x) {
            int owners = inside(layout.footer, x, y);
            for (const FigureRect& rect : layout.views) owners += inside(rect, x, y);
            for (const FigureRect& rect : layout.captions) owners += inside(rect, x, y);
            ASSERT_EQ(owners, 1) << x << " " << y;
        }
    EXPECT_THROW((void)layoutOf(figure, {30, 400}), InvalidInput);
    EXPECT_THROW((void)layoutOf(figure, {1000, 40}), InvalidInput);
    EXPECT_THROW((void)layoutOf(Figure(), {1000, 400}), InvalidInput);
}

TEST(Figure, ACaptionChangesPixelsOnlyInItsStrip) {
    const HeadlessContext context;
    FigureRenderer renderer;
    Figure figure = smallFigure();
    const glm::ivec2 size(640, 360);
    const Image before = renderer.render(figure, size);
    figure.panels[1].caption = "Another, much longer caption than there was";
    const Image captioned = renderer.render(figure, size);
    figure.footer = "Changed";
    const Image footed = renderer.render(figure, size);
    const FigureLayout layout = layoutOf(figure, size);
    std::array<int, 5> changed{}; // by the caption inside and outside its strip, nothing, by the footer likewise
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const bool byCaption = before.at(x, y) != captioned.at(x, y);
            const bool byFooter = captioned.at(x, y) != footed.at(x, y);
            ++changed[byCaption ? (inside(layout.captions[1], x, y) ? 0 : 1) : 2];
            ++changed[byFooter ? (inside(layout.footer, x, y) ? 3 : 4) : 2];
        }
    EXPECT_GT(changed[0], 500);
    EXPECT_EQ(changed[1], 0);
    EXPECT_GT(changed[3], 50);
    EXPECT_EQ(changed[4], 0);
}

TEST(Figure, PanelsAreSeenByOneCamera) {
    const HeadlessContext context;
    Figure figure = smallFigure();
    figure.panels.assign(3, figure.panels[0]); // the first has the scale bar
    const Image image = renderFigure(figure, {960, 360});
    const FigureLayout layout = layoutOf(figure, {960, 360});
    int objectPixels = 0;
    int different = 0;
    for (int y = 0; y < layout.views[0].size.y; ++y)
        for (int x = 320; x < 640; ++x) {
            if (luminance(image.at(x, y)) < 8 * 100) continue;
            ++objectPixels;
            different += std::abs(image.at(x, y)[1] - image.at(x + 320, y)[1]) > 3; // more than dither
        }
    EXPECT_EQ(different, 0);
    EXPECT_GT(objectPixels, 5000);
}

TEST(Figure, TheLightThemeIsLightAndTheDarkOneDark) {
    const HeadlessContext context;
    FigureRenderer renderer;
    Figure figure = smallFigure();
    EXPECT_LT(luminance(renderer.render(figure, {320, 200}).at(2, 2)), 8 * 60);
    figure.theme = Theme::light;
    EXPECT_GT(luminance(renderer.render(figure, {320, 200}).at(2, 2)), 8 * 190);
}

TEST(Figure, WhatLiesBehindATranslucentItemIsSeenThroughIt) {
    const HeadlessContext context;
    FigureRenderer renderer;
    const TriangleMesh inner = boxMesh({-0.01F, 0.01F, -0.01F}, {0.01F, 0.03F, 0.01F});
    const TriangleMesh outer = boxMesh({-0.04F, 0.0F, -0.04F}, {0.04F, 0.06F, 0.04F});
    Figure figure;
    const auto greenAtMiddle = [&](float opacity, const glm::vec3& color) {
        figure.panels = {{"", {{outer, glm::vec3(0.2F, 0.2F, 0.9F), opacity}, {inner, color}}}};
        const FigureLayout layout = layoutOf(figure, {320, 240});
        const glm::vec2 at = pixelOf(cameraOf(figure, layout), {0.0F, 0.02F, 0.0F}, glm::vec2(layout.views[0].size));
        return renderer.render(figure, {320, 240}).at(static_cast<int>(at.x), static_cast<int>(at.y))[1];
    };
    EXPECT_GT(greenAtMiddle(0.3F, {0.1F, 0.9F, 0.1F}), greenAtMiddle(0.3F, {0.1F, 0.1F, 0.1F}) + 40);
    EXPECT_EQ(greenAtMiddle(1.0F, {0.1F, 0.9F, 0.1F}), greenAtMiddle(1.0F, {0.1F, 0.1F, 0.1F}));
}

struct Hit {
    double distance;
    glm::dvec3 normal;
    int surface; // faces of one plane count as one
};

// First triangle, or the plane y = 0, that a ray meets: signed volumes, no code of the renderer.
std::optional<Hit> cast(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& ray) {
    std::optional<Hit> nearest;
    if (ray.y < 0.0) nearest = Hit{-from.y / ray.y, {0.0, 1.0, 0.0}, -1};
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - from;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - from;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - from;
        const double u = glm::dot(ray, glm::cross(c, b));
        const double v = glm::dot(ray, glm::cross(a, c));
        const double w = glm::dot(ray, glm::cross(b, a));
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0.0) continue;
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const double distance = glm::dot(a, normal) / glm::dot(ray, normal);
        if (distance > 1e-6 && (!nearest || distance < nearest->distance))
            nearest = Hit{distance, normal, static_cast<int>(i / 2)};
    }
    return nearest;
}

TEST(Figure, TheKeyShadowFallsWhereARayCastSaysSo) {
    const HeadlessContext context;
    TriangleMesh mesh = boxMesh({-0.10F, 0.0F, -0.07F}, {0.10F, 0.015F, 0.07F});
    append(mesh, boxMesh({-0.05F, 0.015F, -0.03F}, {-0.01F, 0.09F, 0.02F}));
    append(mesh, boxMesh({0.04F, 0.05F, -0.02F}, {0.09F, 0.06F, 0.03F})); // hovers
    Figure figure;
    figure.panels = {{"", {{mesh}}}};
    figure.lighting = {false, false};
    const glm::ivec2 size(720, 560);
    FigureRenderer renderer;
    const Image lit = renderer.render(figure, size);
    figure.lighting.keyShadow = true;
    const Image shadowed = renderer.render(figure, size);

    const FigureLayout layout = layoutOf(figure, size);
    const Camera camera = cameraOf(figure, layout);
    const glm::dvec2 view(layout.views[0].size);
    const glm::dvec3 eye(camera.eye);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.centre) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 down = glm::cross(forward, right);
    const double focal = 0.5 * view.y / std::tan(0.5 * camera.fieldOfView.inRadians());
    const auto through = [&](double x, double y) {
        return cast(mesh, eye,
                    glm::normalize(focal * forward + (x - 0.5 * view.x) * right + (y - 0.5 * view.y) * down));
    };
    const glm::dvec3 light(keyLightDirection());
    const double edge = 0.007; // half the soft edge on a surface that slopes away from the light, metres

    std::array<std::array<int, 2>, 2> table{}; // [ray cast says shadow][picture is darker]
    for (int y = 0; y < layout.views[0].size.y; y += 2)
        for (int x = 0; x < layout.views[0].size.x; x += 2) {
            const auto hit = through(x + 0.5, y + 0.5);
            if (!hit || glm::dot(hit->normal, light) < 0.2) continue;
            bool clear = true;
            for (const glm::dvec2& corner : {glm::dvec2(-1, -1), {2, -1}, {-1, 2}, {2, 2}}) {
                const auto other = through(x + corner.x, y + corner.y);
                clear = clear && other && other->surface == hit->surface;
            }
            const glm::dvec3 ray =
                glm::normalize(focal * forward + (x + 0.5 - 0.5 * view.x) * right + (y + 0.5 - 0.5 * view.y) * down);
            const glm::dvec3 point = eye + hit->distance * ray + 1e-5 * hit->normal;
            const glm::dvec3 across = glm::normalize(glm::cross(hit->normal, glm::dvec3(0.3, 0.4, 0.5)));
            const bool shadow = cast(mesh, point, light).has_value();
            for (int i = 0; i < 16 && clear; ++i) {
                const double turn = 0.7853981634 * i;
                const glm::dvec3 side = std::cos(turn) * across + std::sin(turn) * glm::cross(hit->normal, across);
                clear = cast(mesh, point + (i < 8 ? edge : 0.5 * edge) * side, light).has_value() == shadow;
            }
            if (!clear) continue;
            const bool darker = 100 * luminance(shadowed.at(x, y)) < 85 * luminance(lit.at(x, y));
            ++table[shadow][darker];
        }
    const int wrong = table[0][1] + table[1][0];
    const int agreeing = table[0][0] + table[1][1];
    EXPECT_GT(table[1][1], 1000);
    EXPECT_GT(table[0][0], 20'000);
    EXPECT_GE(agreeing, 99 * (agreeing + wrong) / 100)
        << "lit but dark " << table[0][1] << ", shadow but bright " << table[1][0] << ", of " << agreeing + wrong;
    RecordProperty("compared", agreeing + wrong);
    RecordProperty("disagreeing", wrong);
}

TEST(Figure, TheSkyIsHiddenUnderAndBesideThings) {
    const HeadlessContext context;
    FigureRenderer renderer;
    Figure figure;
    figure.panels = {{"", {{boxMesh({-0.04F, 0.0F, -0.04F}, {0.04F, 0.08F, 0.04F})}}}};
    figure.lighting = {false, false};
    const glm::ivec2 size(400, 320);
    const Image open = renderer.render(figure, size);
    figure.lighting.skyOcclusion = true;
    const Image hidden = renderer.render(figure, size);
    const FigureLayout layout = layoutOf(figure, size);
    const Camera camera = cameraOf(figure, layout);
    const auto darkening = [&](const glm::vec3& place) {
        const glm::ivec2 p(pixelOf(camera, place, glm::vec2(layout.views[0].size)));
        return static_cast<double>(luminance(hidden.at(p.x, p.y))) / luminance(open.at(p.x, p.y));
    };
    EXPECT_LT(darkening({0.0F, 0.0F, 0.044F}), 0.92); // at the foot half of the sky is hidden
    EXPECT_GT(darkening({0.0F, 0.08F, 0.0F}), 0.97);  // on top nothing is
}

// Names in use of every kind that the renderer makes.
std::array<int, 6> liveObjects() {
    std::array<int, 6> live{};
    for (GLuint name = 1; name < 5000; ++name) {
        live[0] += glIsBuffer(name);
        live[1] += glIsVertexArray(name);
        live[2] += glIsTexture(name);
        live[3] += glIsFramebuffer(name);
        live[4] += glIsRenderbuffer(name);
        live[5] += glIsProgram(name) + glIsShader(name);
    }
    return live;
}

TEST(Figure, TwoHundredFiguresLeaveNothingBehind) {
    const HeadlessContext context;
    const std::array<int, 6> empty = liveObjects();
    {
        FigureRenderer renderer;
        const Figure figure = smallFigure();
        (void)renderer.render(figure, {96, 80});
        const std::array<int, 6> once = liveObjects();
        EXPECT_NE(once, empty); // the count sees what the renderer keeps
        for (int i = 0; i < 200; ++i) (void)renderer.render(figure, {96, 80});
        EXPECT_EQ(liveObjects(), once);
    }
    EXPECT_EQ(liveObjects(), empty);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(Figure, RefusesWhatCannotBeDrawn) {
    const HeadlessContext context;
    FigureRenderer renderer;
    Figure figure = smallFigure();
    EXPECT_THROW((void)renderer.render(figure, {100'000, 300}), InvalidInput);
    figure.panels[0].items[0].opacity = 1.5F;
    EXPECT_THROW((void)renderer.render(figure, {320, 200}), InvalidInput);
    figure.panels = {{"empty", {}}};
    EXPECT_THROW((void)renderer.render(figure, {320, 200}), InvalidInput);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

} // namespace
} // namespace lumorph
