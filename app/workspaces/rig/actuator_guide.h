#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/workspaces/rig/rig_facts.h"
#include "core/render/viewport/view_camera.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// Pixels from the way's end to what turns it.
inline constexpr float kDirectionAhead = 44.0F;

/// What of an actuator can be taken hold of in the view, in device metres: the line it turns about or bends at, and its
/// range as an arc or a way. Where it is while all others are at rest. Pure geometry; no window, no document.
struct ActuatorGuide {
    ActuatorRange range;
    double rest = 0.0;                ///< the value of the range at which its part stands as it was drawn
    glm::vec3 pivot{0.0F};            ///< the middle of the line; where the way begins
    glm::vec3 axis{1.0F, 0.0F, 0.0F}; ///< turning: of length 1; else the way of a unit of the range
    glm::vec3 arm{0.0F, 0.0F, 1.0F};  ///< turning: of length 1, across the axis, to the part at rest
    float reach = 0.0F;               ///< turning: metres from the axis to the part's farthest point
    float half = 0.0F;                ///< metres of the line to either side of the pivot
    std::optional<double> bendLength; ///< metres of arc of a bend
    bool hasLine = false;             ///< that can be moved
    bool hasWay = false;              ///< whose direction can be turned
    bool hasFrom = false;             ///< a lower limit that can be moved
    bool hasTo = false;
};
/// `vertices` are those that it moves. None for an actuator that moves nothing.
[[nodiscard]] std::optional<ActuatorGuide> guideOf(const RigParts& parts, std::size_t actuator,
                                                   std::span<const std::uint32_t> vertices);

[[nodiscard]] std::array<glm::vec3, 2> endsOf(const ActuatorGuide& guide);
/// Metres from the pivot to the arc: near the part's tip, and never too small to be taken hold of in this view.
[[nodiscard]] float arcRadius(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 size);
/// Where a value of the range is, on the arc of that radius or on the way.
[[nodiscard]] glm::vec3 placeOf(const ActuatorGuide& guide, double value, float radius);
/// The value under a pixel: where its ray meets the plane of the arc, or on the way the place that is seen nearest to
/// it. Turning: the one of them within half a turn of `near`.
[[nodiscard]] double valueAt(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size,
                             double near);
/// Where a pixel's ray meets the plane of the line and the part at rest.
[[nodiscard]] glm::vec3 onSheet(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size);

/// The line of a hinge or bend from `ends` as the guide has them to others in the same sheet. The bend's way to its
/// free end stays across the line.
void setLine(Actuator& actuator, const ActuatorGuide& guide, const std::array<glm::vec3, 2>& ends);
/// The line carried along, in any direction.
void moveLine(Actuator& actuator, const glm::vec3& by);

/// What can be dragged, the first of those that lie on each other first.
enum class RigHandle { stroke, to, from, lineStart, lineEnd, bendEnd, direction };
struct SeenHandle {
    RigHandle handle;
    glm::vec2 pixel{0.0F};
};
/// Where the handles of a guide are seen; `stroke` in [0, 1] is where its part is shown. Those behind the eye are left
/// out.
[[nodiscard]] std::vector<SeenHandle> seenHandles(const ActuatorGuide& guide, double stroke, const ViewCamera& camera,
                                                  glm::vec2 size);

} // namespace lumorph::studio
