#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/mdf/placement.h"
#include "core/render/view_camera.h"
#include "core/render/viewport_scene.h"

namespace lumorph::studio {

enum class GizmoHandle { moveX, moveY, moveZ, moveGround, turn, size };

/// The handles of a placed object: arrows and a ground square to move it, a ring to turn it about +Y, a cube to scale
/// it. Of constant size on the screen. Pure functions of camera and placement; no window, no GL.
struct Gizmo {
    Placement placement;
    glm::vec3 centre{0.0F}; ///< where the handles meet: the middle of the placed object's foot, device metres
};
[[nodiscard]] std::vector<ViewportLine> gizmoLines(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 size,
                                                   double scale, std::optional<GizmoHandle> hot);
/// The handle within some pixels of the pointer.
[[nodiscard]] std::optional<GizmoHandle> gizmoAt(const Gizmo& gizmo, const ViewCamera& camera, glm::vec2 pixel,
                                                 glm::vec2 size, double scale);

/// Where a drag has come to, and what to write beside the pointer ("x 2.4 cm", "35 deg", "120 %"). `coarse` snaps to
/// 5 mm, 15 degrees and 10 %.
struct GizmoDrag {
    Placement placement;
    std::string label;
};
[[nodiscard]] GizmoDrag dragGizmo(const Gizmo& start, GizmoHandle handle, const ViewCamera& camera, glm::vec2 from,
                                  glm::vec2 to, glm::vec2 size, bool coarse);

} // namespace lumorph::studio
