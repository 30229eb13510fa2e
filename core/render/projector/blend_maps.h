#pragma once

#include <glm/vec2.hpp>

#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// What a projector needs to share the work with others: its weight and the sum of all weights at each of its pixels,
/// and the distance from edges in its depth, at an eighth of its size.
class BlendMaps {
public:
    static constexpr int kBlock = 8;  ///< pixels of the projector a pixel of the distance
    static constexpr int kRadius = 8; ///< pixels of the distance that are told apart
    static constexpr std::size_t kObjects = 6;

    /// `depth`: the projector's depth map, by which the weights are tested. Throws DeviceError when the driver has no
    /// memory.
    BlendMaps(glm::ivec2 size, GLuint depth);

    [[nodiscard]] glm::ivec2 distanceSize() const noexcept { return distanceSize_; }
    [[nodiscard]] GLuint distance(std::size_t step) const noexcept { return distances_[step].name(); }
    [[nodiscard]] GLuint distanceFramebuffer(std::size_t step) const noexcept { return framebuffers_[step].name(); }
    [[nodiscard]] GLuint weights() const noexcept { return weights_.name(); }
    [[nodiscard]] GLuint weightsFramebuffer() const noexcept { return framebuffers_[2].name(); }

private:
    glm::ivec2 distanceSize_;
    gl::Texture distances_[2]; ///< passes write them in turn
    gl::Texture weights_;
    gl::Framebuffer framebuffers_[3];
};

} // namespace lumorph
