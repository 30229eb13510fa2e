#include "core/render/viewport_ground.h"

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
    const float above = frame.eye.y - frame.eye.w * frame.scene.groundHeight;
    glBindVertexArray(empty_.name());
    if (above >= 0.0F) drawPlane(frame, piece, light, false);
    drawBackdrop(frame, piece);
    if (above < 0.0F && frame.scene.grid) drawPlane(frame, piece, light, true);
    glBindVertexArray(0);
}

void ViewportGround::drawBackdrop(const ViewportFrame& frame, const FramePiece& piece) {
    backdrop_.use();
    applyBackdrop(backdrop_, frame, piece);
    glDepthMask(GL_FALSE);
    glDepthRange(1.0, 1.0); // where nothing else is
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
}

void ViewportGround::drawPlane(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light,
                               bool below) {
    Program& program = frame.quality == ViewportQuality::still ? still_ : moving_;
    const ViewportGroundPlace place = groundPlace(frame.camera, frame.bounds);
    program.use();
    applyBackdrop(program, frame, piece);
    light.apply(program, frame);
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
    program.set("below", below ? 1.0F : 0.0F);
    // What stands on the ground lies in it with its lowest faces; they win.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 4.0F);
    if (below) {
        glEnable(GL_BLEND);
        glDepthMask(GL_FALSE);
    }
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

} // namespace lumorph
