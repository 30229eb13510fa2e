#pragma once

#include <glm/vec2.hpp>

#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// Depth alone, as a texture that is read as it is.
class DepthMap {
public:
    /// Throws InvalidInput for a size the driver cannot hold, DeviceError when it has no memory.
    explicit DepthMap(glm::ivec2 size);

    [[nodiscard]] GLuint framebuffer() const noexcept { return framebuffer_.name(); }
    [[nodiscard]] GLuint texture() const noexcept { return depth_.name(); }
    [[nodiscard]] glm::ivec2 size() const noexcept { return size_; }
    static constexpr std::size_t kObjects = 2;

private:
    glm::ivec2 size_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
};

} // namespace lumorph
