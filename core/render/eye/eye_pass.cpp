#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "core/base/error.h"
#include "core/base/srgb.h"
#include "core/render/eye/eye_fog.h"
#include "core/render/eye/eye_lighting.h"
#include "core/render/eye/eye_materials.h"
#include "core/render/eye/eye_pass.h"
#include "core/render/eye/eye_programs.h"
#include "core/render/eye/eye_shadow.h"
#include "core/render/eye/eye_skin.h"
#include "core/render/eye/eye_surfaces.h"
#include "core/render/eye/lookup_region.h"
#include "core/render/eye/table_grid.h"
#include "core/render/eye/table_shadow.h"
#include "core/render/gl/camera_uniforms.h"
#include "core/render/gl/draw_state.h"

namespace lumorph {
namespace {

constexpr float kNearSideStepsBack = 0.012F; // metres; as much as depth changes over a tile of the map on a slant
constexpr float kBlurredLift = 0.004F;       // metres by which blurred folds keep off their own shadow

glm::vec3 backgroundOf(const Scene& scene) {
    return glm::clamp(0.5F * scene.sky * static_cast<float>(scene.exposure), 0.0F, 0.7F);
}

void requireSize(glm::ivec2 size) {
    if (size.x >= 1 && size.y >= 1) return;
    throw InvalidInput("picture size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                       "the eye pass draws at least one pixel", "use 1 pixel a side or more");
}

// Others find the state as they know it.
void finishDrawing() {
    glDisable(GL_SCISSOR_TEST);
    glActiveTexture(GL_TEXTURE0);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
    glUseProgram(0);
}

} // namespace

/// What the pass keeps, and its steps; `Thing` and `View` are those of one frame.
struct EyePass::Data {
    /// One thing to draw: a mesh, where it stands, and what it looks like.
    struct Thing {
        const EyeMesh* mesh = nullptr; ///< none: the table
        glm::mat4 world{1.0F};
        const Material* material = nullptr;
        float opacity = 1.0F;
        std::uint32_t features = 0;
        float distance = 0.0F;
        bool skin = false;
        std::uint64_t version = 0; ///< of its shape
        bool inTheOpen = false;    ///< no shadow reaches what is drawn of it
    };

    /// Where a frame is drawn to.
    struct View {
        const CalibratedCamera* camera = nullptr;
        DepthRange depth;
        PixelRegion region;                         ///< all that is drawn
        const UnseenPlaces* unseenPlaces = nullptr; ///< only these, as a projector sends them

        [[nodiscard]] bool unseen() const noexcept { return unseenPlaces != nullptr; }
        [[nodiscard]] std::uint32_t features() const noexcept;
        void apply(Program& program, PhysicalSurface surface) const;
    };

    EyePrograms programs;
    EyeMaterials materials;
    EyeSurfaces surfaces;
    EyeShadow shadow;
    EyeLighting lighting;
    EyeFog fog;
    TableGrid table;
    std::string shadowProblem; ///< of a driver that cannot compile what shadows need

    [[nodiscard]] bool showsSkin(const ShowFrame& frame) const;
    [[nodiscard]] std::vector<Thing> shadowThings(const ShowFrame& frame) const;
    void drawShadow(const ShowFrame& frame);
    void drawCaster(const ShowFrame& frame, const Thing& thing, const glm::mat4& clipFromWorld);
    [[nodiscard]] Thing skinThing(const ShowFrame& frame, bool unseen) const;
    [[nodiscard]] std::vector<Thing> itemThings(const ShowFrame& frame, const glm::vec3& eye) const;
    void begin(const ShowFrame& frame, const View& view, unsigned framebuffer) const;
    void draw(const ShowFrame& frame, const View& view, const Thing& thing);
    void draw(const ShowFrame& frame, const View& view, const Thing& thing, std::span<const PixelRectangle> parts);
    [[nodiscard]] PixelRectangle shadowedPixels(const ShowFrame& frame, const View& view) const;
    void drawTable(const ShowFrame& frame, const View& view);
    void drawCreases(const ShowFrame& frame, const View& view);
    void drawBlended(const ShowFrame& frame, const View& view, std::vector<Thing> things);
    void drawSeen(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer, bool withSkin);
    [[nodiscard]] Box everything(const ShowFrame& frame) const;
};

EyePass::EyePass() : data_(std::make_unique<Data>()) {}
EyePass::~EyePass() = default;
EyePass::EyePass(EyePass&&) noexcept = default;
EyePass& EyePass::operator=(EyePass&&) noexcept = default;

std::uint32_t EyePass::Data::View::features() const noexcept {
    return unseenPlaces != nullptr ? unseenPlaces->features : 0;
}

void EyePass::Data::View::apply(Program& program, PhysicalSurface surface) const {
    setCamera(program, *camera, depth.near, depth.far);
    if (unseenPlaces != nullptr) unseenPlaces->setOutput(program, surface, eye_unit::weights);
}

Box EyePass::Data::everything(const ShowFrame& frame) const {
    Box box;
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    box.include(glm::vec3(-half.x, 0.0F, -half.y));
    box.include(glm::vec3(half.x, 0.0F, half.y));
    if (surfaces.hasSkin()) box.include(movedBox(surfaces.skinBoxAtDevice(), frame.worldFromDevice));
    for (const auto& item : surfaces.items()) box.include(item.box);
    return box;
}

void EyePass::Data::begin(const ShowFrame& frame, const View& view, unsigned framebuffer) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, view.camera->size.x, view.camera->size.y);
    glEnable(GL_SCISSOR_TEST);
    scissor(view.region.bounds());
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    constexpr std::uint32_t kEncoding = eye_feature::gamma | eye_feature::response;
    const bool encodes = view.unseen() && (view.unseenPlaces->features & kEncoding) != 0;
    (encodes ? glDisable : glEnable)(GL_FRAMEBUFFER_SRGB);
    if (view.unseen()) return; // what stands stays
    glClearDepth(1.0);
    const glm::vec3 background = backgroundOf(*frame.scene);
    glClearColor(background.r, background.g, background.b, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void EyePass::Data::draw(const ShowFrame& frame, const View& view, const Thing& thing) {
    draw(frame, view, thing, std::array{view.region.bounds()});
}

void EyePass::Data::draw(const ShowFrame& frame, const View& view, const Thing& thing,
                         std::span<const PixelRectangle> parts) {
    if (parts.empty()) return;
    const bool lit = (thing.features & eye_feature::unlit) == 0;
    std::uint32_t features = thing.features | (lit ? lighting.features() : 0U);
    if (thing.inTheOpen) features &= ~std::uint32_t{eye_feature::shadow | eye_feature::lamp};
    if (!view.unseen()) features |= fog.features();
    Program& program = programs.use(EyePrograms::Stage::surface, features | view.features());
    view.apply(program, thing.mesh == nullptr ? PhysicalSurface::table : PhysicalSurface::device);
    program.set("eyePosition", glm::vec3(positionOf(*view.camera)));
    program.set("worldFromSurface", thing.world);
    program.set("normalFromSurface", glm::mat4(glm::inverseTranspose(glm::mat3(thing.world))));
    lighting.apply(program);
    if ((features & eye_feature::shadow) != 0) shadow.apply(program);
    if ((features & eye_feature::fog) != 0) fog.apply(program);
    const double blur = (features & eye_feature::skin) != 0 ? -frame.scene->device.creases.emphasis : 0.0;
    program.set("shadowLift", kBlurredLift * static_cast<float>(std::clamp(blur, 0.0, 1.0)));
    materials.apply(program, *thing.material, (features & eye_feature::blend) != 0 ? thing.opacity : 1.0F, features);
    if ((features & (eye_feature::reflection | eye_feature::refraction)) != 0) {
        materials.applyTable(program, frame.scene->table.material);
        program.set("tableLight", lighting.onTable(glm::vec3(frame.worldFromDevice[3])));
        program.set("tableHalf", 0.5F * frame.installation->tableSize);
        program.set("sky", frame.scene->sky);
    }
    if ((features & eye_feature::skin) != 0)
        applySkin(program, frame.scene->device, surfaces.skinBoxAtRest(), frame.worldFromDevice);
    if ((features & eye_feature::holesBelow) != 0)
        applyHolesAbove(program, frame.scene->device, surfaces.skinBoxAtRest(), frame.worldFromDevice);
    setFrontFace(thing.world);
    const bool cull = (features & eye_feature::twoSided) == 0;
    (cull ? glEnable : glDisable)(GL_CULL_FACE);
    glCullFace(GL_BACK);
    // Where an item lies in the device's own surface, the item is seen.
    (thing.skin ? glEnable : glDisable)(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 8.0F);
    for (const PixelRectangle& part : parts) {
        scissor(part);
        thing.mesh != nullptr ? thing.mesh->draw() : table.draw();
    }
    scissor(view.region.bounds());
    glDisable(GL_POLYGON_OFFSET_FILL);
}

// A rectangle of the image that holds all shadows on the table.
PixelRectangle EyePass::Data::shadowedPixels(const ShowFrame& frame, const View& view) const {
    if (!lighting.shadowed()) return {};
    const auto shadows = shadowsOnTable(frame, *lighting.shadowed());
    if (!shadows) return view.region.bounds();
    if (shadows->empty()) return {};
    return pixelsOf(*shadows, *view.camera);
}

void EyePass::Data::drawTable(const ShowFrame& frame, const View& view) {
    const Material& material = frame.scene->table.material;
    std::uint32_t features = materials.features(material, view.unseen()) | eye_feature::table | eye_feature::twoSided;
    // The projector pass shows such a table alike to every eye.
    if (!dependsOnEye(material)) features &= ~eye_feature::specular;
    const bool throughHoles = showsSkin(frame) && (skinThing(frame, view.unseen()).features & eye_feature::holes) != 0;
    if (throughHoles && lighting.shadowed() && (features & eye_feature::unlit) == 0)
        features |= eye_feature::holesBelow;
    table.fit(*view.camera, frame.installation->tableSize);
    glVertexAttrib3f(1, 0.0F, 1.0F, 0.0F); // its normal, everywhere
    Thing thing{nullptr, glm::mat4(1.0F), &material, 1.0F, features, 0.0F};
    // Through holes light is looked up elsewhere than on the table.
    if ((features & (eye_feature::holesBelow | eye_feature::unlit)) != 0)
        return draw(frame, view, thing, view.region.parts());
    // Looking for shadows is dear, and most of the table lies in the open.
    const PixelRectangle shadowed = shadowedPixels(frame, view);
    std::vector<PixelRectangle> dim, open;
    const auto add = [](std::vector<PixelRectangle>& parts, const PixelRectangle& part) {
        if (!part.empty()) parts.push_back(part);
    };
    for (const PixelRectangle& part : view.region.parts()) {
        add(dim, common(part, shadowed));
        for (const PixelRectangle& beside : around(shadowed, part)) add(open, beside);
    }
    draw(frame, view, thing, dim);
    thing.inTheOpen = true;
    draw(frame, view, thing, open);
}

// Ink upon the skin, a hair above it.
void EyePass::Data::drawCreases(const ShowFrame& frame, const View& view) {
    const EyeMesh* lines = surfaces.creases();
    if (lines == nullptr || !surfaces.hasSkin()) return;
    const std::uint32_t features = view.unseen() ? eye_feature::skin : skinFeatures(frame.scene->device);
    const DeviceSkin::Creases& creases = frame.scene->device.creases;
    Program& program = programs.use(EyePrograms::Stage::crease, features | view.features());
    view.apply(program, PhysicalSurface::device);
    program.set("worldFromSurface", frame.worldFromDevice);
    program.set("ink", glm::vec4(linearFromSrgb(creases.color), static_cast<float>(std::min(creases.emphasis, 1.0))));
    lighting.apply(program);
    applySkin(program, frame.scene->device, surfaces.skinBoxAtRest(), frame.worldFromDevice);
    setFrontFace(frame.worldFromDevice);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(0.5F, 4.0F); // between the items and the skin, which steps back more
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    lines->draw();
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

// Farthest first; each fills the depth before its colour, so that its own far side does not shine through it.
void EyePass::Data::drawBlended(const ShowFrame& frame, const View& view, std::vector<Thing> things) {
    std::sort(things.begin(), things.end(), [](const Thing& a, const Thing& b) { return a.distance > b.distance; });
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    for (const Thing& thing : things) {
        glDisable(GL_BLEND);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        draw(frame, view, thing);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glEnable(GL_BLEND);
        glDepthFunc(GL_LEQUAL);
        draw(frame, view, thing);
        glDepthFunc(GL_LESS);
    }
    glDisable(GL_BLEND);
}

void EyePass::prepare(const ShowFrame& frame) {
    data_->materials.begin(frame.assets, frame.posed.seconds);
    data_->surfaces.update(frame);
    data_->lighting = EyeLighting(*frame.scene, frame.posed.lights);
    data_->lighting.setBounce(data_->lighting.onTable(glm::vec3(frame.worldFromDevice[3])) *
                              data_->materials.meanColor(frame.scene->table.material));
    data_->fog.update(frame.posed.fogs, data_->lighting.onTable(glm::vec3(frame.worldFromDevice[3])));
    data_->drawShadow(frame);
}

void EyePass::Data::drawSeen(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer,
                             bool withSkin) {
    requireSize(camera.size);
    const glm::vec3 eye(positionOf(camera));
    const View view{&camera, depthRange(camera, everything(frame)), PixelRegion({glm::ivec2(0), camera.size})};
    begin(frame, view, framebuffer);
    std::vector<Thing> things = itemThings(frame, eye);
    if (withSkin) {
        things.push_back(skinThing(frame, false));
        things.back().distance = glm::distance(glm::vec3(frame.worldFromDevice[3]), eye);
    }
    const auto opaqueEnd = std::stable_partition(
        things.begin(), things.end(), [](const Thing& thing) { return (thing.features & eye_feature::blend) == 0; });
    for (auto thing = things.begin(); thing != opaqueEnd; ++thing) draw(frame, view, *thing);
    drawTable(frame, view);
    if (withSkin) drawCreases(frame, view);
    drawBlended(frame, view, {opaqueEnd, things.end()});
    finishDrawing();
}

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

void EyePass::draw(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer) {
    data_->drawSeen(frame, camera, framebuffer, data_->showsSkin(frame));
}

void EyePass::drawBesideDevice(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer) {
    data_->drawSeen(frame, camera, framebuffer, false);
}

void EyePass::drawUnseen(const ShowFrame& frame, const UnseenPlaces& places) {
    const Data::View view{&places.camera, depthRange(places.camera, data_->everything(frame)), places.region, &places};
    data_->begin(frame, view, places.framebuffer);
    // What reaches beyond the device is nowhere cleared.
    if (data_->surfaces.hasSkin()) data_->draw(frame, view, data_->skinThing(frame, true), std::array{places.device});
    data_->drawTable(frame, view);
    scissor(places.device);
    data_->drawCreases(frame, view);
    finishDrawing();
}

std::vector<std::string> EyePass::warnings() const {
    std::vector<std::string> warnings = data_->programs.warnings();
    if (!data_->shadowProblem.empty()) warnings.push_back(data_->shadowProblem);
    return warnings;
}

std::size_t EyePass::objectCount() const noexcept {
    return data_->programs.objectCount() + data_->materials.objectCount() + data_->surfaces.objectCount() +
           data_->shadow.objectCount() + data_->fog.objectCount() + TableGrid::kObjects;
}

} // namespace lumorph
