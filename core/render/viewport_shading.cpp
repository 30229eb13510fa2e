#include "core/render/viewport_shading.h"

#include <glm/mat3x3.hpp>

#include "core/render/paper_fibre.h"
#include "core/render/viewport_ground.h"

namespace lumorph {
namespace {

constexpr int kTintUnit = 2;
constexpr int kFibreUnit = 3;
constexpr int kFibreSide = 512;
constexpr float kFibreTile = 0.06F; // metres of paper that the picture covers

Program surfaceProgram(const char* light) {
    return Program(shaderFiles({"viewport_surface.vert"}, {"version.glsl", "backdrop.glsl", light, "tone.glsl",
                                                           "tint.glsl", "viewport_surface.frag"}));
}

void setFrontFace(const glm::mat4& world) { glFrontFace(glm::determinant(glm::mat3(world)) < 0.0F ? GL_CW : GL_CCW); }

} // namespace

ViewportShading::ViewportShading()
    : moving_(surfaceProgram("moving_light.glsl")), still_(surfaceProgram("studio_light.glsl")) {
    const std::vector<std::uint8_t> grey = paperFibre(kFibreSide);
    glBindTexture(GL_TEXTURE_2D, fibre_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kFibreSide, kFibreSide, 0, GL_RED, GL_UNSIGNED_BYTE, grey.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void ViewportShading::update(const ViewportScene& scene) {
    surfaces_.update(scene.surfaces);
    tint_.update(scene.tint);
}

void ViewportShading::begin(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light) {
    current_ = frame.quality == ViewportQuality::still ? &still_ : &moving_;
    current_->use();
    applyBackdrop(*current_, frame, piece);
    light.apply(*current_, frame);
    tint_.apply(*current_, frame, kTintUnit);
    glActiveTexture(GL_TEXTURE0 + kFibreUnit);
    glBindTexture(GL_TEXTURE_2D, fibre_.name());
    current_->set("fibre", kFibreUnit);
    current_->set("fibreTile", kFibreTile);
    current_->set("clipFromWorld", frame.clipFromWorld);
    current_->set("eye", frame.eye);
    current_->set("exposure", frame.palette.exposure);
}

void ViewportShading::setMaterial(const ViewportFrame& frame, std::size_t surface) {
    const ViewportSurface& item = frame.scene.surfaces[surface];
    current_->set("worldFromMesh", item.worldFromSurface);
    current_->set("normalFromMesh", glm::mat4(glm::transpose(glm::inverse(glm::mat3(item.worldFromSurface)))));
    current_->set("baseColor", linearFromSrgb(item.color));
    current_->set("opacity", item.opacity);
    current_->set("rim", item.opacity < 1.0F ? 1.0F : 0.0F);
    current_->set("paper", item.paper);
    current_->set("keepAlpha", item.outlined && item.opacity >= 1.0F ? 0.0F : 1.0F);
    tint_.setTinted(*current_, frame, item.tinted);
    setFrontFace(item.worldFromSurface);
}

void ViewportShading::drawOpaque(const ViewportFrame& frame, std::size_t surface) {
    setMaterial(frame, surface);
    if (surfaces_.closed(surface)) glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    surfaces_.draw(surface);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

// Pulled a little towards the eye, so that where it lies on an opaque surface it tints that evenly.
void ViewportShading::drawTranslucent(const ViewportFrame& frame, std::size_t surface) {
    setMaterial(frame, surface);
    // What is outlined marks its pixels by an alpha of 0.
    const bool outlined = frame.scene.surfaces[surface].outlined;
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, outlined ? GL_ZERO : GL_ONE);
    glEnable(GL_CULL_FACE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -2.0F);
    glDepthMask(GL_FALSE);
    glCullFace(GL_FRONT);
    surfaces_.draw(surface);
    // Only the nearest front face: its depth first, then its colour.
    glCullFace(GL_BACK);
    glDepthMask(GL_TRUE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    surfaces_.draw(surface);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    surfaces_.draw(surface);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

void ViewportShading::drawCasters(Program& depth, const ViewportScene& scene) const {
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        if (!surfaces_.drawable(i) || scene.surfaces[i].opacity < 1.0F) continue;
        depth.set("worldFromMesh", scene.surfaces[i].worldFromSurface);
        setFrontFace(scene.surfaces[i].worldFromSurface);
        if (surfaces_.closed(i)) glEnable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        surfaces_.draw(i);
        glDisable(GL_CULL_FACE);
    }
    glFrontFace(GL_CCW);
}

std::size_t ViewportShading::objectCount() const noexcept {
    return 1 + surfaces_.objectCount() + tint_.objectCount() + moving_.objectCount() + still_.objectCount();
}

} // namespace lumorph
