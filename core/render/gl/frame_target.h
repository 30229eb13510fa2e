#pragma once

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// A frame to draw into, with colour, depth and several samples a pixel, that can be read back.
class FrameTarget {
public:
    /// Throws InvalidInput for a size the driver cannot hold, DeviceError when it has no memory.
    FrameTarget(glm::ivec2 size, int samples);

    [[nodiscard]] GLuint framebuffer() const noexcept { return drawn_.name(); }
    [[nodiscard]] glm::ivec2 size() const noexcept { return size_; }
    /// The mean of the samples of each pixel; leaves no framebuffer bound.
    [[nodiscard]] Image read() const;

private:
    glm::ivec2 size_;
    gl::Renderbuffer color_;
    gl::Renderbuffer depth_;
    gl::Renderbuffer resolvedColor_;
    gl::Framebuffer drawn_;
    gl::Framebuffer resolved_;
};

} // namespace lumorph
