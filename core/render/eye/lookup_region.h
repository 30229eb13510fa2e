#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/render/gl/pixel_region.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// Whether a table of this material looks different to every eye: it mirrors, bends light or shines. What does not must
/// be drawn the same by both of the eye pass's ways, because the projector pass then takes the cheap one.
[[nodiscard]] bool dependsOnEye(const Material& table);

/// A part of the table, metres in x and z.
struct TableArea {
    glm::vec2 low{0.0F};
    glm::vec2 high{0.0F};
    [[nodiscard]] bool empty() const noexcept { return low.x >= high.x || low.y >= high.y; }
};

/// Where on the table an eye sees another picture than the view-independent one: things that stand on the table or
/// reach beyond the device, fog, a mirroring table. Few areas, which overlap little.
[[nodiscard]] std::vector<TableArea> lookupAreas(const ShowFrame& frame, const glm::vec3& eye);

/// Whether an eye picture holds all of an area of the table.
[[nodiscard]] bool holds(const CalibratedCamera& picture, const TableArea& area, const ShowFrame& frame);

/// The camera of a second eye picture for the areas that the first does not hold: of the size `most`, or halved as
/// often as leaves it half as fine as the first, with some reluctance to leave the size `before`; none: the first holds
/// all. Where the eye stands above one of them, tableView.
[[nodiscard]] std::optional<CalibratedCamera> tableLookup(const ShowFrame& frame, const glm::vec3& eye,
                                                          std::span<const TableArea> areas,
                                                          const CalibratedCamera& first, glm::ivec2 most,
                                                          glm::ivec2 before = glm::ivec2(0));

/// A rectangle that holds the area in an image.
[[nodiscard]] PixelRectangle pixelsOf(const TableArea& area, const CalibratedCamera& camera);
/// The same with the room in which lookups fade out around it.
[[nodiscard]] PixelRectangle lookupPixels(const TableArea& area, const CalibratedCamera& projector);

} // namespace lumorph
