#pragma once

#include <optional>

#include "core/render/gl_objects.h"
#include "core/render/viewport_frame.h"

namespace lumorph {

/// Where a viewport is drawn before it goes to its framebuffer: a picture of the whole frame with one sample a pixel,
/// and a smaller target with several samples for one piece of a still frame at a time, so that memory stays bounded at
/// any size.
class ViewportTarget {
public:
    /// Largest piece, pixels.
    static constexpr glm::ivec2 kPiece{1024, 128};

    /// Throws DeviceError when the driver has no memory for it.
    void resize(glm::ivec2 size);

    /// Binds the whole frame for drawing with depth and clears it.
    void beginWhole();
    /// Binds a piece, not larger than kPiece, for drawing with samples and depth, and clears it; the viewport is
    /// shifted so that clip space is still that of the whole frame.
    void beginPiece(const FramePiece& piece);
    /// Takes the piece into the picture of the frame.
    void endPiece(const FramePiece& piece);

    /// Copies the picture to a framebuffer and leaves that bound.
    void copyTo(GLuint framebuffer) const;
    /// The picture of the frame, for sampling.
    [[nodiscard]] GLuint picture() const { return whole_->color.name(); }

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Whole {
        gl::Texture color;
        gl::Framebuffer framebuffer;
        std::optional<gl::Renderbuffer> depth; // made when first drawn into
    };
    struct Piece {
        gl::Renderbuffer color, depth;
        gl::Framebuffer framebuffer;
    };
    glm::ivec2 size_{0};
    std::optional<Whole> whole_;
    std::optional<Piece> piece_;
};

} // namespace lumorph
