#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "core/render/viewport/studio_look.h"
#include "core/render/viewport/viewport_renderer.h"

/// One frame of a viewport, as the parts of the renderer see it. Private to core/render.
namespace lumorph {

struct ViewportFrame {
    const ViewportScene& scene;
    const ViewCamera& camera;
    glm::ivec2 size; ///< pixels
    float scale;     ///< of the desktop
    ViewportQuality quality;
    StudioPalette palette;
    Box bounds; ///< the scene's, or a small one when it has none
    glm::mat4 clipFromWorld;
    glm::vec4 eye; ///< world; w is 0 for the direction towards a parallel eye
};

/// Where in the frame a piece of it lies, pixels from the lower left corner.
struct FramePiece {
    glm::ivec2 origin{0};
    glm::ivec2 size{0};
};

} // namespace lumorph
