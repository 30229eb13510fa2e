#pragma once

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"

namespace lumorph {

/// What of the device lies under each pixel of a projector: place and normal in the world (alpha 0: nothing), and how
/// the place moves in the eye's picture from pixel to pixel. It serves one projector after the other, and only grows:
/// memory of this size that comes and goes with the resolution would tear holes into the heap.
class ProjectorSurface {
public:
    /// Makes room for a picture. Throws DeviceError when the driver has no memory.
    void fit(glm::ivec2 size);
    /// Binds it to be drawn into, at (0, 0), with this texture of depth.
    void bind(GLuint depth) const;
    /// Sets the uniforms surfacePlace and surfaceAlong of the current program, and binds two texture units from `unit`
    /// on.
    void set(Program& program, int unit) const;
    static constexpr std::size_t kObjects = 3;

private:
    glm::ivec2 size_{0};
    gl::Texture place_, along_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
