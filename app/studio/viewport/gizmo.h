#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/mdf/placement.h"
#include "core/render/viewport/view_camera.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

enum class GizmoHandle { moveX, moveY, moveZ, moveGround, turn, size };

/// The handles of a placed object: arrows and a ground square to move it, a ring to turn it about +Y, a cube to scale
/// it. Of constant size on the screen. Pure functions of camera and placement; no window, no GL. An arrow that points
/// at the camera is neither drawn nor grabbed.
struct Gizmo {
    Placement placement;
    glm::vec3 centre{0.0F};      ///< where the handles meet: the middle of the placed object's foot, device metres
    std::uint8_t handles = 0x3F; ///< that there are, one a bit, in the order of GizmoHandle

    bool operator==(const Gizmo&) const = default;
};

/// Whether there is this handle.
[[nodiscard]] constexpr bool offers(const Gizmo& gizmo, GizmoHandle handle) {
    return (gizmo.handles >> static_cast<unsigned>(handle) & 1U) != 0;
}

/// Length of the arrows in pixels at 100 %.
inline constexpr double kGizmoReach = 90.0;

/// `scale` is that of `size`: 1 for the pixels of the desktop, the desktop scale for those of the framebuffer. `accent`
/// is the sRGB colour of the handle under the pointer.
[[nodiscard]] std::vector<ViewportLine> gizmoLines(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 size,
                                                   double scale, std::optional<GizmoHandle> hot,
                                                   const glm::vec3& accent = {0.16F, 0.72F, 0.80F});
/// The handle within some pixels of the pointer.
[[nodiscard]] std::optional<GizmoHandle> gizmoAt(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 pixel,
                                                 glm::vec2 size, double scale);

/// The place along an axis (of length 1) whose picture is nearest to a pixel, metres from `origin`; 0 where the axis
/// points at the camera or `origin` lies behind it.
[[nodiscard]] double placeAlongAxis(const glm::vec3& origin, const glm::vec3& axis, const ViewCamera& camera,
                                    glm::vec2 pixel, glm::vec2 size);

/// The steps of a coarse drag.
inline constexpr double kCoarseMove = 0.005; ///< metres
inline constexpr double kCoarseTurn = std::numbers::pi / 12.0;
inline constexpr double kCoarseShare = 0.1;

/// Where a drag has come to, and what to write beside the pointer ("x 2.4 cm", "35 deg", "120 %": all measured from
/// where the drag began). `coarse` snaps to 5 mm, 15 degrees and 10 %.
struct GizmoDrag {
    Placement placement;
    std::string label;
    glm::vec3 centre{0.0F}; ///< of the gizmo, moved along
};
/// Turning and scaling keep the gizmo's centre where it is. A drag that means nothing in this view (along an arrow that
/// points at the camera) changes nothing.
[[nodiscard]] GizmoDrag dragGizmo(const Gizmo& start, GizmoHandle handle, const ViewCamera& camera, glm::vec2 from,
                                  glm::vec2 to, glm::vec2 size, bool coarse);

} // namespace lumorph::studio
