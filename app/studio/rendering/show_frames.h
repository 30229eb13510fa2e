#pragma once

#include <glm/vec2.hpp>

#include "app/studio/rendering/show_request.h"

namespace lumorph::studio {

/// The largest size of the shape `of` within `room`, both in pixels; at least 1 x 1.
[[nodiscard]] glm::ivec2 fittingSize(glm::ivec2 of, glm::ivec2 room);

/// The same camera with fewer pixels of the same picture.
[[nodiscard]] CalibratedCamera resized(CalibratedCamera camera, glm::ivec2 size);

/// The frame with all projectors drawn with a share of their pixels, of each side.
[[nodiscard]] ShowFrame withProjectorShare(ShowFrame frame, double share);
/// The same so that each fits into `room` pixels; none gets larger.
[[nodiscard]] ShowFrame withProjectorRoom(ShowFrame frame, glm::ivec2 room);

/// Where the viewer's eye is: the one that is followed, else the scene's own.
[[nodiscard]] glm::vec3 viewerOf(const ShowFrame& frame);

/// The camera of a lab view: off-axis around the device as the eye's own, so that both can be compared, from the viewer
/// or from wherever the observer is.
[[nodiscard]] CalibratedCamera labCamera(const ShowFrame& frame, const std::optional<glm::vec3>& observer,
                                         glm::ivec2 size);

} // namespace lumorph::studio
