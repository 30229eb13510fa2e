#pragma once

#include <glm/vec2.hpp>

#include "core/render/gl_objects.h"
#include "core/render/image.h"

namespace lumorph {

/// A picture to draw into, with depth, whose colour is a texture: sRGB encoded by the framebuffer where
/// GL_FRAMEBUFFER_SRGB is on, decoded where it is sampled.
class ColorTarget {
public:
    /// Throws InvalidInput for a size the driver cannot hold, DeviceError when it has no memory.
    explicit ColorTarget(glm::ivec2 size, GLenum format = GL_SRGB8_ALPHA8);

    [[nodiscard]] GLuint framebuffer() const noexcept { return framebuffer_.name(); }
    [[nodiscard]] GLuint texture() const noexcept { return color_.name(); }
    [[nodiscard]] glm::ivec2 size() const noexcept { return size_; }
    /// The bytes as they are stored, row 0 at the top; leaves no framebuffer bound.
    [[nodiscard]] Image read() const;
    static constexpr std::size_t kObjects = 3;

private:
    glm::ivec2 size_;
    gl::Texture color_;
    gl::Renderbuffer depth_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
