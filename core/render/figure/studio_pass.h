#pragma once

#include <memory>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/figure/camera.h"
#include "core/render/figure/gpu_mesh.h"
#include "core/render/viewport/studio_look.h"

namespace lumorph {

/// What of the light is drawn; without shadows every surface is lit as if it stood alone.
struct Lighting {
    bool keyShadow = true;    ///< soft shadow of the key light
    bool skyOcclusion = true; ///< the sky does not reach into corners and under objects
};

/// A surface to draw: its mesh in world metres and its sRGB colour, 0 to 1.
struct StudioSurface {
    const GpuMesh* mesh = nullptr;
    glm::vec3 color{0.8F};
    float opacity = 1.0F;
    glm::vec3 centre{0.0F}; ///< its middle; orders translucent surfaces
};

/// The ground the surfaces stand on: a plane with a square grid, each fifth line stronger, and a bar
/// of some squares as its scale.
struct StudioGround {
    float height = 0.0F;      ///< world y, metres
    glm::vec2 centre{0.0F};   ///< x and z of what stands on it
    float radius = 0.1F;      ///< of what stands on it; the grid fades beyond
    float gridStep = 0.01F;   ///< metres
    glm::vec2 barStart{0.0F}; ///< x and z; the bar leads along +x
    int barSquares = 0;
};

/// One view: where in the frame, and how. `view` is what the camera frames, `region` the larger part
/// of the frame that the scene may fill around it; both in pixels from the top left corner.
struct StudioView {
    Camera camera;
    glm::ivec2 viewOrigin{0};
    glm::ivec2 viewSize{1};
    glm::ivec2 regionOrigin{0};
    glm::ivec2 regionSize{1};
    Box scene; ///< all surfaces lie in it
    StudioGround ground;
    Theme theme = Theme::dark;
    Lighting lighting;
};

/// Draws surfaces as in a photographer's studio: soft sky, key light with a soft shadow, a ground that
/// runs into the backdrop. Opaque surfaces first, then translucent ones from far to near, the back
/// faces of each before its front faces; they cast no shadow. Colours are written sRGB-encoded.
class StudioPass {
public:
    StudioPass();
    ~StudioPass();
    StudioPass(StudioPass&&) noexcept;
    StudioPass& operator=(StudioPass&&) noexcept;

    /// Fills the whole frame of `frameSize` and clears its depth.
    void drawBackdrop(GLuint framebuffer, glm::ivec2 frameSize, Theme theme);
    /// Draws one view over the backdrop.
    void draw(GLuint framebuffer, glm::ivec2 frameSize, const StudioView& view,
              std::span<const StudioSurface> surfaces);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
