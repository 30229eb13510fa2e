#include "core/render/viewport/viewport_ground.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr double kLeastSpacing = 9.0; // pixels between two lines of the grid at the pivot

std::string gridLabel(int power) {
    if (power >= 0) return std::to_string(std::lround(std::pow(10.0, power))) + " m";
    if (power >= -2) return power == -1 ? "10 cm" : "1 cm";
    if (power == -3) return "1 mm";
    return std::to_string(std::lround(std::pow(10.0, power + 6))) + " µm";
}

// Of what stands on the ground, seen from above.
float radiusOf(const Box& bounds) {
    const float across = 0.5F * glm::length(glm::vec2(bounds.size().x, bounds.size().z));
    return std::max(across, 0.25F * bounds.size().y);
}

bool below(const ViewportFrame& frame) { return frame.eye.y < frame.eye.w * frame.scene.groundHeight; }

// Where the bounds may throw a shadow on the ground.
Box shadowReach(const ViewportFrame& frame) {
    const glm::vec3 light = keyLightDirection();
    Box reach;
    for (const float top : {frame.bounds.min.y, frame.bounds.max.y}) {
        const glm::vec3 shift = (frame.scene.groundHeight - top) / light.y * light;
        for (const glm::vec3& corner : {frame.bounds.min, frame.bounds.max})
            reach.include(glm::vec3(corner.x, top, corner.z) + shift);
    }
    const glm::vec3 margin = 0.02F * reach.size();
    return {reach.min - margin, reach.max + margin};
}

} // namespace

ViewportGrid gridOf(const ViewCamera& camera, glm::vec2 size) {
    const double spacing = kLeastSpacing * static_cast<double>(metresPerPixel(camera, camera.pivot, size));
    const int power = std::clamp(static_cast<int>(std::ceil(std::log10(spacing) - 1e-9)), -6, 3);
    return {static_cast<float>(std::pow(10.0, power)), gridLabel(power)};
}

ViewportGroundPlace groundPlace(const ViewCamera& camera, const Box& bounds) {
    const auto seen = static_cast<float>(camera.distance * std::tan(0.5 * camera.fieldOfView.inRadians()));
    const glm::vec2 pivot(camera.pivot.x, camera.pivot.z);
    const glm::vec2 scene(bounds.centre().x, bounds.centre().z);
    ViewportGroundPlace place;
    place.centre = pivot;
    place.gridReach = 8.0F * seen;
    place.extent = std::max(place.gridReach, 10.0F * radiusOf(bounds) + glm::distance(pivot, scene));
    return place;
}

void applyBackdrop(Program& program, const ViewportFrame& frame, const FramePiece& piece) {
    program.set("frameSize", glm::vec2(frame.size));
    program.set("frameOrigin", glm::vec2(piece.origin));
    program.set("backdropTop", frame.palette.top);
    program.set("backdropBottom", frame.palette.bottom);
}

void ViewportGround::draw(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light) {
    if (!below(frame)) drawPlane(frame, piece, &light);
    drawBackdrop(frame, piece);
    if (below(frame) && frame.scene.grid) drawPlane(frame, piece, &light);
}

void ViewportGround::drawBackground(const ViewportFrame& frame) {
    const FramePiece whole{glm::ivec2(0), frame.size};
    glDisable(GL_DEPTH_TEST);
    drawBackdrop(frame, whole);
    if (!below(frame)) drawPlane(frame, whole, nullptr);
    glEnable(GL_DEPTH_TEST);
}

void ViewportGround::drawDepth(const ViewportFrame& frame) {
    const float slack = 1e-3F * glm::length(frame.bounds.size());
    if (below(frame) || frame.bounds.min.y > frame.scene.groundHeight - slack) return;
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    drawPlane(frame, {glm::ivec2(0), frame.size}, nullptr);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void ViewportGround::drawShadow(const ViewportFrame& frame, const ViewportLight& light) {
    const FramePiece whole{glm::ivec2(0), frame.size};
    if (below(frame)) {
        if (frame.scene.grid) drawPlane(frame, whole, nullptr);
        return;
    }
    const Box reach = shadowReach(frame);
    shadow_.use();
    light.apply(shadow_, frame);
    shadow_.set("clipFromWorld", frame.clipFromWorld);
    shadow_.set("groundHeight", frame.scene.groundHeight);
    shadow_.set("groundCentre", glm::vec2(reach.centre().x, reach.centre().z));
    shadow_.set("groundExtent", 0.5F * std::max(reach.size().x, reach.size().z));
    shadow_.set("shade", frame.palette.shade);
    glEnable(GL_BLEND);
    glBlendFunc(GL_DST_COLOR, GL_ZERO);
    glDepthMask(GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 2.0F);
    glBindVertexArray(empty_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void ViewportGround::drawBackdrop(const ViewportFrame& frame, const FramePiece& piece) {
    backdrop_.use();
    applyBackdrop(backdrop_, frame, piece);
    glDepthMask(GL_FALSE);
    glDepthRange(1.0, 1.0); // where nothing else is
    glBindVertexArray(empty_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
}

void ViewportGround::drawPlane(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight* light) {
    Program& program = light != nullptr ? still_ : open_;
    const ViewportGroundPlace place = groundPlace(frame.camera, frame.bounds);
    program.use();
    applyBackdrop(program, frame, piece);
    if (light != nullptr) light->apply(program, frame);
    program.set("clipFromWorld", frame.clipFromWorld);
    program.set("groundHeight", frame.scene.groundHeight);
    program.set("groundCentre", place.centre);
    program.set("groundExtent", place.extent);
    program.set("poolCentre", glm::vec2(frame.bounds.centre().x, frame.bounds.centre().z));
    program.set("poolRadius", radiusOf(frame.bounds));
    program.set("gridReach", place.gridReach);
    program.set("gridStep", gridOf(frame.camera, glm::vec2(frame.size)).step);
    program.set("gridStrength", frame.scene.grid ? frame.palette.lineStrength : 0.0F);
    program.set("lineColor", frame.palette.line);
    program.set("shade", frame.palette.shade);
    program.set("pool", frame.palette.pool);
    program.set("below", below(frame) ? 1.0F : 0.0F);
    // What stands on the ground lies in it with its lowest faces; they win.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 4.0F);
    if (below(frame)) {
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        glDepthMask(GL_FALSE);
    }
    glBindVertexArray(empty_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

} // namespace lumorph
