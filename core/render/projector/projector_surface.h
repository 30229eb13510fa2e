#pragma once

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/pixel_region.h"
#include "core/render/gl/program.h"

namespace lumorph {

/// What of the device lies under each pixel of a projector: place and normal in the world (alpha 0: nothing), and how
/// the place moves in the eye's picture from pixel to pixel; and a copy of the projector's picture. It serves one
/// projector after the other, and only grows: memory of this size that comes and goes with the resolution would tear
/// holes into the heap.
class ProjectorSurface {
public:
    /// Makes room for a picture. Throws DeviceError when the driver has no memory.
    void fit(glm::ivec2 size);
    /// Binds it to be drawn into, at (0, 0), with this texture of depth.
    void bind(GLuint depth) const;
    /// Keeps a part of the picture in the framebuffer that is bound for reading.
    void keepPicture(const PixelRectangle& part) const;
    /// Sets the uniform before of the current program to what was kept, and binds a texture unit.
    void setPicture(Program& program, int unit) const;
    /// Sets the uniforms surfacePlace and surfaceAlong of the current program, and binds two texture units from `unit`
    /// on.
    void set(Program& program, int unit) const;
    static constexpr std::size_t kObjects = 4;

private:
    glm::ivec2 size_{0};
    gl::Texture place_, along_, picture_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
