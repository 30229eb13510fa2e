#pragma once

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/render/gl/depth_map.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// The size, if the driver can hold textures of it; throws InvalidInput otherwise.
[[nodiscard]] glm::ivec2 checkedTextureSize(glm::ivec2 size);

/// A picture to draw into with its depth, both of them textures. Of the format GL_SRGB8_ALPHA8 it is encoded by the
/// framebuffer where GL_FRAMEBUFFER_SRGB is on, and decoded where it is sampled.
class ColorTarget {
public:
    /// Throws InvalidInput for a size the driver cannot hold, DeviceError when it has no memory.
    explicit ColorTarget(glm::ivec2 size, GLenum format = GL_SRGB8_ALPHA8);

    [[nodiscard]] GLuint framebuffer() const noexcept { return framebuffer_.name(); }
    [[nodiscard]] GLuint texture() const noexcept { return color_.name(); }
    [[nodiscard]] GLuint depthTexture() const noexcept { return depth_.texture(); }
    [[nodiscard]] glm::ivec2 size() const noexcept { return depth_.size(); }
    /// The bytes as they are stored, row 0 at the top; leaves no framebuffer bound.
    [[nodiscard]] Image read() const;
    static constexpr std::size_t kObjects = 2 + DepthMap::kObjects;

private:
    DepthMap depth_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
