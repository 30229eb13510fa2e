#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"
#include "core/render/spatial_renderer.h"
#include "core/scene/show_frame.h"

namespace lumorph::cli {

/// What of a frame is to be drawn.
struct ViewRequest {
    enum class View { eye, projector, lab, mask, device };
    View view = View::eye;
    std::size_t projector = 0;         ///< of View::projector
    std::optional<glm::vec3> observer; ///< of View::lab and View::device; else the eye
    std::optional<glm::ivec2> size;    ///< else 1280 x 800, or the projector's own
    std::vector<glm::vec3> hands;      ///< of the viewer, in View::lab
    double ambient = 0.0;              ///< radiance of white under the room's light, in View::lab
    bool handsTracked = false;         ///< projectors know where the hands are
};

struct RenderedView {
    Image image;
    std::optional<CalibratedCamera> camera{}; ///< through which it is seen
    SpatialTimes ms{};
    double labMilliseconds = 0.0;
    std::vector<std::string> warnings{};
};

/// Draws one picture in an OpenGL context of its own. Throws InvalidInput for a projector that is not there or off, a
/// size that is not the projector's, and an eye or observer below the table.
[[nodiscard]] RenderedView renderView(const ShowFrame& frame, const ViewRequest& request);

} // namespace lumorph::cli
