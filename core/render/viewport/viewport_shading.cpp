#include "core/render/viewport/viewport_shading.h"

#include <glm/mat3x3.hpp>

#include "core/base/srgb.h"
#include "core/render/gl/draw_state.h"
#include "core/render/viewport/paper_fibre.h"
#include "core/render/viewport/viewport_ground.h"

namespace lumorph {
namespace {

constexpr int kTintUnit = 2;
constexpr int kFibreUnit = 3;
constexpr int kFibreSide = 512;
constexpr float kFibreTile = 0.06F; // metres of paper that the picture covers

std::array<Program, 2> movingPrograms() {
    const std::vector<std::string> vertex{"version.glsl", "light_colors.glsl", "moving_tone.glsl",
                                          "moving_surface.vert"};
    return {Program(shaderFiles(vertex, {"moving_surface.frag"})),
            Program(shaderFiles(vertex, {"version.glsl", "moving_tone.glsl", "moving_tinted.frag"}))};
}

std::array<Program, 2> stillPrograms() {
    const std::vector<std::string> vertex{"viewport_surface.vert"};
    std::vector<std::string> light{"version.glsl",      "noise.glsl",        "backdrop.glsl",
                                   "studio_light.glsl", "light_colors.glsl", "tone.glsl"};
    std::vector<std::string> tinted = light;
    light.emplace_back("viewport_surface.frag");
    tinted.insert(tinted.end(), {"tint.glsl", "viewport_surface.frag"});
    return {Program(shaderFiles(vertex, light)), Program(shaderFiles(vertex, tinted))};
}

} // namespace

ViewportShading::ViewportShading()
    : moving_(movingPrograms()), still_(stillPrograms()), depth_(shaderFiles({"depth.vert"}, {"depth.frag"})) {
    const std::vector<std::uint8_t> grey = paperFibre(kFibreSide);
    glBindTexture(GL_TEXTURE_2D, fibre_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kFibreSide, kFibreSide, 0, GL_RED, GL_UNSIGNED_BYTE, grey.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void ViewportShading::update(const ViewportScene& scene, ViewportQuality quality) {
    using Detail = SurfaceShading::Detail;
    surfaces_.update(scene.surfaces, quality == ViewportQuality::moving ? Detail::coarse : Detail::fine);
    tint_.update(scene.tint);
}

Program& ViewportShading::begin(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light,
                                bool tinted) {
    Program& program = (frame.quality == ViewportQuality::still ? still_ : moving_)[tinted ? 1 : 0];
    program.use();
    applyBackdrop(program, frame, piece);
    light.apply(program, frame);
    glActiveTexture(GL_TEXTURE0 + kFibreUnit);
    glBindTexture(GL_TEXTURE_2D, fibre_.name());
    program.set("fibre", kFibreUnit);
    program.set("fibreTile", kFibreTile);
    program.set("clipFromWorld", frame.clipFromWorld);
    program.set("eye", frame.eye);
    program.set("exposure", frame.palette.exposure);
    return program;
}

void ViewportShading::draw(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light,
                           std::size_t surface) {
    const ViewportSurface& item = frame.scene.surfaces[surface];
    const bool opaque = item.opacity >= 1.0F;
    const bool tinted = item.tinted && tint_.there();
    Program& program = begin(frame, piece, light, tinted);
    if (tinted) tint_.apply(program, frame, item.tintedBy, kTintUnit);
    program.set("worldFromMesh", item.worldFromSurface);
    program.set("normalFromMesh", glm::mat4(glm::transpose(glm::inverse(glm::mat3(item.worldFromSurface)))));
    program.set("baseColor", linearFromSrgb(item.color));
    program.set("opacity", item.opacity);
    program.set("rim", opaque ? 0.0F : 1.0F);
    program.set("paper", item.paper);
    program.set("twoSided", opaque && surfaces_.closed(surface) ? 0.0F : 1.0F);
    // What is outlined marks its pixels by an alpha of 0.
    program.set("keepAlpha", item.outlined && opaque ? 0.0F : 1.0F);
    setFrontFace(item.worldFromSurface);
    if (opaque)
        drawOpaque(surface);
    else
        drawTranslucent(frame, program, surface);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

void ViewportShading::drawOpaque(std::size_t surface) const {
    if (surfaces_.closed(surface)) glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    surfaces_.draw(surface);
}

// Pulled a little towards the eye, so that where it lies on an opaque surface it tints that evenly.
void ViewportShading::drawTranslucent(const ViewportFrame& frame, Program& program, std::size_t surface) {
    const ViewportSurface& item = frame.scene.surfaces[surface];
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, item.outlined ? GL_ZERO : GL_ONE);
    glEnable(GL_CULL_FACE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -2.0F);
    glDepthMask(GL_FALSE);
    glCullFace(GL_FRONT);
    surfaces_.draw(surface);
    // Only the nearest front face: its depth first, a trace further away, then its colour.
    glCullFace(GL_BACK);
    glDepthMask(GL_TRUE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glPolygonOffset(-1.0F, -1.0F);
    depth_.use();
    depth_.set("worldFromMesh", item.worldFromSurface);
    depth_.set("clipFromWorld", frame.clipFromWorld);
    surfaces_.draw(surface);
    glPolygonOffset(-1.0F, -2.0F);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    program.use();
    surfaces_.draw(surface);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void ViewportShading::drawCasters(Program& depth, const ViewportFrame& frame) const {
    const std::vector<ViewportSurface>& surfaces = frame.scene.surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!surfaces_.drawable(i) || surfaces[i].opacity < 1.0F) continue;
        depth.set("worldFromMesh", surfaces[i].worldFromSurface);
        surfaces_.draw(i);
    }
}

std::size_t ViewportShading::objectCount() const noexcept {
    std::size_t count = 1 + surfaces_.objectCount() + tint_.objectCount() + depth_.objectCount();
    for (const Program& program : moving_) count += program.objectCount();
    for (const Program& program : still_) count += program.objectCount();
    return count;
}

} // namespace lumorph
