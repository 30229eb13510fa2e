#include "core/render/figure/studio_pass.h"

#include <algorithm>
#include <array>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/srgb.h"
#include "core/render/gl/program.h"
#include "core/render/gl/shadow_maps.h"
#include "core/render/viewport/studio_look.h"

namespace lumorph {
namespace {

constexpr int kKeyUnit = 0;
constexpr int kSkyUnit = 1;

// Takes the camera's view to its place in the larger region.
glm::mat4 regionFromView(const StudioView& view) {
    const glm::vec2 region(view.regionSize);
    const glm::vec2 scale = glm::vec2(view.viewSize) / region;
    const glm::vec2 viewCentre = glm::vec2(view.viewOrigin) + 0.5F * glm::vec2(view.viewSize);
    const glm::vec2 shift = 2.0F * (viewCentre - glm::vec2(view.regionOrigin) - 0.5F * region) / region;
    glm::mat4 matrix(1.0F);
    matrix[0][0] = scale.x;
    matrix[1][1] = scale.y;
    matrix[3][0] = shift.x;
    matrix[3][1] = -shift.y;
    return matrix;
}

float distanceTo(const glm::vec3& eye, const StudioSurface& surface) { return glm::distance(eye, surface.centre); }

} // namespace

struct StudioPass::Data {
    ShadowMaps key{768, 1};
    ShadowMaps sky{112, kSkyCount};
    Program backdrop{
        shaderFiles({"full_frame.vert"}, {"version.glsl", "noise.glsl", "backdrop.glsl", "backdrop.frag"})};
    Program ground{shaderFiles({"ground.vert"},
                               {"version.glsl", "noise.glsl", "backdrop.glsl", "studio_light.glsl", "ground.frag"})};
    Program surface{shaderFiles({"surface.vert"}, {"version.glsl", "noise.glsl", "backdrop.glsl", "studio_light.glsl",
                                                   "light_colors.glsl", "tone.glsl", "surface.frag"})};
    gl::VertexArray empty;
    std::array<glm::vec3, kSkyCount> skyDirections = lumorph::skyDirections();

    static void setBackdrop(Program& program, glm::ivec2 frameSize, const StudioPalette& palette) {
        program.set("frameSize", glm::vec2(frameSize));
        program.set("backdropTop", palette.top);
        program.set("backdropBottom", palette.bottom);
    }

    void setLight(Program& program, const StudioView& view, const glm::mat4& clipFromScene) const {
        program.set("clipFromWorld", clipFromScene);
        program.set("keyDirection", keyLightDirection());
        program.set("keyMapFromWorld", key.mapFromWorld()[0]);
        program.set("keyShadow", kKeyUnit);
        program.set("keySoftness", kKeySoftness);
        program.set("skyDirections", std::span<const glm::vec3>(skyDirections));
        program.set("skyMapFromWorld", sky.mapFromWorld());
        program.set("skyShadow", kSkyUnit);
        // Along the normal by more than what the soft edge spans in depth on a sloping surface.
        program.set("shadowBias",
                    glm::vec2(2.0F * key.texel() + 0.6F * kKeySoftness * key.texel() * static_cast<float>(key.side()),
                              1.8F * sky.texel()));
        program.set("sceneSphere", glm::vec4(view.scene.centre(), 0.5F * glm::length(view.scene.size())));
        program.set("keyShadowOn", view.lighting.keyShadow ? 1 : 0);
        program.set("skyOcclusionOn", view.lighting.skyOcclusion ? 1 : 0);
    }

    void drawGround(const StudioView& view, const StudioPalette& palette) {
        const StudioGround& place = view.ground;
        ground.set("groundCentre", place.centre);
        ground.set("groundHeight", place.height);
        ground.set("groundExtent", 12.0F * place.radius);
        ground.set("sceneRadius", place.radius);
        ground.set("gridStep", place.gridStep);
        ground.set("bar", glm::vec4(place.barStart, static_cast<float>(place.barSquares) * place.gridStep,
                                    place.barSquares > 0 ? 1.0F : 0.0F));
        ground.set("lineColor", palette.line);
        ground.set("lineStrength", palette.lineStrength);
        ground.set("shade", palette.shade);
        ground.set("pool", palette.pool);
        ground.set("regionSpan", glm::vec2(view.regionOrigin.x, view.regionOrigin.x + view.regionSize.x));
        glDisable(GL_CULL_FACE);
        glBindVertexArray(empty.name());
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        glBindVertexArray(0);
    }

    void setMaterial(const StudioSurface& item) {
        surface.set("baseColor", linearFromSrgb(item.color));
        surface.set("opacity", item.opacity);
        surface.set("rim", item.opacity < 1.0F ? 1.0F : 0.0F);
    }

    // Pulled a little towards the eye, so that where it lies on an opaque surface it tints that evenly.
    void drawTranslucent(const StudioSurface& item) {
        setMaterial(item);
        glEnable(GL_CULL_FACE);
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(-1.0F, -2.0F);
        glDepthMask(GL_FALSE);
        glCullFace(GL_FRONT);
        item.mesh->draw();
        // Only the nearest front face: its depth first, then its colour.
        glCullFace(GL_BACK);
        glDepthMask(GL_TRUE);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        item.mesh->draw();
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        item.mesh->draw();
        glDisable(GL_POLYGON_OFFSET_FILL);
        glDisable(GL_CULL_FACE);
    }
};

StudioPass::StudioPass() : data_(std::make_unique<Data>()) {}
StudioPass::~StudioPass() = default;
StudioPass::StudioPass(StudioPass&&) noexcept = default;
StudioPass& StudioPass::operator=(StudioPass&&) noexcept = default;

void StudioPass::drawBackdrop(GLuint framebuffer, glm::ivec2 frameSize, Theme theme) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, frameSize.x, frameSize.y);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    data_->backdrop.use();
    Data::setBackdrop(data_->backdrop, frameSize, studioPalette(theme));
    glBindVertexArray(data_->empty.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

void StudioPass::draw(GLuint framebuffer, glm::ivec2 frameSize, const StudioView& view,
                      std::span<const StudioSurface> surfaces) {
    const auto drawCasters = [&](Program& program) {
        program.set("worldFromMesh", glm::mat4(1.0F));
        for (const StudioSurface& item : surfaces)
            if (item.opacity >= 1.0F) item.mesh->draw();
    };
    const glm::vec3 key = keyLightDirection();
    if (view.lighting.keyShadow) data_->key.draw({&key, 1}, view.scene, drawCasters);
    if (view.lighting.skyOcclusion) data_->sky.draw(data_->skyDirections, view.scene, drawCasters);

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(view.regionOrigin.x, frameSize.y - view.regionOrigin.y - view.regionSize.y, view.regionSize.x,
               view.regionSize.y);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    data_->key.bind(kKeyUnit);
    data_->sky.bind(kSkyUnit);
    const StudioPalette palette = studioPalette(view.theme);
    const glm::mat4 clipFromScene = regionFromView(view) * clipFromWorld(view.camera);

    data_->surface.use();
    Data::setBackdrop(data_->surface, frameSize, palette);
    data_->setLight(data_->surface, view, clipFromScene);
    data_->surface.set("eye", view.camera.eye);
    data_->surface.set("exposure", palette.exposure);
    std::vector<StudioSurface> translucent;
    for (const StudioSurface& item : surfaces) {
        if (item.opacity < 1.0F) {
            translucent.push_back(item);
            continue;
        }
        data_->setMaterial(item);
        item.mesh->draw();
    }

    data_->ground.use();
    Data::setBackdrop(data_->ground, frameSize, palette);
    data_->setLight(data_->ground, view, clipFromScene);
    data_->drawGround(view, palette);

    std::stable_sort(translucent.begin(), translucent.end(), [&](const StudioSurface& a, const StudioSurface& b) {
        return distanceTo(view.camera.eye, a) > distanceTo(view.camera.eye, b);
    });
    data_->surface.use();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE);
    for (const StudioSurface& item : translucent) data_->drawTranslucent(item);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(0);
}

} // namespace lumorph
