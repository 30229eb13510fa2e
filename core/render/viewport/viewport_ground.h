#pragma once

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"
#include "core/render/viewport/viewport_light.h"

namespace lumorph {

/// The ground of a viewport: a square around the pivot, as wide as anything is seen on it.
struct ViewportGroundPlace {
    glm::vec2 centre{0.0F}; ///< x and z, metres
    float extent = 1.0F;    ///< half its side, metres
    float gridReach = 1.0F; ///< radius at which the grid has faded, metres
};
[[nodiscard]] ViewportGroundPlace groundPlace(const ViewCamera& camera, const Box& bounds);

/// Draws the backdrop and the ground with its shadows and its grid. From above the ground hides what lies below it;
/// from below only its grid shows.
class ViewportGround {
public:
    /// Behind what is drawn already, with soft shadows.
    void draw(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light);

    /// The same in two steps: all that does not depend on the scene's surfaces, without depth ...
    void drawBackground(const ViewportFrame& frame);
    /// ... its depth where something lies below, and the key shadow on it. Surfaces are drawn between the two.
    void drawDepth(const ViewportFrame& frame);
    void drawShadow(const ViewportFrame& frame, const ViewportLight& light);

    [[nodiscard]] std::size_t objectCount() const noexcept {
        return 1 + backdrop_.objectCount() + open_.objectCount() + shadow_.objectCount() + still_.objectCount();
    }

private:
    void drawBackdrop(const ViewportFrame& frame, const FramePiece& piece);
    void drawPlane(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight* light);

    Program backdrop_{
        shaderFiles({"full_frame.vert"}, {"version.glsl", "noise.glsl", "backdrop.glsl", "backdrop.frag"})};
    Program open_{shaderFiles(
        {"ground.vert"}, {"version.glsl", "noise.glsl", "backdrop.glsl", "open_light.glsl", "viewport_ground.frag"})};
    Program still_{shaderFiles(
        {"ground.vert"}, {"version.glsl", "noise.glsl", "backdrop.glsl", "studio_light.glsl", "viewport_ground.frag"})};
    Program shadow_{shaderFiles({"ground.vert"}, {"version.glsl", "moving_light.glsl", "ground_shadow.frag"})};
    gl::VertexArray empty_;
};

/// Sets what backdrop.glsl needs.
void applyBackdrop(Program& program, const ViewportFrame& frame, const FramePiece& piece);

} // namespace lumorph
