#pragma once

#include <array>
#include <optional>

#include <glm/vec2.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/render/show_frame.h"

namespace lumorph {

/// Pixels of an image, as OpenGL counts them: row 0 is the lowest, `high` is not included.
struct PixelRectangle {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    [[nodiscard]] bool empty() const noexcept { return low.x >= high.x || low.y >= high.y; }
    void include(const PixelRectangle& other) noexcept;
};

/// Where the part of the table that lies in one camera's image lies in another's: a rectangle that holds it all.
[[nodiscard]] PixelRectangle tableRegion(const CalibratedCamera& eye, const CalibratedCamera& projector);

/// What is left of an image around a rectangle in it.
[[nodiscard]] std::array<PixelRectangle, 4> around(const PixelRectangle& area, glm::ivec2 size);

/// The camera of a second eye picture, of `size`, for what on the table looks different to an eye and lies outside the
/// first picture: things that stand on the table or reach beyond the device, fog, a mirroring table. None: nothing
/// does.
[[nodiscard]] std::optional<CalibratedCamera> tableLookup(const ShowFrame& frame, const glm::vec3& eye,
                                                          const CalibratedCamera& first, glm::ivec2 size);

} // namespace lumorph
