#pragma once

#include <optional>

#include "core/render/blend_maps.h"
#include "core/render/camera_uniforms.h"
#include "core/render/color_target.h"
#include "core/render/device_surface.h"
#include "core/render/picture_changes.h"
#include "core/render/table_grid.h"

namespace lumorph {

/// What one projector keeps between frames.
struct ProjectorTarget {
    explicit ProjectorTarget(const SceneProjector& what)
        : projector(what), sent(what.camera.size), unseen(what.camera.size) {}

    SceneProjector projector;
    DepthRange range;
    ColorTarget sent;    ///< what it sends out; its depth is that of device and table
    ColorTarget unseen;  ///< what it shows where no eye sees it, from the corner of `area` on
    PixelRectangle area; ///< what of its picture is drawn in this frame; the rest stays
    PictureChanges changes;
    TableGrid table;
    std::optional<BlendMaps> blend; ///< while another projector is on

    [[nodiscard]] std::size_t objectCount() const noexcept {
        return 2 * ColorTarget::kObjects + TableGrid::kObjects + (blend ? BlendMaps::kObjects : 0);
    }
};

/// A camera that sees no more than a rectangle of another's image.
[[nodiscard]] CalibratedCamera cropped(const CalibratedCamera& camera, const PixelRectangle& area);

/// Sets the uniforms of projector_light.glsl.
void setLight(Program& program, const SceneProjector& projector);
/// Sets those of projector_sight.glsl; binds the depth map to a texture unit.
void setSight(Program& program, const ProjectorTarget& target, int unit);

} // namespace lumorph
