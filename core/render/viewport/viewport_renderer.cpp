#include "core/render/viewport/viewport_renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/render/gl/frame_target.h"
#include "core/render/viewport/viewport_frame.h"
#include "core/render/viewport/viewport_ground.h"
#include "core/render/viewport/viewport_lines.h"
#include "core/render/viewport/viewport_outline.h"
#include "core/render/viewport/viewport_shading.h"
#include "core/render/viewport/viewport_target.h"
#include "core/render/viewport/viewport_voxels.h"

namespace lumorph {
namespace {

constexpr double kPieceSeconds = 0.022; // of a still frame, about
constexpr int kFirstRows = 32;

Box boundsOf(const ViewportScene& scene) {
    if (glm::length(scene.bounds.size()) > 0.0F) return scene.bounds;
    const glm::vec3 centre(0.0F, scene.groundHeight, 0.0F);
    return {centre - 0.05F, centre + 0.05F};
}

ViewportFrame frameOf(const ViewportScene& scene, const ViewCamera& camera, glm::ivec2 size, ViewportQuality quality,
                      float scale) {
    const Box bounds = boundsOf(scene);
    const ViewportGroundPlace ground = groundPlace(camera, bounds);
    Box seen = bounds;
    const glm::vec3 middle(ground.centre.x, scene.groundHeight, ground.centre.y);
    const glm::vec3 reach(ground.extent, 0.0F, ground.extent);
    seen.include(Box{middle - reach, middle + reach});
    for (const ViewportLine& line : scene.lines) {
        seen.include(line.from);
        seen.include(line.to);
    }
    const glm::mat4 clip = clipFromWorld(camera, static_cast<float>(size.x) / static_cast<float>(size.y), seen);
    const glm::vec3 eye = eyeOf(camera);
    const glm::vec4 seenFrom =
        camera.orthographic ? glm::vec4(glm::normalize(eye - camera.pivot), 0.0F) : glm::vec4(eye, 1.0F);
    return {scene, camera, size, scale, quality, studioPalette(scene.theme), bounds, clip, seenFrom};
}

// What is on the way of a frame must not depend on what was drawn in this context before.
void resetState() {
    for (const GLenum off : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL,
                             GL_FRAMEBUFFER_SRGB, GL_PRIMITIVE_RESTART, GL_SAMPLE_ALPHA_TO_COVERAGE})
        glDisable(off);
    glEnable(GL_MULTISAMPLE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glDepthRange(0.0, 1.0);
    glClearDepth(1.0);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

// How far a box is from the eye.
float depthOf(const ViewportFrame& frame, const Box& box) {
    return frame.eye.w == 0.0F ? -glm::dot(glm::vec3(frame.eye), box.centre())
                               : glm::distance(glm::vec3(frame.eye), box.centre());
}

// The piece of the frame that a box may cover, with a margin of some pixels.
FramePiece covered(const ViewportFrame& frame, const Box& box, float margin) {
    glm::vec2 low(std::numeric_limits<float>::max());
    glm::vec2 high(std::numeric_limits<float>::lowest());
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner(i & 1U ? box.max.x : box.min.x, i & 2U ? box.max.y : box.min.y,
                               i & 4U ? box.max.z : box.min.z);
        const glm::vec4 clip = frame.clipFromWorld * glm::vec4(corner, 1.0F);
        if (clip.w <= 1e-6F) return {glm::ivec2(0), frame.size};
        const glm::vec2 pixel = (0.5F * glm::vec2(clip) / clip.w + 0.5F) * glm::vec2(frame.size);
        low = glm::min(low, pixel - margin);
        high = glm::max(high, pixel + margin);
    }
    const glm::vec2 size(frame.size);
    const glm::ivec2 origin(glm::floor(glm::clamp(low, glm::vec2(0.0F), size)));
    return {origin, glm::ivec2(glm::ceil(glm::clamp(high, glm::vec2(0.0F), size))) - origin};
}

bool meet(const FramePiece& a, const FramePiece& b) {
    return glm::all(glm::lessThan(a.origin, b.origin + b.size)) && glm::all(glm::lessThan(b.origin, a.origin + a.size));
}

} // namespace

struct ViewportRenderer::Data {
    ViewportTarget target;
    ViewportLight light;
    ViewportGround ground;
    ViewportShading shading;
    ViewportVoxelClouds voxels;
    ViewportLineSet lines;
    ViewportOutline outline;

    // What the background depends on.
    struct Background {
        ViewCamera camera;
        glm::ivec2 size{0};
        glm::vec3 low{0.0F}, high{0.0F};
        float groundHeight = 0.0F;
        bool grid = false;
        Theme theme = Theme::dark;
        bool operator==(const Background&) const = default;
    };
    Background background;

    // Something in the scene that is drawn on its own, by its place in its list.
    struct Thing {
        bool isSurface;
        std::size_t index;
        float depth;
    };

    [[nodiscard]] std::vector<Thing> things(const ViewportFrame& frame, const FramePiece& piece, bool opaque) const {
        std::vector<Thing> found;
        const auto& surfaces = frame.scene.surfaces;
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            if (!shading.surfaces().drawable(i) || (surfaces[i].opacity >= 1.0F) != opaque) continue;
            const Box& box = shading.surfaces().box(i);
            if (meet(covered(frame, box, 2.0F), piece)) found.push_back({true, i, depthOf(frame, box)});
        }
        for (std::size_t i = 0; i < frame.scene.voxels.size(); ++i)
            if ((frame.scene.voxels[i].opacity >= 1.0F) == opaque)
                found.push_back({false, i, depthOf(frame, frame.scene.voxels[i].frame.box())});
        std::stable_sort(found.begin(), found.end(), [&](const Thing& a, const Thing& b) {
            return opaque ? a.depth < b.depth : a.depth > b.depth;
        });
        return found;
    }

    void drawThing(const ViewportFrame& frame, const FramePiece& piece, const Thing& thing) {
        if (!thing.isSurface) {
            glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
            voxels.begin(frame);
            voxels.draw(frame, thing.index);
            return;
        }
        shading.draw(frame, piece, light, thing.index);
    }

    void drawPiece(const ViewportFrame& frame, const FramePiece& piece) {
        for (const Thing& thing : things(frame, piece, true)) drawThing(frame, piece, thing);
        if (frame.quality == ViewportQuality::still)
            ground.draw(frame, piece, light);
        else
            ground.drawShadow(frame, light);
        glEnable(GL_BLEND);
        for (const Thing& thing : things(frame, piece, false)) drawThing(frame, piece, thing);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        lines.draw(frame);
        glDisable(GL_BLEND);
    }

    bool updateLight(const ViewportFrame& frame, const std::function<bool()>& pieceDone) {
        ShadowCasters casters;
        casters.bounds = frame.bounds;
        for (std::size_t i = 0; i < frame.scene.surfaces.size(); ++i)
            if (shading.surfaces().drawable(i) && frame.scene.surfaces[i].opacity >= 1.0F)
                casters.casters.emplace_back(shading.surfaces().version(i), frame.scene.surfaces[i].worldFromSurface);
        return light.update(
            frame.quality, casters, [&](Program& depth) { shading.drawCasters(depth, frame); }, pieceDone);
    }

    // The background of a camera at rest is drawn once.
    void drawBackground(const ViewportFrame& frame) {
        target.beginBackground();
        const Background wanted{
            frame.camera,     frame.size,       frame.bounds.min, frame.bounds.max, frame.scene.groundHeight,
            frame.scene.grid, frame.scene.theme};
        if (background != wanted) ground.drawBackground(frame);
        background = wanted;
    }

    void drawWhole(const ViewportFrame& frame) {
        drawBackground(frame);
        target.beginWhole();
        ground.drawDepth(frame);
        drawPiece(frame, {glm::ivec2(0), frame.size});
    }

    bool drawInPieces(const ViewportFrame& frame, const std::function<bool()>& pieceDone) {
        int rows = kFirstRows;
        for (int x = 0; x < frame.size.x; x += ViewportTarget::kPiece.x) {
            const int width = std::min(ViewportTarget::kPiece.x, frame.size.x - x);
            for (int y = 0; y < frame.size.y;) {
                const FramePiece piece{{x, y}, {width, std::min(rows, frame.size.y - y)}};
                const auto start = std::chrono::steady_clock::now();
                target.beginPiece(piece);
                drawPiece(frame, piece);
                target.endPiece(piece);
                if (!pieceDone()) return false;
                const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
                const double wanted = rows * kPieceSeconds / std::max(took.count(), 1e-4);
                rows = std::clamp(static_cast<int>(wanted), rows / 2, 2 * rows);
                rows = std::clamp(rows, 4, ViewportTarget::kPiece.y);
                y += piece.size.y;
            }
        }
        return true;
    }

    // What is outlined, if anything.
    [[nodiscard]] Box outlinedBox(const ViewportScene& scene) const {
        Box box;
        for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
            if (scene.surfaces[i].outlined && shading.surfaces().drawable(i)) box.include(shading.surfaces().box(i));
        return box;
    }

    void finish(const ViewportFrame& frame, unsigned framebuffer) {
        target.copyTo(framebuffer);
        const Box box = outlinedBox(frame.scene);
        if (box.empty()) return;
        outline.draw(target.picture(), covered(frame, box, 4.0F * frame.scale), frame);
    }
};

ViewportRenderer::ViewportRenderer() : data_(std::make_unique<Data>()) {}
ViewportRenderer::~ViewportRenderer() = default;
ViewportRenderer::ViewportRenderer(ViewportRenderer&&) noexcept = default;
ViewportRenderer& ViewportRenderer::operator=(ViewportRenderer&&) noexcept = default;

bool ViewportRenderer::draw(unsigned framebuffer, glm::ivec2 size, const ViewportScene& scene, const ViewCamera& camera,
                            ViewportQuality quality, float scale, const std::function<bool()>& interrupted) {
    if (size.x < 1 || size.y < 1) return true;
    const ViewportFrame frame = frameOf(scene, camera, size, quality, scale);
    const bool still = quality == ViewportQuality::still;
    const auto pieceDone = [&] {
        if (!still) return true;
        glFinish();
        return !interrupted || !interrupted();
    };
    resetState();
    data_->shading.update(scene, quality);
    data_->voxels.update(scene.voxels);
    data_->lines.update(scene.lines, scale);
    if (data_->target.resize(size)) data_->background = {};
    bool whole = data_->updateLight(frame, pieceDone);
    if (whole && still) whole = data_->drawInPieces(frame, pieceDone);
    if (whole && !still) data_->drawWhole(frame);
    if (whole) data_->finish(frame, framebuffer);
    resetState();
    glDisable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE0);
    glUseProgram(0);
    return whole;
}

std::size_t ViewportRenderer::objectCount() const noexcept {
    return data_->target.objectCount() + data_->light.objectCount() + data_->ground.objectCount() +
           data_->shading.objectCount() + data_->voxels.objectCount() + data_->lines.objectCount() +
           data_->outline.objectCount();
}

Image renderViewport(ViewportRenderer& renderer, const ViewportScene& scene, const ViewCamera& camera,
                     glm::ivec2 size) {
    const FrameTarget target(size, 0);
    const float scale = std::max(1.0F, static_cast<float>(size.y) / 1200.0F);
    (void)renderer.draw(target.framebuffer(), size, scene, camera, ViewportQuality::still, scale);
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR)
        throw DeviceError("OpenGL",
                          error == GL_OUT_OF_MEMORY
                              ? "the driver has no memory for this picture"
                              : "the driver refused to draw (error " + std::to_string(error) + ")",
                          "use a smaller size, or update the graphics driver");
    return target.read();
}

} // namespace lumorph
