#pragma once

#include <string>

#include "core/render/eye/device_surface.h"
#include "core/render/eye/eye_pass.h"
#include "core/render/gl/camera_uniforms.h"
#include "core/render/gl/color_target.h"

namespace lumorph {

/// A picture for the eye in linear light, and the depth of the device alone in it, by which the projector pass knows
/// what the eye sees. The table needs no depth: it hides nothing, and is seen where the device is not.
class EyeView {
public:
    /// Black at first. Throws as ColorTarget does.
    explicit EyeView(glm::ivec2 size);

    /// What of the frame the picture holds: places on the table are looked up only where the device does not hide them.
    enum class Use { deviceAndTable, tableAlone };
    /// Draws both; the pass is prepared, the device uploaded. `depthProgram`: physical.vert with nothing.frag.
    void draw(EyePass& pass, const ShowFrame& frame, const CalibratedCamera& camera, Use use,
              const DeviceSurface& device, Program& depthProgram);
    /// Sets the uniforms `name`View (an EyeView of eye_lookup.glsl), `name`Picture and `name`ViewDepth of the current
    /// program, and binds two texture units from `unit` on.
    void set(Program& program, const std::string& name, int unit) const;

    [[nodiscard]] const CalibratedCamera& camera() const noexcept { return camera_; }
    [[nodiscard]] const ColorTarget& picture() const noexcept { return picture_; }
    static constexpr std::size_t kObjects = ColorTarget::kObjects + DepthMap::kObjects;

private:
    CalibratedCamera camera_;
    DepthRange range_;
    ColorTarget picture_;
    DepthMap depth_;
};

} // namespace lumorph
