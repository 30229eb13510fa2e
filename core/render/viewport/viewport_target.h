#pragma once

#include <optional>

#include "core/render/gl/gl_objects.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// Where a viewport is drawn before it goes to its framebuffer: a picture of the whole frame with one sample a pixel,
/// and a smaller target with several samples for one piece of a still frame at a time, so that memory stays bounded at
/// any size.
class ViewportTarget {
public:
    /// Largest piece, pixels.
    static constexpr glm::ivec2 kPiece{1024, 128};

    /// Whether the size is another one, so that all that was drawn is lost. Throws DeviceError when the driver has no
    /// memory for it.
    bool resize(glm::ivec2 size);

    /// Binds a second picture of the whole frame, without depth: what can be drawn over again and again.
    void beginBackground();
    /// Binds the whole frame for drawing with depth, over a copy of the background.
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
    };
    struct Moving { // made when first drawn into
        gl::Renderbuffer depth, background;
        gl::Framebuffer framebuffer; // of the background
    };
    struct Piece {
        gl::Renderbuffer color, depth;
        gl::Framebuffer framebuffer;
    };
    glm::ivec2 size_{0};
    std::optional<Whole> whole_;
    std::optional<Moving> moving_;
    std::optional<Piece> piece_;
};

} // namespace lumorph
