#pragma once

#include "core/render/gl_objects.h"
#include "core/render/program.h"
#include "core/render/viewport_frame.h"
#include "core/render/viewport_light.h"

namespace lumorph {

/// The ground of a viewport: a square around the pivot, as wide as anything is seen on it.
struct ViewportGroundPlace {
    glm::vec2 centre{0.0F}; ///< x and z, metres
    float extent = 1.0F;    ///< half its side, metres
    float gridReach = 1.0F; ///< radius at which the grid has faded, metres
};
[[nodiscard]] ViewportGroundPlace groundPlace(const ViewCamera& camera, const Box& bounds);

/// Draws the backdrop and the ground with its shadows and its grid.
class ViewportGround {
public:
    /// Behind what is drawn already. From above the ground hides what lies below it; from below only its grid shows.
    void draw(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light);

    [[nodiscard]] std::size_t objectCount() const noexcept {
        return 1 + backdrop_.objectCount() + moving_.objectCount() + still_.objectCount();
    }

private:
    void drawBackdrop(const ViewportFrame& frame, const FramePiece& piece);
    void drawPlane(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light, bool below);

    Program backdrop_{shaderFiles({"full_frame.vert"}, {"version.glsl", "backdrop.glsl", "backdrop.frag"})};
    Program moving_{
        shaderFiles({"ground.vert"}, {"version.glsl", "backdrop.glsl", "moving_light.glsl", "viewport_ground.frag"})};
    Program still_{
        shaderFiles({"ground.vert"}, {"version.glsl", "backdrop.glsl", "studio_light.glsl", "viewport_ground.frag"})};
    gl::VertexArray empty_;
};

/// Sets what backdrop.glsl needs.
void applyBackdrop(Program& program, const ViewportFrame& frame, const FramePiece& piece);

} // namespace lumorph
