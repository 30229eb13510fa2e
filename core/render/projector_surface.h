#pragma once

#include <string>

#include "core/render/gl_objects.h"
#include "core/render/program.h"

namespace lumorph {

/// What of the device lies under each pixel of a projector: place and normal in the world (alpha 0: nothing), and how
/// the place moves in the eye's picture from pixel to pixel.
class ProjectorSurface {
public:
    /// `depth`: texture of the depth that is drawn with it. Throws DeviceError when the driver has no memory.
    ProjectorSurface(glm::ivec2 size, GLuint depth);

    [[nodiscard]] GLuint framebuffer() const noexcept { return framebuffer_.name(); }
    /// Sets the uniforms surfacePlace and surfaceAlong of the current program, and binds two texture units from `unit`
    /// on.
    void set(Program& program, int unit) const;
    static constexpr std::size_t kObjects = 3;

private:
    gl::Texture place_, along_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
