#include <algorithm>

#include <epoxy/gl.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/render/draw_state.h"
#include "core/render/eye_pass_data.h"
#include "core/render/eye_skin.h"
#include "core/render/table_shadow.h"

// The eye pass's things, and the shadows they cast.

namespace lumorph {
namespace {

constexpr float kNearSideStepsBack = 0.012F; // metres; as much as depth changes over a tile of the map on a slant

} // namespace

bool EyePass::Data::showsSkin(const ShowFrame& frame) const {
    return surfaces.hasSkin() && frame.scene->device.show == DeviceSkin::Show::material;
}

std::vector<EyePass::Data::Thing> EyePass::Data::shadowThings(const ShowFrame& frame) const {
    std::vector<Thing> things;
    if (showsSkin(frame)) things.push_back(skinThing(frame, false));
    for (const auto& item : surfaces.items()) {
        const PosedSurface& surface = frame.posed.surfaces[item.surface];
        if (!surface.castsShadow) continue;
        const float own = surface.material.alpha == Material::Alpha::blend ? surface.material.opacity : 1.0F;
        things.push_back({item.mesh, surface.worldFromSurface, &surface.material, own * surface.opacity,
                          materials.features(surface.material) | eye_feature::twoSided, 0.0F, false, item.version});
    }
    for (Thing& thing : things) {
        thing.features &= eye_feature::skin | eye_feature::holes | eye_feature::holeMask | eye_feature::cutout |
                          eye_feature::twoSided | kMostRoundHoles << eye_feature::holeShift;
        if (thing.opacity < 1.0F) thing.features |= eye_feature::dither;
    }
    return things;
}

void EyePass::Data::drawShadow(const ShowFrame& frame) {
    if (!shadowProblem.empty()) lighting.dropShadow();
    if (!lighting.shadowed()) return;
    const std::vector<Thing> things = shadowThings(frame);
    std::vector<CasterState> states;
    for (const Thing& thing : things) {
        const auto [picture, placement] = materials.cutter(*thing.material, thing.features);
        states.push_back({thing.version, thing.world, thing.opacity, thing.features, picture, placement,
                          thing.material->holeThreshold});
    }
    shadow.aim(*lighting.shadowed(), casterBounds(frame));
    if (!shadow.changed(std::move(states), frame.scene->device)) return;
    try {
        shadow.draw([&](const glm::mat4& clipFromWorld) {
            for (const Thing& thing : things) drawCaster(frame, thing, clipFromWorld);
        });
    } catch (const DataError& error) {
        shadowProblem = error.subject() + ": " + error.why() + "; there are no shadows";
        lighting.dropShadow();
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_DEPTH_CLAMP);
        glDisable(GL_CULL_FACE);
    }
}

void EyePass::Data::drawCaster(const ShowFrame& frame, const Thing& thing, const glm::mat4& clipFromWorld) {
    Program& program = programs.use(EyePrograms::Stage::depth, thing.features & ~eye_feature::twoSided);
    program.set("clipFromWorld", clipFromWorld);
    program.set("worldFromMesh", thing.world);
    program.set("castShare", thing.opacity);
    program.set("stepBack", 0.0F);
    materials.applyDepth(program, *thing.material, thing.features);
    if (thing.skin) applySkin(program, frame.scene->device, surfaces.skinBoxAtRest(), frame.worldFromDevice);
    setFrontFace(thing.world);
    // The near side of closed things steps back: then most places of it are told lit at first sight. What it covers the
    // far side covers too, or the near side itself where the thing is thicker than the step.
    const bool closed = (thing.features & eye_feature::twoSided) == 0;
    (closed ? glEnable : glDisable)(GL_CULL_FACE);
    if (closed) {
        glCullFace(GL_FRONT);
        thing.mesh->draw();
        glCullFace(GL_BACK);
        program.set("stepBack", shadow.depthOf(kNearSideStepsBack));
    }
    thing.mesh->draw();
}

EyePass::Data::Thing EyePass::Data::skinThing(const ShowFrame& frame, bool unseen) const {
    const DeviceSkin& skin = frame.scene->device;
    Thing thing{&surfaces.skin(),
                frame.worldFromDevice,
                &skin.material,
                1.0F,
                materials.features(skin.material, unseen),
                0.0F,
                true,
                surfaces.skinVersion()};
    if (!unseen) thing.features |= skinFeatures(skin);
    if (!unseen && skin.material.alpha == Material::Alpha::blend) {
        thing.opacity = skin.material.opacity;
        thing.features |= eye_feature::blend;
    }
    if (!surfaces.skinSource().closed()) thing.features |= eye_feature::twoSided;
    return thing;
}

// Nearest first.
std::vector<EyePass::Data::Thing> EyePass::Data::itemThings(const ShowFrame& frame, const glm::vec3& eye) const {
    std::vector<Thing> things;
    for (const auto& item : surfaces.items()) {
        if (item.surface >= frame.posed.surfaces.size()) continue;
        const PosedSurface& surface = frame.posed.surfaces[item.surface];
        Thing thing{item.mesh,
                    surface.worldFromSurface,
                    &surface.material,
                    surface.opacity,
                    materials.features(surface.material) | eye_feature::twoSided,
                    glm::distance(item.box.centre(), eye)};
        if (surface.opacity < 1.0F || surface.material.alpha == Material::Alpha::blend)
            thing.features |= eye_feature::blend;
        things.push_back(thing);
    }
    std::sort(things.begin(), things.end(), [](const Thing& a, const Thing& b) { return a.distance < b.distance; });
    return things;
}

} // namespace lumorph
