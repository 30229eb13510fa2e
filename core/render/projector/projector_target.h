#pragma once

#include <optional>
#include <span>

#include "core/geometry/capsule.h"
#include "core/render/eye/device_surface.h"
#include "core/render/eye/eye_pass.h"
#include "core/render/eye/table_grid.h"
#include "core/render/gl/camera_uniforms.h"
#include "core/render/gl/color_target.h"
#include "core/render/projector/blend_maps.h"
#include "core/render/projector/picture_changes.h"
#include "core/render/projector/response_table.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What one projector keeps between frames.
struct ProjectorTarget {
    /// Throws as ColorTarget does.
    explicit ProjectorTarget(const InstalledProjector& what);

    InstalledProjector projector;
    DepthRange range;
    ColorTarget sent;      ///< what it sends out; its depth is that of the device, and of the table among several
    gl::Texture eyeWeight; ///< where what it sends out is drawn for the eye: projector_eye_weight.glsl
    DepthMap open;         ///< by which that hides all else
    gl::Framebuffer seen;  ///< `sent` and `eyeWeight`, with the depth of `sent`
    gl::Framebuffer rest;  ///< `sent` with `open`
    PixelRegion region;    ///< what of its picture is drawn in this frame; the rest stays
    PixelRectangle device; ///< holds the device as it is
    PictureChanges changes;
    TableGrid table;
    std::optional<BlendMaps> blend;        ///< while another projector is on
    std::optional<ResponseTable> response; ///< while its response is a measured one
    glm::vec3 blackFloor{0.0F};            ///< no place is made darker, as light on white

    /// Another projector of the same size, or other figures of it.
    void become(const InstalledProjector& what, const glm::vec3& floor);
    /// Whether its shaders make the bytes of its picture themselves, where else the framebuffer makes sRGB of light.
    [[nodiscard]] bool encodes() const noexcept { return response || projector.gamma > 0.0; }
    [[nodiscard]] std::size_t objectCount() const noexcept {
        return ColorTarget::kObjects + DepthMap::kObjects + 3 + TableGrid::kObjects +
               (blend ? blend->objectCount() : 0) + (response ? ResponseTable::kObjects : 0);
    }
};

/// Sets the uniforms of projector_light.glsl.
void setLight(Program& program, const InstalledProjector& projector);
/// The share of light that it gives back, linear, in [0, 1].
[[nodiscard]] glm::vec3 albedoOf(const Installation& installation, PhysicalSurface surface);
/// Sets those of projector_output.glsl too; may bind up to kOutputUnits texture units from `unit` on.
inline constexpr int kOutputUnits = 3;
void setOutput(Program& program, const ProjectorTarget& target, const Installation& installation,
               PhysicalSurface surface, int unit);
/// What of its picture the eye pass draws itself: places that no eye sees. Neither argument may go before the result.
[[nodiscard]] UnseenPlaces unseenPlaces(const ProjectorTarget& target, const Installation& installation);

/// Sets those of projector_sight.glsl; binds the depth map to a texture unit.
void setSight(Program& program, const ProjectorTarget& target, int unit);

/// Sets those of hands.glsl; of more capsules than that has room for, the first ones.
void setHands(Program& program, std::span<const Capsule> hands);

} // namespace lumorph
