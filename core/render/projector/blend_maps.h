#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// What a projector needs to share the work with others: its weight and the sum of all weights at each of its pixels,
/// and the distance from edges in its depth, at an eighth of its size; where a black was measured, also what the blacks
/// of all make of white at each of its pixels.
class BlendMaps {
public:
    static constexpr int kBlock = 8;  ///< pixels of the projector a pixel of the distance
    static constexpr int kRadius = 8; ///< pixels of the distance that are told apart

    /// `depth`: the projector's depth map, by which the weights are tested. Throws DeviceError when the driver has no
    /// memory.
    BlendMaps(glm::ivec2 size, GLuint depth, bool withBlacks);

    [[nodiscard]] glm::ivec2 distanceSize() const noexcept { return distanceSize_; }
    [[nodiscard]] GLuint distance(std::size_t step) const noexcept { return distances_[step].name(); }
    [[nodiscard]] GLuint distanceFramebuffer(std::size_t step) const noexcept { return framebuffers_[step].name(); }
    [[nodiscard]] GLuint weights() const noexcept { return weights_.name(); }
    [[nodiscard]] bool hasBlacks() const noexcept { return blacks_.has_value(); }
    [[nodiscard]] GLuint blacks() const noexcept { return blacks_ ? blacks_->name() : 0; }
    /// Of the weights and, where there are any, the blacks.
    [[nodiscard]] GLuint weightsFramebuffer() const noexcept { return framebuffers_[2].name(); }
    [[nodiscard]] std::size_t objectCount() const noexcept { return hasBlacks() ? 7 : 6; }

private:
    glm::ivec2 distanceSize_;
    gl::Texture distances_[2]; ///< passes write them in turn
    gl::Texture weights_;
    std::optional<gl::Texture> blacks_;
    gl::Framebuffer framebuffers_[3];
};

} // namespace lumorph
