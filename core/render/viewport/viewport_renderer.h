#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/render/viewport/view_camera.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph {

/// How much work a frame is worth. `moving`: one shadow map, a small soft edge, edges smoothed cheaply;
/// fit for 30 frames a second in software GL. `still`: several samples a pixel, soft shadows, sky light.
enum class ViewportQuality { moving, still };

/// What the pointer is on.
struct ViewportHit {
    std::uint32_t id = 0;            ///< of the surface or the voxels
    glm::vec3 point{0.0F};           ///< world metres
    float distance = 0.0F;           ///< from the ray's origin, metres
    std::optional<glm::ivec3> voxel; ///< where voxels were hit
    /// Where a surface was hit: the vertices of its mesh around the place, and the share of each in it.
    struct Corners {
        glm::uvec3 vertices{0};
        glm::vec3 shares{0.0F};
    };
    std::optional<Corners> corners;
};

/// The nearest thing in the scene that a ray meets; no GL. Costs one pass over the triangles.
[[nodiscard]] std::optional<ViewportHit> pick(const ViewportScene& scene, const Ray& ray);

/// The grid of a viewport seen from this far: side of a square in metres (1 mm, 1 cm, 10 cm, 1 m, ...), of which every
/// tenth line is stronger, and its label, such as "1 cm".
struct ViewportGrid {
    float step = 0.01F;
    std::string label;
};
[[nodiscard]] ViewportGrid gridOf(const ViewCamera& camera, glm::vec2 size);

/// Draws viewports in the current OpenGL context; keeps programs and buffers between frames. Everything it holds dies
/// with it, while the same context is current.
class ViewportRenderer {
public:
    ViewportRenderer();
    ~ViewportRenderer();
    ViewportRenderer(ViewportRenderer&&) noexcept;
    ViewportRenderer& operator=(ViewportRenderer&&) noexcept;

    /// Draws the scene into the whole of `framebuffer` of `size` pixels, sRGB-encoded. `scale` is the desktop scale:
    /// lines get wider with it. A still frame is drawn in pieces, and between two of them `interrupted` is asked: true
    /// gives the frame up (false is returned, the framebuffer holds rubbish). Software GL shares its threads between
    /// contexts, so a piece must stay short.
    bool draw(unsigned framebuffer, glm::ivec2 size, const ViewportScene& scene, const ViewCamera& camera,
              ViewportQuality quality, float scale = 1.0F, const std::function<bool()>& interrupted = {});

    /// OpenGL objects held now, for tests of leaks.
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// One still picture of a scene in the current context, for export: any size up to kMaxImageSide. Throws InvalidInput
/// for a size the driver cannot hold, DeviceError when it has no memory.
[[nodiscard]] Image renderViewport(ViewportRenderer& renderer, const ViewportScene& scene, const ViewCamera& camera,
                                   glm::ivec2 size);

} // namespace lumorph
